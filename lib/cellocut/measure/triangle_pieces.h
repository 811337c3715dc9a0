// Long triangles in pieces, for hierarchies of boxes: the box of a long triangle is mostly empty.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cellocut/base/point.h"

namespace cellocut {

struct TrianglePiece {
  std::uint32_t triangle;
  std::array<Point3, 3> corners;
};

// The triangles with an edge longer than `longest`, and no others, bisected at their longest edge
// (Rivara, "Algorithms for refining triangular grids suitable for adaptive and multigrid
// techniques", 1984) until no edge is longer, or there are `most` pieces; the longest edges are
// first. Nothing where there are more long triangles than that. All pieces of a triangle are there,
// and they cover it. O(n + most log most). Precondition: corners are finite.
std::vector<TrianglePiece> cut_long_triangles(const std::vector<std::array<Point3, 3>>& triangles,
                                              double longest, std::size_t most);

}  // namespace cellocut
