// Small tetrahedral complexes made by hand, with labels, for tests that need no Delaunay backend.
#pragma once

#include <array>
#include <cstdint>

#include "cellocut/complex/tet_complex.h"
#include "cellocut/energy/energy.h"

namespace cellocut::testing {

// A grid of counts[0] x counts[1] x counts[2] unit cubes, each split into six tetrahedra around its
// main diagonal (Kuhn's subdivision, which matches across cubes). `jitter` moves every grid point
// by less than that along each axis, in a way that depends on `seed` alone; below 0.1 every cell
// keeps its orientation. jitter 0 gives many facets of equal area.
TetComplex cube_grid(const std::array<std::uint32_t, 3>& counts, double jitter = 0,
                     std::uint64_t seed = 1);

// The cells of the cube (x, y, z) of such a grid without jitter.
std::vector<std::uint32_t> cells_of_cube(const TetComplex& grid, double x, double y, double z);

// Two regular tetrahedra that share a facet: seven facets of equal area, cell 0 without point 4.
TetComplex regular_bipyramid();

// Quantised areas with support by labels.
FacetAreas labelled_areas(const TetComplex& complex, const FacetList& facets,
                          const CellLabels& initial, double unit, int area_bits);

// Interior with probability `share`, exterior otherwise; depends on `seed` alone.
CellLabels random_labels(const TetComplex& complex, double share, std::uint64_t seed);

}  // namespace cellocut::testing
