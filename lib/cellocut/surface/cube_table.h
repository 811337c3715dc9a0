// How the zero set passes through one cell of the grid, for each of the 256 sign patterns.
// iso_surface.h has the argument why the result is an embedded manifold.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace cellocut {

// Corner c of a cell has the offset (c & 1, (c >> 1) & 1, c >> 2).
// Edge e runs along axis e / 4, from the corner edge_low_corner(e) to that corner + 1 along the
// axis.
constexpr int edge_axis(int edge) { return edge / 4; }
constexpr int edge_low_corner(int edge) {
  // The two other axes take the two low bits of the edge's number.
  const int u = edge & 1;
  const int v = (edge >> 1) & 1;
  switch (edge / 4) {
    case 0:
      return u * 2 + v * 4;
    case 1:
      return u * 1 + v * 4;
    default:
      return u * 1 + v * 2;
  }
}

// In a triangle, 0..11 names the vertex on that edge, kInnerPoint the inner point of the cell.
inline constexpr std::uint8_t kInnerPoint = 12;

struct CubeCase {
  std::vector<std::array<std::uint8_t, 3>> triangles;  // normal from inside to outside
  std::vector<std::uint8_t>
      inner_loop;  // edges whose vertices' mean is the inner point; mostly empty
};

// Indexed by the pattern: bit c is set where corner c is inside.
const std::array<CubeCase, 256>& cube_table();

}  // namespace cellocut
