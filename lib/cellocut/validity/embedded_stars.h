// Tells without exact arithmetic, vertex by vertex, that the faces around it do not meet beyond
// their common corners and edges: most pairs of faces whose boxes overlap share a vertex.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/buckets.h"
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

  // Whether two different faces share a vertex with such a star: they then meet in common corners
  // or a common edge alone.
  [[nodiscard]] bool settle(const Triangle& s, const Triangle& t) const {
    unsigned settled = 0;  // without a branch, as none could be foreseen
    for (const std::uint32_t v : s) {
      const auto is = [v](std::uint32_t corner) { return corner == v ? 1U : 0U; };
      settled |= (is(t[0]) | is(t[1]) | is(t[2])) & embedded_[v];
    }
    return settled != 0;
  }

 private:
  std::vector<std::uint8_t> embedded_;  // by point
};

}  // namespace cellocut
