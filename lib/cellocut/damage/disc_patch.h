// Parts of a closed surface that can be taken out of it without a pinch.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Grows sets of faces that are topological discs: connected by edges, with one boundary loop that
// passes no vertex twice. Faces are added one at a time, as in a shelling: one that shares one edge
// with the disc where its third corner is not in the disc, or one that shares two. Either leaves a
// disc. The rest of the surface is then manifold with boundary and as connected as before: at every
// vertex of the loop the disc's faces are one fan, so the others are one.
class DiscGrower {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  // `mesh` must outlive this. Precondition: closed, oriented and manifold by index. O(n log n).
  explicit DiscGrower(const TriangleSoup& mesh);

  // The disc grown from `seed` over faces for which wanted(face), those with the lowest
  // distance(face) first, and over any face with the disc on two sides of it, which takes notches
  // and slivers out of the loop; no corner of a kept-out vertex. Stops where the area reaches
  // `largest`.
  // Empty where the seed itself is not possible. Ascending. O(k log k) for k faces looked at.
  [[nodiscard]] std::vector<std::uint32_t> grow(
      std::uint32_t seed, double largest, const std::function<bool(std::uint32_t)>& wanted,
      const std::function<double(std::uint32_t)>& distance);

  // No later disc has a corner at the vertices of these faces or of faces that meet them.
  void keep_out(const std::vector<std::uint32_t>& faces);

  // The vertices of the boundary loop, in order, each once. Precondition: a disc.
  [[nodiscard]] std::vector<std::uint32_t> boundary(const std::vector<std::uint32_t>& disc) const;

 private:
  [[nodiscard]] bool fits(std::uint32_t face) const;
  // Whether the disc is on two sides of it.
  [[nodiscard]] bool notch(std::uint32_t face) const;

  const TriangleSoup& mesh_;
  std::vector<std::array<std::uint32_t, 3>> neighbour_;  // over the edge from corner k to k + 1
  std::vector<std::uint8_t> kept_out_;                   // by vertex
  std::vector<std::uint8_t> in_disc_;                    // by face; all 0 between calls
  std::vector<std::uint8_t> vertex_in_disc_;             // by vertex; as above
};

}  // namespace cellocut
