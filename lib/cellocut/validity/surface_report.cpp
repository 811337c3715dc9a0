#include "cellocut/validity/surface_report.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string>

#include "cellocut/base/first_index.h"
#include "cellocut/validity/incidence.h"
#include "cellocut/validity/intersections.h"
#include "cellocut/validity/position_merge.h"
#include "cellocut/validity/triangle_pair.h"

namespace cellocut {

namespace {

// What the coordinates of a face allow.
enum class FaceShape : std::uint8_t { proper, degenerate, nonfinite };

void check_indices(const TriangleSoup& mesh) {
  if (mesh.triangles.size() > UINT32_MAX / 3 || mesh.points.size() > UINT32_MAX) {
    throw LimitError("the surface check is limited to 1431655765 faces");
  }
  const std::size_t faces = mesh.triangles.size();
  const std::size_t bad = first_index(faces, [&mesh](std::size_t f) {
    const Triangle& t = mesh.triangles[f];
    return std::max({t[0], t[1], t[2]}) >= mesh.points.size();
  });
  if (bad == faces) return;
  const Triangle& t = mesh.triangles[bad];
  const auto named = std::find_if(t.begin(), t.end(),
                                  [&mesh](std::uint32_t v) { return v >= mesh.points.size(); });
  throw InputError("face " + std::to_string(bad) + " names point " + std::to_string(*named) +
                   ", but there are only " + std::to_string(mesh.points.size()) + " points");
}

void count_points(const TriangleSoup& mesh, SurfaceReport& report) {
  std::vector<std::uint8_t> used(mesh.points.size(), 0);
  tbb::parallel_for(std::size_t{0}, mesh.triangles.size(), [&](std::size_t f) {
    for (const std::uint32_t v : mesh.triangles[f]) {
      std::atomic_ref(used[v]).store(1, std::memory_order_relaxed);
    }
  });
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (used[v] == 0) continue;
    ++report.points;
    if (!is_finite(mesh.points[v])) ++report.nonfinite_points;
  }
}

std::vector<FaceShape> judge_shapes(const TriangleSoup& mesh) {
  std::vector<FaceShape> shapes(mesh.triangles.size());
  tbb::parallel_for(std::size_t{0}, shapes.size(), [&](std::size_t f) {
    const Triangle& t = mesh.triangles[f];
    const Point3& a = mesh.points[t[0]];
    const Point3& b = mesh.points[t[1]];
    const Point3& c = mesh.points[t[2]];
    if (!is_finite(a) || !is_finite(b) || !is_finite(c)) {
      shapes[f] = FaceShape::nonfinite;
    } else {
      shapes[f] = is_degenerate(a, b, c) ? FaceShape::degenerate : FaceShape::proper;
    }
  });
  return shapes;
}

// Volumes are sums of tetrahedra over the faces, with the centre of the box as apex, in face order:
// near the surface, so that a far offset costs no digits. (Only for open surfaces does the apex
// matter.)
void sum_components(const TriangleSoup& mesh, const Incidence& incidence,
                    const std::vector<FaceShape>& shapes, SurfaceReport& report) {
  std::vector<std::uint32_t> finite;
  finite.reserve(shapes.size());
  for (std::uint32_t f = 0; f < shapes.size(); ++f) {
    if (shapes[f] != FaceShape::nonfinite) finite.push_back(f);
  }
  Point3 apex{};
  if (!finite.empty()) {
    const Box3 box = bounding_box(mesh.points, mesh.triangles, finite);
    apex = 0.5 * box.low + 0.5 * box.high;
  }
  std::vector<double> volume(shapes.size(), 0);
  std::vector<double> area(shapes.size(), 0);
  tbb::parallel_for(std::size_t{0}, finite.size(), [&](std::size_t i) {
    const std::uint32_t f = finite[i];
    const Triangle& t = mesh.triangles[f];
    const Point3& a = mesh.points[t[0]];
    const Point3& b = mesh.points[t[1]];
    const Point3& c = mesh.points[t[2]];
    volume[f] = six_volumes(apex, a, b, c) / 6;
    area[f] = triangle_area(a, b, c);
  });
  std::vector<std::uint32_t> index_of(shapes.size());
  for (std::size_t f = 0; f < shapes.size(); ++f) {
    if (!is_proper(mesh.triangles[f])) continue;
    const std::uint32_t root = incidence.component[f];
    if (root == f) {
      index_of[f] = static_cast<std::uint32_t>(report.components.size());
      report.components.emplace_back();
    }
    SurfaceComponent& component = report.components[index_of[root]];
    ++component.triangles;
    component.volume += volume[f];
    report.area += area[f];
  }
  for (const SurfaceComponent& component : report.components) report.volume += component.volume;
  std::stable_sort(report.components.begin(), report.components.end(),
                   [](const SurfaceComponent& a, const SurfaceComponent& b) {
                     const double volume_a = std::fabs(a.volume);
                     const double volume_b = std::fabs(b.volume);
                     return volume_a != volume_b ? volume_a > volume_b : a.triangles > b.triangles;
                   });
}

// Whether the faces at one edge (by position) make edges by index with at most two faces each.
bool separate_by_index(const TriangleSoup& mesh, const std::vector<std::uint32_t>& merged,
                       const NonmanifoldEdgeFace* begin, const NonmanifoldEdgeFace* end) {
  std::vector<FacePair> edges;
  for (const NonmanifoldEdgeFace* entry = begin; entry != end; ++entry) {
    FacePair edge;
    for (const std::uint32_t v : mesh.triangles[entry->face]) {
      if (merged[v] == entry->low) edge.first = v;
      if (merged[v] == entry->high) edge.second = v;
    }
    edges.push_back(edge);
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 2; i < edges.size(); ++i) {
    if (edges[i] == edges[i - 2]) return false;
  }
  return true;
}

void count_contacts(const TriangleSoup& mesh, const std::vector<std::uint32_t>& merged,
                    const Incidence& by_index, const Incidence& by_position,
                    SurfaceReport& report) {
  const auto& entries = by_position.nonmanifold_edges;
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    while (end < entries.size() && entries[end].low == entries[begin].low &&
           entries[end].high == entries[begin].high) {
      ++end;
    }
    if (separate_by_index(mesh, merged, entries.data() + begin, entries.data() + end)) {
      ++report.touching_edges;
    }
  }
  std::vector<std::uint8_t> touching = by_position.nonmanifold_vertex;
  for (std::size_t v = 0; v < merged.size(); ++v) {
    if (by_index.nonmanifold_vertex[v] != 0) touching[merged[v]] = 0;
  }
  report.touching_vertices = std::count(touching.begin(), touching.end(), 1);
}

}  // namespace

