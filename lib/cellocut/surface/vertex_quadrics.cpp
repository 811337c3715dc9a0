#include "cellocut/surface/vertex_quadrics.h"

#include <algorithm>

namespace cellocut {

namespace {

constexpr double kCompactness = 1e-5;  // the weight of vertices against that of planes

using OpenMesh::Geometry::Quadricd;

}  // namespace

VertexQuadrics::VertexQuadrics(const TriangleSoup& surface)
    : points_(surface.points), quadric_(points_.size()), own_cost_(points_.size(), 0.0) {
  const Box3 box = bounding_box(surface);
  centre_ = 0.5 * box.low + 0.5 * box.high;
  if (box.longest_edge() > 0) unit_ = box.longest_edge();
  for (const Triangle& t : surface.triangles) {
    const Point a = at(t[0]);
    Point normal = cross(at(t[1]) - a, at(t[2]) - a);
    const double length = normal.norm();
    if (!(length > 0)) continue;
    normal /= length;
    const double area = 0.5 * length;
    const Quadricd plane = Quadricd(normal, a) * area;
    for (const std::uint32_t v : t) {
      quadric_[v] += plane;
      quadric_[v] += Quadricd(at(v)) * (kCompactness * area);
    }
  }
  for (std::uint32_t v = 0; v < points_.size(); ++v) own_cost_[v] = quadric_[v](at(v));
}

VertexQuadrics::Point VertexQuadrics::at(std::uint32_t v) const {
  const Point3& p = points_[v];
  return {(p[0] - centre_[0]) / unit_, (p[1] - centre_[1]) / unit_, (p[2] - centre_[2]) / unit_};
}

double VertexQuadrics::cost(std::uint32_t from, std::uint32_t to) const {
  // Rounding may leave a little less than nothing.
  return std::max(0.0, quadric_[from](at(to)) + own_cost_[to]);
}

void VertexQuadrics::merge(std::uint32_t from, std::uint32_t to) {
  quadric_[to] += quadric_[from];
  own_cost_[to] = quadric_[to](at(to));
}

}  // namespace cellocut
