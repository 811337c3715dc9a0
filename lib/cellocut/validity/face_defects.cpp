#include "cellocut/validity/face_defects.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "cellocut/validity/incidence.h"
#include "cellocut/validity/position_merge.h"
#include "cellocut/validity/surface_report.h"
#include "cellocut/validity/triangle_pair.h"

namespace cellocut {

namespace {

struct EdgeOfFace {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t face;

  [[nodiscard]] bool same_edge(const EdgeOfFace& other) const {
    return low == other.low && high == other.high;
  }
};

std::vector<EdgeOfFace> list_edges(const TriangleSoup& mesh) {
  const std::vector<std::uint32_t> merged = merge_equal_positions(mesh.points);
  std::vector<EdgeOfFace> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    Triangle t = mesh.triangles[f];
    for (std::uint32_t& v : t) v = merged[v];
    if (!is_proper(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      edges.push_back({low, high, f});
    }
  }
  tbb::parallel_sort(edges.begin(), edges.end(), [](const EdgeOfFace& a, const EdgeOfFace& b) {
    return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
  });
  return edges;
}

bool has_area(const TriangleSoup& mesh, const Triangle& t) {
  const Point3& a = mesh.points[t[0]];
  const Point3& b = mesh.points[t[1]];
  const Point3& c = mesh.points[t[2]];
  return is_finite(a) && is_finite(b) && is_finite(c) && !is_degenerate(a, b, c);
}

}  // namespace

std::vector<std::uint8_t> FaceDefects::gravest() const {
  std::vector<std::uint8_t> result(boundary.size(), 0);
  std::uint8_t value = 0;
  for (const auto* kind : {&boundary, &nonmanifold, &degenerate, &intersecting}) {
    ++value;
    for (std::size_t f = 0; f < result.size(); ++f) {
      if ((*kind)[f] != 0) result[f] = value;
    }
  }
  return result;
}

FaceDefects find_face_defects(const TriangleSoup& mesh, Observer& observer) {
  // First of all, as it refuses what is no mesh.
  const SurfaceReport report = inspect_surface(
      mesh, {.max_pairs = std::numeric_limits<std::size_t>::max(), .observer = &observer});
  const std::size_t faces = mesh.triangles.size();
  FaceDefects defects;
  for (auto* kind :
       {&defects.boundary, &defects.nonmanifold, &defects.degenerate, &defects.intersecting}) {
    kind->assign(faces, 0);
  }
  for (const auto& [f, g] : report.pairs) defects.intersecting[f] = defects.intersecting[g] = 1;
  for (std::size_t f = 0; f < faces; ++f) {
    if (!has_area(mesh, mesh.triangles[f])) defects.degenerate[f] = 1;
  }
  const std::vector<EdgeOfFace> edges = list_edges(mesh);
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].same_edge(edges[begin])) ++end;
    if (end - begin == 2) continue;
    auto& kind = end - begin == 1 ? defects.boundary : defects.nonmanifold;
    for (std::size_t e = begin; e < end; ++e) kind[edges[e].face] = 1;
  }
  return defects;
}

}  // namespace cellocut
