// What the user knows: points that are to be inside or outside of the solid.
//
// A point fixes the label of every cell that holds it. It does not change L*, hence no weight. The
// rest is up to the energy: where cells are small against lambda_fill times the opening, an outside
// point may leave no more than a bubble; another point, or a smaller weight, opens the cavity.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/complex/tet_complex.h"
#include "cellocut/energy/energy.h"

namespace cellocut {

struct Guidance {
  std::vector<Point3> inside;  // input units
  std::vector<Point3> outside;

  [[nodiscard]] bool empty() const { return inside.empty() && outside.empty(); }
};

// Cells that are fixed by points, ascending, each once.
struct GuidedCells {
  std::vector<std::uint32_t> inside;
  std::vector<std::uint32_t> outside;
};

// Fixes the cells that hold the points (point_location.h) and says which. An outside point beyond
// the hull is outside already. Errors: UsageError that names the point: not finite; an inside point
// beyond the hull, or in a cell that is fixed exterior; an outside point in a cell with L*
// interior; one of either kind in one cell.
GuidedCells guide_cells(const TetComplex& complex, const Guidance& guidance,
                        const CellLabels& initial, std::vector<Anchor>& anchors);

}  // namespace cellocut
