// Two references for the intersection test, neither of which shares code with it.
#pragma once

#include <vector>

#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/validity/intersections.h"

namespace cellocut::testing {

// By exact constructions: every pair of faces whose boxes overlap is intersected in exact
// arithmetic, and the result (nothing, point, segment, triangle, polygon) is compared with what the
// corners have in common. O(n^2). Faces that are degenerate or collapse by position are left out.
std::vector<FacePair> pairs_by_construction(const TriangleSoup& soup);

struct CgalIntersections {
  std::vector<FacePair> pairs;            // sorted
  std::vector<std::uint32_t> degenerate;  // sorted
  // Whether CGAL's mesh is the soup itself. It is not where edges or vertices are non-manifold:
  // these are split first, for a half-edge mesh cannot hold them.
  bool split = false;
};

// CGAL's Polygon_mesh_processing::self_intersections() on the mesh of the soup after an
// exact-position merge. Where a split took a common corner from a pair of faces, CGAL sees them
// touch and lists them; such pairs alone are decided again by exact construction. Faces that
// collapse in the merge, which no half-edge mesh can hold, count as degenerate.
CgalIntersections pairs_by_cgal(const TriangleSoup& soup);

}  // namespace cellocut::testing
