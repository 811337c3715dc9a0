// Do two triangles of a mesh share more than their common corners and edges? Decided exactly, by
// CGAL.
#pragma once

#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Whether faces `s` and `t` meet in more than what their corners have in common:
// - no common corner: the triangles have a point in common;
// - one: the side opposite to it, in one of the two, meets the other triangle (any further common
//   point lies on a segment from the common corner that leaves one triangle through that side);
// - two: the triangles are coplanar and lie on the same side of the common edge;
// - three: always.
// The same answer as CGAL's self_intersections() gives for a mesh (Polygon_mesh_processing 5.5).
// Preconditions: finite coordinates; corners with equal coordinates have equal indices; neither
// face is degenerate (CGAL's predicates for pairs are not defined there).
bool faces_intersect(const std::vector<Point3>& points, const Triangle& s, const Triangle& t);

// Whether the three points lie on one line or coincide: exact, the same answer as collinear() of
// base/predicates.h, but it asks CGAL only where a bound on the rounding error leaves it open.
// Precondition: finite coordinates.
bool is_degenerate(const Point3& a, const Point3& b, const Point3& c);

}  // namespace cellocut
