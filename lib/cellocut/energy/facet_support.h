// Support measured on the facet.
//
// The vertices of the complex stand further apart than the slab is thick, so cells reach through
// the slab: two cells with an exterior centroid may share a facet that lies within it. By labels
// that facet counts as unsupported, and closing the gap costs lambda, though there is sheet all
// over it.
#pragma once

#include "cellocut/energy/energy.h"
#include "cellocut/field/frame.h"
#include "cellocut/field/sparse_field.h"

namespace cellocut {

// A facet is supported where phi is below this, in grid steps: within the slab, or as near to it as
// the proxy, whose vertices the facets have, is to phi = 0. (At 0 a flat side of the slab would be
// supported where rounding and decimation happen to leave it, about half of it.)
inline constexpr double kSupportReach = 0.5;

// For FacetAreas::supported: of each facet's quantised area the share that lies where phi <
// kSupportReach, rounded once. By adaptive quadrature: a piece of the facet counts as a whole where
// it is further from the border than its radius (phi is a distance), else it is halved, down to a
// radius of one grid step, where phi is taken to be linear. Parallel, the same for any number of
// threads. O(facets + area of facets near the slab, in squared grid steps).
std::vector<std::int64_t> support_by_facets(const TetComplex& complex, const FacetList& facets,
                                            const FacetAreas& areas, const SparseField& phi,
                                            const Frame& frame);

}  // namespace cellocut
