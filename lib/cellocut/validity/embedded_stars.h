// Tells without exact arithmetic, vertex by vertex, that the faces around it do not meet beyond
// their common corners and edges: most pairs of faces whose boxes overlap share a vertex.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cellocut/base/buckets.h"
#include "cellocut/base/lanes.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// The star of a vertex is the union of its faces. It is proved to be embedded by a projection along
// an axis: where all faces of a closed fan turn the same way around the vertex there, and once
// around in all, their projections are disjoint but for common edges, and so are the faces. (The
// test of Volino and Magnenat-Thalmann, "Efficient self-collision detection on smoothly discretized
// surface animations using geometrical shape regularity", 1994, for one vertex.) Turns are
// evaluated in doubles with a bound on the rounding error; infinities and underflow make no proof.
class EmbeddedStars {
 public:
  // `corners_at`: as corners_by_point() (incidence.h) gives it. O(sum over vertices of k^2), k the
  // faces of the vertex, of which more than 16 make no proof; parallel.
  EmbeddedStars(const std::vector<Point3>& points, const std::vector<Triangle>& triangles,
                const Buckets& corners_at);

  // Whether the star of the vertex is proved to be embedded; false says nothing.
  [[nodiscard]] bool embedded(std::uint32_t vertex) const { return embedded_[vertex] != 0; }

 private:
  std::vector<std::uint8_t> embedded_;  // by point
};

// Up to eight faces, which other ones are compared with at once.
class StarsOfFaces {
 public:
  // Precondition: at most eight ids.
  StarsOfFaces(const EmbeddedStars& stars, const std::vector<Triangle>& triangles,
               std::span<const std::uint32_t> ids) {
    constexpr std::int32_t kNone = -1;  // no corner that a face has
    for (auto& half : corner_) half.fill(IntLanes{kNone, kNone, kNone, kNone});
    for (std::size_t i = 0; i < ids.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = triangles[ids[i]][k];
        if (!stars.embedded(vertex)) continue;
        corner_[i / 4][k][i % 4] = static_cast<std::int32_t>(vertex);
      }
    }
  }

  // Bit i is set where face i and `other`, if that is another one, share a vertex whose star is
  // proved to be embedded: they then meet in common corners or a common edge alone.
  [[nodiscard]] unsigned settled(const Triangle& other) const {
    IntLanes first{};
    IntLanes second{};
    for (const std::uint32_t vertex : other) {
      const auto v = static_cast<std::int32_t>(vertex);
      for (std::size_t k = 0; k < 3; ++k) {
        first |= corner_[0][k] == v;
        second |= corner_[1][k] == v;
      }
    }
    return bits_of(first) | bits_of(second) << 4U;
  }

 private:
  std::array<std::array<IntLanes, 3>, 2> corner_;  // of four faces each; those with such a star
};

}  // namespace cellocut
