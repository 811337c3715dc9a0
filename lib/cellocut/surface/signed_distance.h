// The signed distance of a labelled complex's interface on the grid: the paper's refined field.
#pragma once

#include "cellocut/base/observer.h"
#include "cellocut/field/frame.h"
#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Distance to `boundary` (input units) in grid steps, negative inside, at every grid point nearer
// than kBand. `boundary` has to bound a region: every edge in an even number of faces; orientation
// does not matter. The sign is the parity of the crossings of the grid line through the point along
// x, counted by exact predicates, so it is right at every point whose distance is not zero, however
// thin or non-manifold the region is there. O(stored values + crossings log crossings). Errors:
// Cancelled.
SparseField compute_signed_distance(const TriangleSoup& boundary, const Frame& frame,
                                    Observer& observer);

}  // namespace cellocut
