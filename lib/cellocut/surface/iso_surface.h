// Marching cubes whose result is embedded by construction: the one iso-surfacing routine, used for
// the proxy and for the output.
//
// The surface is closed, oriented from inside (value < 0) to outside, a 2-manifold, free of
// degenerate and of intersecting triangles, in the output coordinates after rounding, and no pass
// afterwards deletes or moves a face. The argument:
//
// 1. Vertices. Every grid edge with one end inside and one outside carries one vertex, strictly
// between
//    its ends (at least kClearance of the edge away from both). Output coordinates come from one
//    monotone function per axis (Frame::to_input), so grid cells become boxes and every vertex lies
//    exactly on, and strictly inside, an edge of its boxes, whatever the rounding. All that follows
//    is about boxes with arbitrary points strictly inside their edges.
//
// 2. Faces. In a face of a box the vertices are joined by one segment for each run of outside
// corners.
//    At an ambiguous face both outside corners are cut off and the inside is joined. The two
//    segments do not meet (a diagonal of the face's unit square separates them), and both boxes at
//    the face draw the same. In a box the segments form disjoint simple loops on the boundary,
//    since each vertex ends one segment in each of the two faces of its edge.
//
// 3. One loop, one disk. A fan over a loop from an apex strictly inside the box is embedded:
// projection
//    from the apex is one-to-one on the box's boundary. So is a fan from a loop vertex v whose two
//    faces the loop visits once each: all segments but the two at v lie in faces that do not
//    contain v, and a ray from v leaves the box through those faces in one point. No triangle of
//    such a fan lies in a face: a triangle (v, a, b) has its segment ab in a face without v. For
//    the same reason none is degenerate. A loop where no such v exists gets the mean of its
//    vertices as apex; that is strictly inside, as no loop lies in one face.
//
// 4. Several loops. The inside is joined across faces, so the inside corners of a box are one
// component
//    unless they are exactly two opposite corners; each loop then surrounds one edge-connected
//    component of outside corners, and there is one disk per component. Two such components are a
//    single corner and anything beyond its neighbours, or two opposite parallel edges. With the
//    single corner at (0,0,0) its triangle lies in x + y + z < 1, and every edge cut by a component
//    of corners at distance two or more has one end with coordinate sum >= 2 and the other with sum
//    >= 1, so its vertices have sum > 1. Two parallel edges are separated by x + y = 1 in the same
//    way. Disks lie in the convex hulls of their loops (an inner point is only needed where the box
//    has a single loop), so they are disjoint.
//
// 5. Two opposite inside corners are joined by a tube. With p_i on the edges at one corner and q_i
// at
//    the other, each triangle (p_i, p_j, q_k), i, j, k different, is a facet of the convex hull of
//    the six points: through p = (a,0,0), (0,b,0) and q = (1,1,q) the plane x/a + y/b + kz = 1 has
//    k = -(1/a + 1/b - 1)/q < 0, and the other three points have values below 1. The tube is that
//    hull's boundary without two triangles: embedded, and none of its triangles in a face of the
//    box.
//
// 6. Together. Interiors of triangles lie in the open boxes or, for the segments of 2, in faces,
// where
//    neighbouring boxes agree; so boxes meet in common segments and vertices only. A segment lies
//    in the two boxes at its face, a fan edge in one box: every edge has two triangles. Around a
//    vertex the boxes at its grid edge follow each other through the faces at that edge, each
//    contributing one fan of triangles between its two segments: the link is one cycle.
//
// Joining the inside also keeps thin sheets whole: with a thickness of at least one grid step every
// grid line along the dominant axis of a sheet has an inside point, so outside points of the two
// sides are never neighbours along an edge, and only such neighbours are joined outside.
#pragma once

#include "cellocut/field/frame.h"
#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// d: how far a vertex keeps from the ends of its grid edge, in grid steps.
inline constexpr double kClearance = 1.0 / 64;

// The surface value = 0 of the field in index coordinates of its grid. Each coordinate of a vertex
// is a grid index, or a grid index plus a fraction in [kClearance, 1 - kClearance]; inner points
// are means. Precondition: the field is 1-Lipschitz in the band (sparse_field.h), as distances are.
// Vertex and face order follow the blocks of the grid: the same for any number of threads.
// O(stored).
TriangleSoup extract_iso_surface(const SparseField& field);

// Index coordinates to input units, vertex by vertex, monotone per axis.
void to_input_units(TriangleSoup& surface, const Frame& frame);
// And back.
void to_index_coordinates(TriangleSoup& surface, const Frame& frame);

}  // namespace cellocut
