// Is a triangle mesh the boundary of a solid? Counts what is wrong with it, by indices and after an
// exact-position merge, with exact predicates wherever geometry decides.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Counts of incidence. "Non-manifold vertex" is judged by link: the faces around it do not form one
// cycle (or, at a boundary, one path), so both ends of a non-manifold edge count; "misoriented"
// edges have two faces that run along them in the same direction.
struct IncidenceCounts {
  std::int64_t boundary_edges = 0;        // one face
  std::int64_t nonmanifold_edges = 0;     // more than two faces
  std::int64_t misoriented_edges = 0;     // two faces, same direction
  std::int64_t nonmanifold_vertices = 0;  // link is neither one cycle nor one path
  std::int64_t duplicate_faces = 0;       // faces with the same three vertices as an earlier one
};

struct SurfaceComponent {
  std::int64_t triangles = 0;
  double volume = 0;  // signed, by the divergence theorem
};

struct SurfaceReport {
  std::int64_t points = 0;  // used by faces
  std::int64_t triangles = 0;
  IncidenceCounts by_index;
  IncidenceCounts by_position;        // after points with equal coordinates are merged
  std::int64_t degenerate_faces = 0;  // three points on one line, by exact predicate
  std::int64_t nonfinite_points = 0;
  // Pairs of faces that share more than their common corners and edges (corners with equal
  // coordinates count as common). Degenerate faces and faces with points that are not finite are in
  // no pair: they are counted above, as in CGAL, whose list names a degenerate face by itself.
  // `pairs` has the smaller index first and holds the first `max_pairs` in lexicographic order.
  bool intersections_tested = false;
  std::int64_t intersecting_pairs = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  // Edges and vertices in which parts of the surface meet that are separate by index: where the
  // solid touches itself. (Non-manifold by position, manifold by index. The ends of a touching edge
  // are touching vertices as well, for the link of each is no cycle.)
  std::int64_t touching_edges = 0;
  std::int64_t touching_vertices = 0;
  // Connected by shared edges (by index), largest |volume| first. Faces with a repeated corner have
  // no edges and are in none, nor in `euler`.
  std::vector<SurfaceComponent> components;
  double volume = 0;  // signed, of all components
  double area = 0;
  std::int64_t euler = 0;  // vertices - edges + faces, by index

  // Closed, oriented, manifold by index, finite, nothing degenerate, nothing intersecting, not
  // empty. False where intersections were not tested.
  [[nodiscard]] bool valid() const;
};

struct SurfaceCheckOptions {
  std::size_t max_pairs = 1000;  // how many intersecting pairs to list; all are counted
  bool intersections = true;     // false skips the intersection test
  Observer* observer = nullptr;
};

// O(n log n) on meshes whose faces are of similar size. Parallel; the same report for any number of
// threads (pairs are sorted, sums are taken in face order).
// Errors: InputError where a face names a point that is not there; Cancelled.
SurfaceReport inspect_surface(const TriangleSoup& mesh, const SurfaceCheckOptions& options = {});

}  // namespace cellocut
