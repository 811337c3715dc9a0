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

// A supported facet, for the sheet beneath it: the cells on the two sides of that sheet.
struct SheetSample {
  double area = 0;                 // squared relative units
  std::int32_t front = kOutside;   // the facet's free cell
  std::int32_t behind = kOutside;  // what holds the place behind the sheet
};

// In the order of the facets. Behind a facet is the point as far beyond the nearest point of the
// input as twice `offset`, the slab's half thickness (in input units). Facets within the sheet tell
// no side and are left out. Parallel; O(facets (log faces + cells on the way behind)). Errors:
// Cancelled.
std::vector<SheetSample> sample_sheets(const TetComplex& complex, const FacetList& facets,
                                       const FacetAreas& areas, const CellLabels& initial,
                                       const NearestTriangle& input, double offset,
                                       Observer& observer);

// By labelling of the path; a cell of the slab behind a sheet is solid. Precondition: labellings
// are nested. O(samples + labellings).
std::vector<SheetSides> measure_sheet_sides(const std::vector<SheetSample>& samples,
                                            const CellPath& path);

}  // namespace cellocut
