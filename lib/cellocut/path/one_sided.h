// How much of the input is the surface of a solid: solid on one side, not on the other.
#pragma once

#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/field/frame.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/path/cell_path.h"

namespace cellocut {

// What becomes of the input's two sides, as areas of facets between anchored and free cells, each
// facet standing for the sheet beneath it. In squared relative units.
struct SheetSides {
  double one_sided = 0;  // outside on this side, and solid behind the sheet
  double open = 0;       // outside on both: a shell in the open, or a true sheet
};

// By labelling of the path. Behind a facet is the point as far beyond the nearest point of the
// input as twice `offset`, the slab's half thickness (in input units); a cell of the slab there is
// solid. Parallel; O(facets (log faces + cells on the way behind) + labellings). Errors: Cancelled.
std::vector<SheetSides> measure_sheet_sides(const TetComplex& complex, const FacetList& facets,
                                            const FacetAreas& areas, const CellLabels& initial,
                                            const CellPath& path, const NearestTriangle& input,
                                            double offset, Observer& observer);

}  // namespace cellocut
