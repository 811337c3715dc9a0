// Which cells hold a point.
#pragma once

#include "cellocut/complex/tet_complex.h"

namespace cellocut {

// Walks from cell to cell, each time across a facet that has the point beyond it, by exact
// predicates. In a Delaunay complex this ends, whichever such facet is taken (Devillers, Pion,
// Teillaud: Walking in a triangulation, Int. J. Found. Comput. Sci. 13, 2002). A cell that holds
// the point, on its boundary too; kOutside where it lies beyond the hull. Steps grow with the
// distance from `start`, in cells.
std::int32_t locate_from(const TetComplex& complex, const Point3& point, std::uint32_t start);

// All cells that hold the point, ascending, more than one where it lies on a facet, an edge or a
// corner; none beyond the hull. Found as above.
std::vector<std::uint32_t> cells_holding(const TetComplex& complex, const Point3& point);

}  // namespace cellocut
