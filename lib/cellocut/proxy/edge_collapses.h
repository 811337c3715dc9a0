// Decimation by quadric edge collapses: the reference for the proxy's default.
#pragma once

#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Quadric edge collapses onto existing vertices (meshoptimizer) until `removed_share` of the faces
// are gone or the next collapse would cost more than `error`, in the units of the points: the
// corners of the faces that are left. The simplifier's error is an average over the faces around an
// edge, so it bounds no distance; it ends what makes no sense.
// Blocks of space are thinned first, each by itself and in parallel, with their borders locked; the
// whole afterwards, so that no border shows. The blocks are those of space: the same faces for any
// number of threads. O(n log n).
// Preconditions: points >= 0, one unit or so between neighbours; removed_share in [0, 1).
std::vector<Triangle> collapse_edges(const TriangleSoup& surface, double removed_share,
                                     double error);

}  // namespace cellocut
