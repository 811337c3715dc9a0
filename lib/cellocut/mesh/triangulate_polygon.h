// One polygon of a mesh file -> triangles. Internal to the mesh readers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut::mesh_io {

// Triangulates the polygon whose corners are points[corners[0]], points[corners[1]], ... and writes
// the corners.size() - 2 triangles, oriented as the polygon, to `triangles`.
//
// The polygon is projected along the axis in which its Newell normal is longest: onto its plane up
// to an affine map, and without rounding. Where it is strictly convex there, the result is the fan
// around the first corner. Otherwise it is the constrained Delaunay triangulation of the
// projection, which takes reflex corners, corners in the middle of an edge, and holes that a bridge
// connects to the outline. A polygon that crosses itself or has no area has no such triangulation
// and gives the fan: no polygon is ever dropped. Preconditions: at least three corners, indices
// valid, coordinates finite, triangles.size() == corners.size() - 2. Complexity: O(n) if convex,
// else O(n log n) expected.
void triangulate_polygon(const std::vector<Point3>& points, std::span<const std::uint32_t> corners,
                         std::span<Triangle> triangles);

}  // namespace cellocut::mesh_io
