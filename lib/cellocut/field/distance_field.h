// The thickening field phi = UDF - eps (the paper's equation 1) in a narrow band around phi = 0.
#pragma once

#include "cellocut/base/observer.h"
#include "cellocut/field/frame.h"
#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// phi(x) = distance(x, mesh) - offset, in grid steps, at every grid point with |phi| < kBand; tiles
// inside and outside of it, rounded to odd multiples of 2^-15 (an input that was scaled or moved
// has distances that differ in their last bits, and so the same field). `offset` >= 0 is in grid
// steps.
//
// An octree is descended from the whole grid. At each node the exact distance from its centre to
// its candidate triangles bounds the distance at all its grid points; a node that the band does not
// reach becomes a tile, and triangles that cannot be closest anywhere in the node leave its list.
// What is left at the bottom decides eight grid points. So time and memory follow the area of phi =
// 0, neither the number of grid points nor offset / h, and the value is the minimum over a superset
// of the triangles that can be closest: the same bits for any number of threads.
//
// Errors: Cancelled.
SparseField compute_distance_field(const TriangleSoup& mesh, const Frame& frame, double offset,
                                   Observer& observer);

}  // namespace cellocut
