#include "cellocut/mesh/triangulate_polygon.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace cellocut::mesh_io {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point2 = Kernel::Point_2;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<std::optional<int>, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
// Crossing constraints throw: the projection must not gain a point.
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
    CGAL::No_constraint_intersection_tag>;

void fan(std::span<const std::uint32_t> corners, std::span<Triangle> triangles) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    triangles[i] = {corners[0], corners[i + 1], corners[i + 2]};
  }
}

// The corners without the coordinate in which the Newell normal is longest, turned so that the
// polygon runs counterclockwise; nothing where the normal vanishes.
std::vector<Point2> projected(const std::vector<Point3>& points,
                              std::span<const std::uint32_t> corners) {
  const Point3& origin = points[corners[0]];
  Point3 normal{};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal = normal + cross(points[corners[i]] - origin, points[corners[i + 1]] - origin);
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  std::vector<Point2> result;
  if (normal[axis] == 0 || !std::isfinite(normal[axis])) return result;
  const int u = normal[axis] > 0 ? (axis + 1) % 3 : (axis + 2) % 3;
  const int v = 3 - axis - u;
  result.reserve(corners.size());
  for (const std::uint32_t corner : corners)
    result.emplace_back(points[corner][u], points[corner][v]);
  return result;
}

// Every turn and every triangle of the fan is strictly to the left. (The second rules out outlines
// that run around more than once.)
bool strictly_convex(const std::vector<Point2>& polygon) {
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!CGAL::left_turn(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n])) return false;
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (!CGAL::left_turn(polygon[0], polygon[i], polygon[i + 1])) return false;
  }
  return true;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Gives every face the number of times that the outline runs around it, spreading from outside.
void mark_winding(Triangulation& triangulation, const std::map<Edge, int>& passes) {
  std::vector<Triangulation::Face_handle> pending{triangulation.infinite_face()};
  pending.front()->info() = 0;
  while (!pending.empty()) {
    const Triangulation::Face_handle face = pending.back();
    pending.pop_back();
    for (int k = 0; k < 3; ++k) {
      const Triangulation::Face_handle next = face->neighbor(k);
      if (next->info().has_value()) continue;
      const std::uint32_t from = face->vertex(Triangulation::ccw(k))->info();
      const std::uint32_t to = face->vertex(Triangulation::cw(k))->info();
      // `face` lies to the left of (from, to) and `next` to the right.
      int winding = *face->info();
      if (!triangulation.is_infinite(face, k)) {
        if (const auto found = passes.find({from, to}); found != passes.end()) {
          winding -= found->second;
        }
        if (const auto found = passes.find({to, from}); found != passes.end()) {
          winding += found->second;
        }
      }
      next->info() = winding;
      pending.push_back(next);
    }
  }
}

// False where there is no triangulation with exactly the polygon's corners and edges.
bool constrained(const std::vector<Point2>& polygon, std::span<const std::uint32_t> corners,
                 std::span<Triangle> triangles) try {
  const std::size_t n = polygon.size();
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> vertices(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = triangulation.number_of_vertices();
    vertices[i] = triangulation.insert(polygon[i]);
    // A corner that the outline visits twice keeps the first number.
    if (triangulation.number_of_vertices() > before) {
      vertices[i]->info() = static_cast<std::uint32_t>(i);
    }
  }
  std::map<Edge, int> passes;
  for (std::size_t i = 0; i < n; ++i) {
    const auto from = vertices[i];
    const auto to = vertices[(i + 1) % n];
    if (from == to) return false;
    const Edge edge{from->info(), to->info()};
    // A bridge comes twice, once each way; to CGAL the second constraint would cross the first.
    if (!passes.contains(edge) && !passes.contains({edge.second, edge.first})) {
      triangulation.insert_constraint(from, to);
    }
    ++passes[edge];
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!triangulation.is_edge(vertices[i], vertices[(i + 1) % n])) return false;
  }
  if (triangulation.dimension() < 2) return false;
  mark_winding(triangulation, passes);
  std::vector<Triangle> found;
  for (const auto& face : triangulation.finite_face_handles()) {
    const int winding = *face->info();
    if (winding == 0) continue;
    if (winding != 1) return false;
    found.push_back({corners[face->vertex(0)->info()], corners[face->vertex(1)->info()],
                     corners[face->vertex(2)->info()]});
  }
  if (found.size() != triangles.size()) return false;
  std::copy(found.begin(), found.end(), triangles.begin());
  return true;
} catch (const Triangulation::Intersection_of_constraints_exception&) {
  return false;
}

}  // namespace

void triangulate_polygon(const std::vector<Point3>& points, std::span<const std::uint32_t> corners,
                         std::span<Triangle> triangles) {
  if (corners.size() > 3) {
    const std::vector<Point2> polygon = projected(points, corners);
    if (!polygon.empty() && !strictly_convex(polygon) && constrained(polygon, corners, triangles)) {
      return;
    }
  }
  fan(corners, triangles);
}

}  // namespace cellocut::mesh_io
