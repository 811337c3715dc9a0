// Where a plane meets tetrahedra and triangles, as points and segments in the plane.
//
// A point on the plane counts as lying on the positive side, everywhere. So every element is cut
// into two non-empty sets of corners or not at all, neighbours agree on which of their edges are
// cut, and the section of a closed surface is a set of closed loops even where vertices, edges or
// faces lie in the plane (parts of it may then have length zero).
//
// A node is a cut edge of the mesh, a segment a cut triangle (of a surface, or a facet between two
// cells), a polygon a cut tetrahedron.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cellocut/base/point.h"
#include "cellocut/mesh/triangle_soup.h"
#include "viz/section.h"

namespace cellocut::viz {

using Point2 = std::array<double, 2>;

// Unit vectors of the picture: for planes across x: y right, z up; across y: x right, z up; across
// z: x right, y up. An oblique plane takes those of the axis that its normal is nearest to,
// projected. They do not depend on the sign of the normal. Precondition: the normal is not zero.
struct PlaneFrame {
  Point3 right{};
  Point3 up{};
};
PlaneFrame plane_frame(const Plane& plane);

using Segment = std::array<std::uint32_t, 2>;

inline constexpr std::uint32_t kNoNode = 0xffffffffU;

struct CellSection {
  std::vector<Point2> nodes;
  std::vector<std::uint32_t> cells;  // the cells that are cut, ascending
  std::vector<std::array<std::uint32_t, 4>>
      polygons;  // their nodes in order; three: last is kNoNode
};
// O(c + k log k) for c cells of which k are cut.
CellSection section_of_cells(const std::vector<Point3>& points,
                             const std::vector<std::array<std::uint32_t, 4>>& cells,
                             const Plane& plane);

struct SurfaceSection {
  std::vector<Point2> nodes;
  std::vector<Segment> segments;
  bool closed =
      false;  // every node has an even number of segments, so that inside and outside exist
};
// O(t + k log k) for t triangles of which k are cut.
SurfaceSection section_of_surface(const TriangleSoup& surface, const Plane& plane);

// The sides of a polygon, three or four.
std::vector<Segment> sides_of(const std::vector<std::array<std::uint32_t, 4>>& polygons);

// Segments that occur an odd number of times, each once: of the sides of some polygons, the outline
// of their union. O(n log n).
std::vector<Segment> outline(std::vector<Segment> segments);
// Every segment once. O(n log n).
std::vector<Segment> unique_segments(std::vector<Segment> segments);

// A walk along segments; closed where it ends at its first node (which is then not repeated).
struct Chain {
  std::vector<std::uint32_t> nodes;
  bool closed = false;
};
// Partitions the segments into walks, each segment in one walk, once. Where every node has an even
// number of segments all walks are closed. Segments from a node to itself are left out. O(nodes +
// n).
std::vector<Chain> chain_segments(std::size_t node_count, const std::vector<Segment>& segments);

}  // namespace cellocut::viz
