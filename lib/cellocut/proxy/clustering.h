// Decimation by clusters of vertices: the proxy's default.
#pragma once

#include "cellocut/base/observer.h"
#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/proxy/refinement.h"

namespace cellocut {

// Puts the vertices of a dense surface (phi = 0, index coordinates) into clusters until
// `removed_share` of them are gone, then undoes the clusters at the corners of faces that are
// further than `tolerance` from phi = 0, again and again until none is: at worst down to the
// surface itself. (Splitting such faces, as refine_to_surface() does, does not help where a face
// lies across the mouth of a hole that its clusters surround.)
// Preconditions: as of VertexClusters. Errors: Cancelled. O(n log n).
Refinement cluster_vertices(const TriangleSoup& surface, double removed_share,
                            const SparseField& phi, double tolerance, Observer& observer);

}  // namespace cellocut