bool SurfaceReport::valid() const {
  return triangles > 0 && by_index.boundary_edges == 0 && by_index.nonmanifold_edges == 0 &&
         by_index.misoriented_edges == 0 && by_index.nonmanifold_vertices == 0 &&
         by_index.duplicate_faces == 0 && nonfinite_points == 0 && degenerate_faces == 0 &&
         intersections_tested && intersecting_pairs == 0;
}

SurfaceReport inspect_surface(const TriangleSoup& mesh, const SurfaceCheckOptions& options) {
  Observer& observer = options.observer != nullptr ? *options.observer : silent_observer();
  check_indices(mesh);
  SurfaceReport report;
  report.triangles = static_cast<std::int64_t>(mesh.triangles.size());
  count_points(mesh, report);
  const std::vector<FaceShape> shapes = judge_shapes(mesh);
  report.degenerate_faces = std::count(shapes.begin(), shapes.end(), FaceShape::degenerate);

  std::optional<Buckets> corners_at = corners_by_point(mesh.triangles, mesh.points.size());
  const Incidence by_index = count_incidence(mesh.triangles, *corners_at, observer);
  report.by_index = by_index.counts;
  report.euler = by_index.vertices - by_index.edges + by_index.proper_faces;
  sum_components(mesh, by_index, shapes, report);

  const std::vector<std::uint32_t> merged = merge_equal_positions(mesh.points);
  std::vector<Triangle> triangles(mesh.triangles.size());
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t f) {
    for (int k = 0; k < 3; ++k) triangles[f][k] = merged[mesh.triangles[f][k]];
  });
  if (triangles == mesh.triangles) {  // no two used points in one place
    report.by_position = by_index.counts;
  } else {
    corners_at = corners_by_point(triangles, mesh.points.size());
    const Incidence by_position = count_incidence(triangles, *corners_at, observer);
    report.by_position = by_position.counts;
    count_contacts(mesh, merged, by_index, by_position, report);
  }

  if (options.intersections) {
    std::vector<std::uint8_t> takes_part(shapes.size());
    std::transform(shapes.begin(), shapes.end(), takes_part.begin(),
                   [](FaceShape shape) { return shape == FaceShape::proper ? 1 : 0; });
    IntersectingPairs found = find_intersecting_pairs(mesh.points, triangles, *corners_at,
                                                      takes_part, options.max_pairs, observer);
    report.intersections_tested = true;
    report.intersecting_pairs = found.count;
    report.pairs = std::move(found.first);
  }
  return report;
}

}  // namespace cellocut
