#include "cellocut/field/triangle_set.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>

namespace cellocut {

DistanceTriangle::DistanceTriangle(const Point3& a, const Point3& b, const Point3& c)
    : corner_{a, b, c}, edge_{b - a, c - b, a - c} {
  const Point3 normal = cross(edge_[0], c - a);
  const double length = norm(normal);
  has_interior_ = length > 0;
  unit_normal_ = has_interior_ ? (1 / length) * normal : Point3{};
  for (int k = 0; k < 3; ++k) {
    inward_[k] = cross(unit_normal_, edge_[k]);
    const double squared_length = squared_norm(edge_[k]);
    inverse_squared_length_[k] = squared_length > 0 ? 1 / squared_length : 0;
  }
  centre_ = (1.0 / 3) * ((a + b) + c);
  for (const Point3& corner : corner_) radius_ = std::fmax(radius_, norm(corner - centre_));
}

TriangleSet make_triangle_set(const TriangleSoup& mesh, const Frame& frame) {
  using Corners = std::array<Point3, 3>;
  std::vector<Corners> corners(mesh.triangles.size());
  tbb::parallel_for(std::size_t{0}, corners.size(), [&](std::size_t f) {
    for (int k = 0; k < 3; ++k) {
      corners[f][k] = frame.to_index(mesh.points[mesh.triangles[f][k]]);
    }
    std::sort(corners[f].begin(), corners[f].end());
  });
  std::vector<std::uint32_t> order(corners.size());
  std::iota(order.begin(), order.end(), 0U);
  tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    if (corners[i] != corners[j]) return corners[i] < corners[j];
    return i < j;
  });
  TriangleSet set;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && corners[order[k]] == corners[order[k - 1]]) continue;
    const Corners& c = corners[order[k]];
    set.triangles.emplace_back(c[0], c[1], c[2]);
    set.source.push_back(order[k]);
  }
  return set;
}

}  // namespace cellocut
