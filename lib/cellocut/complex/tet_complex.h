// A tetrahedral complex: what a Delaunay backend delivers and what the energy is defined on.
//
// Canonical form, the same for every backend and any number of threads: the corners of a cell are
// ascending vertex indices but for the last two, which are swapped where the ascending order would
// be negatively oriented; cells are sorted lexicographically by their ascending quadruple. So two
// backends that find the same Delaunay triangulation deliver the same arrays.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cellocut/base/point.h"

namespace cellocut {

// The neighbour across a facet of the convex hull.
inline constexpr std::int32_t kOutside = -1;

struct TetComplex {
  // The points that were given, in the order in which they were given.
  std::vector<Point3> points;
  // Positively oriented corner quadruples (indices into `points`).
  std::vector<std::array<std::uint32_t, 4>> cells;
  // neighbours[c][k]: the cell across the facet opposite to corner k of c, or kOutside.
  std::vector<std::array<std::int32_t, 4>> neighbours;
  // first_copy[i]: the lowest index that has the coordinates of point i (i itself where unique).
  // Only first copies are corners of cells.
  std::vector<std::uint32_t> first_copy;
};

// The three corners of the facet opposite to corner k, ascending by vertex index.
std::array<std::uint32_t, 3> facet_corners(const TetComplex& complex, std::uint32_t cell, int k);

// The same facet, ordered so that its normal (right-hand rule) points out of the cell.
std::array<std::uint32_t, 3> facet_outward(const TetComplex& complex, std::uint32_t cell, int k);

// Mean of the four corners, summed in canonical order.
Point3 cell_centroid(const TetComplex& complex, std::uint32_t cell);

// Signed volume; positive up to rounding.
double cell_volume(const TetComplex& complex, std::uint32_t cell);

// Brings cells of any order into canonical form and computes neighbours.
// `cells` holds corner quadruples in which each cell is positively oriented (an exact statement
// that the backend makes; it is not re-derived in floating point). Errors: Error where a facet
// belongs to more than two cells. O(n log n).
TetComplex make_canonical(std::vector<Point3> points,
                          std::vector<std::array<std::uint32_t, 4>> cells,
                          std::vector<std::uint32_t> first_copy);

// Cells, as sets of four points, that only the complex with more of them has or that are not in
// both, as a share of its cells; for two complexes of the same points. O(n log n).
double differing_cell_share(const TetComplex& a, const TetComplex& b);

}  // namespace cellocut
