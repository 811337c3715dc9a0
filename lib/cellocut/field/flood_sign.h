// The flood-signed distance: what phi is without thickening (the paper's ablation).
#pragma once

#include "cellocut/base/observer.h"
#include "cellocut/field/frame.h"
#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Distance to the mesh in grid steps, negative at the grid points that a flood from outside does
// not reach. The flood passes along grid edges that no face crosses (decided exactly), and through
// the empty space beyond the band tile by tile. A mesh with a hole of more than a grid step has no
// inside at all. O(stored values). Errors: Cancelled.
SparseField compute_flood_signed_distance(const TriangleSoup& mesh, const Frame& frame,
                                          Observer& observer);

}  // namespace cellocut
