// How faces, edges and vertices of a triangle soup meet, by the indices of its corners alone.
//
// A *proper* face has three different corners. Faces with a repeated corner bound nothing: they
// take no part here (a sliver whose short edge is merged away leaves its two neighbours adjacent).
//
// The *link* of a vertex v is a multigraph: one edge for each proper face (v, a, b), joining a and
// b. The degree of a in it is the number of faces at the edge (v, a). A vertex is manifold iff its
// link is one cycle or one path, that is, connected and without a node of degree above two. So both
// ends of an edge with three faces or more are non-manifold, and so is the tip where two fans meet
// (a bow-tie). Two faces with the same corners make a cycle of length two: they are duplicates, not
// non-manifold.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/buckets.h"
#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/validity/surface_report.h"

namespace cellocut {

// A face at an edge with more than two faces; the edge by its end points, low < high.
struct NonmanifoldEdgeFace {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::uint32_t face = 0;
  auto operator<=>(const NonmanifoldEdgeFace&) const = default;
};

struct Incidence {
  IncidenceCounts counts;
  std::int64_t vertices = 0;  // corners of proper faces
  std::int64_t edges = 0;     // of proper faces
  std::int64_t proper_faces = 0;
  std::vector<std::uint8_t> nonmanifold_vertex;        // 1 or 0 for each point
  std::vector<NonmanifoldEdgeFace> nonmanifold_edges;  // sorted: the faces of an edge are adjacent
  // For each face the smallest face that is connected with it through shared edges (whatever the
  // number of faces there); a face that is not proper names itself.
  std::vector<std::uint32_t> component;
};

inline bool is_proper(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

// By point, 3 f + k for each corner k of a proper face f that it is. O(points + faces); parallel.
// Preconditions: all corners below `points`; fewer than 2^32 corners.
Buckets corners_by_point(const std::vector<Triangle>& triangles, std::size_t points);

// `corners_at`: as corners_by_point() gives it.
// O(n + sum over vertices of k log k), k the faces of the vertex; parallel; the same result for any
// number of threads. Errors: Cancelled.
Incidence count_incidence(const std::vector<Triangle>& triangles, const Buckets& corners_at,
                          const Observer& observer);

}  // namespace cellocut
