// The field of `--surface union`: phi where the surface is supported, the cells that the cut
// absorbed where it was completed.
#pragma once

#include "cellocut/base/observer.h"
#include "cellocut/complex/tet_complex.h"
#include "cellocut/energy/energy.h"
#include "cellocut/field/frame.h"
#include "cellocut/field/sparse_field.h"

namespace cellocut {

// Volumes in cubed input units, counted by grid points.
struct LabellingDepartures {
  double beyond = 0;    // solid in exterior cells: all of it in the slab phi < 0
  double left_out = 0;  // not solid in interior cells: all of them with L* interior
  double closed = 0;    // neither in the slab nor absorbed, but made solid: in interior cells
};

struct UnionField {
  // Negative inside, in grid steps. The values are those below in all cells of the grid that have a
  // point outside, and so wherever the zero set passes; elsewhere the sign alone is certain.
  SparseField field;
  LabellingDepartures departures;
};

// min(phi, signed distance to the absorbed region), where the absorbed region are the cells with L*
// exterior that the cut made interior. A grid point is absorbed iff it lies in such a cell: decided
// by the parity of the crossings of a grid line with the region's boundary, by exact predicates.
//
// What is neither in the slab nor absorbed is outside. In interior cells (with L* interior, then) a
// point stays outside iff a path of at most four grid steps through points outside leads from it to
// one in no interior cell; the others are made inside. So what the facets of the decimated proxy
// cut off stays as phi has it, and pockets between the slab and absorbed cells are closed, with
// slots that the slab all but fills: the labelling has them filled, and phi would leave them in
// tatters.
//
// `phi` is the thickening field in grid steps. O(stored values + crossings log crossings); the same
// bits for any number of threads. Errors: Cancelled.
UnionField compute_union_field(const SparseField& phi, const TetComplex& complex,
                               const CellLabels& initial, const CellLabels& label,
                               const Frame& frame, Observer& observer);

}  // namespace cellocut
