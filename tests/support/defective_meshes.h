// Small meshes with one defect each, named by it, and the sound shapes that they are made of. All
// are generated; all are deterministic.
#pragma once

#include <string>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut::test {

// ---- sound shapes: closed, outward, manifold
// ------------------------------------------------------

// The icosahedron, each triangle divided into 4^subdivisions, on the sphere.
TriangleSoup icosphere(int subdivisions, double radius = 1, const Point3& centre = {0, 0, 0});
// Twelve triangles.
TriangleSoup box(const Point3& low, const Point3& high);
// Around the z axis; `around` and `across` are numbers of quads, each at least 3.
TriangleSoup torus(double ring_radius, double tube_radius, int around, int across);

// ---- defects
// --------------------------------------------------------------------------------------

// Half a sphere without a lid, a single layer: one boundary loop.
TriangleSoup open_bowl();
// Two overlapping boxes in general position: closed, but they intersect each other.
TriangleSoup two_crossing_boxes();
// A band with half a twist: one side, one boundary loop, no consistent orientation.
TriangleSoup moebius_strip();
// A square of 2 subdivisions^2 triangles with edge length `size` around the origin, at right angles
// to `normal` (of any length but zero).
TriangleSoup tilted_sheet(const Point3& normal, double size, int subdivisions);
// tilted_sheet at a direction that no axis or diagonal shares.
TriangleSoup single_sheet();
// Three spheres inside one another, all outward.
TriangleSoup nested_spheres();
// Two tetrahedra that share one vertex and nothing else.
TriangleSoup bow_tie_vertex();
// A box, some of whose faces are there twice, once with the opposite orientation.
TriangleSoup duplicate_faces();
// A box, one side of which is divided further than its neighbours: vertices in the middle of edges.
TriangleSoup t_junctions();
// A single triangle.
TriangleSoup one_triangle();
// A tessellated box, every other face (by a fixed pseudo-random choice) turned inside out.
TriangleSoup flipped_faces();
// A sphere with a ring of faces missing around a pole.
TriangleSoup sphere_with_hole();
// A sphere with collinear, repeated-corner and single-point triangles added.
TriangleSoup degenerate_faces();

struct NamedSoup {
  std::string name;
  TriangleSoup soup;
};

// Every defect above, under the name of its function.
std::vector<NamedSoup> all_defective_meshes();

}  // namespace cellocut::test
