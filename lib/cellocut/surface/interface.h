// The interface F of a labelling: the facets between interior and exterior cells.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/complex/tet_complex.h"
#include "cellocut/energy/energy.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// One facet of the interface, seen from its interior cell.
struct InterfaceFacet {
  std::uint32_t cell = 0;   // the interior cell
  std::uint8_t corner = 0;  // the facet is opposite to this corner
};

// All of them, hull facets of interior cells included, ascending by (cell, corner). Together they
// are the boundary of a region: every edge lies in an even number of them. O(cells).
std::vector<InterfaceFacet> list_interface(const TetComplex& complex, const CellLabels& labels);

// The interface as triangles oriented outward on the points of the complex (which it shares: edges
// with four faces and pinched vertices are possible). Points that it does not use are kept.
TriangleSoup interface_triangles(const TetComplex& complex,
                                 const std::vector<InterfaceFacet>& interface);

// `--surface cells`: the interface made manifold by splitting. Around an edge with four or more
// facets, the two facets that bound the same run of interior cells belong together; around a
// vertex, so do the facets that such edges connect; each group gets a copy of the vertex with equal
// coordinates. Where two groups at an edge end up between the same two copies, they are joined
// through the exterior instead, which separates the copies. The result is a closed oriented
// 2-manifold by index. Errors: Error where that does not end (not known to happen). O(facets log
// facets).
TriangleSoup extract_interface_cells(const TetComplex& complex, const CellLabels& labels);

}  // namespace cellocut
