#include "cellocut/field/triangle_set.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstring>
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

// Four lanes at a time (a GCC and Clang vector type), as wide as AVX2: of wider ones the compilers
// take comparisons apart, lane by lane. Compiled for several processors, of which the loader
// chooses (not under sanitizers, which are not up yet at that time). No variant fuses a product and
// a sum, so all give the same bits.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__)
__attribute__((target_clones("avx2", "default")))
#endif
void DistanceTriangle::squared_distances(const EightPoints& points, Eight& squared) const {
  constexpr std::size_t kLanes = 4;
  using Lanes __attribute__((vector_size(kLanes * sizeof(double)))) = double;
  for (std::size_t first = 0; first < squared.size(); first += kLanes) {
    Lanes px;
    Lanes py;
    Lanes pz;
    std::memcpy(&px, &points.x[first], sizeof px);
    std::memcpy(&py, &points.y[first], sizeof py);
    std::memcpy(&pz, &points.z[first], sizeof pz);
    Lanes nearest{};
    Lanes least_side{};
    Lanes height{};
    for (int k = 0; k < 3; ++k) {
      const Point3& e = edge_[k];
      const Lanes x = px - corner_[k][0];
      const Lanes y = py - corner_[k][1];
      const Lanes z = pz - corner_[k][2];
      Lanes t = (x * e[0] + y * e[1] + z * e[2]) * inverse_squared_length_[k];
      t = t < 0.0 ? Lanes{} : t;
      t = t > 1.0 ? Lanes{} + 1.0 : t;
      const Lanes dx = x - t * e[0];
      const Lanes dy = y - t * e[1];
      const Lanes dz = z - t * e[2];
      const Lanes to_edge = dx * dx + dy * dy + dz * dz;
      const Lanes side = x * inward_[k][0] + y * inward_[k][1] + z * inward_[k][2];
      if (k == 0) {
        nearest = to_edge;
        least_side = side;
        height = x * unit_normal_[0] + y * unit_normal_[1] + z * unit_normal_[2];
      } else {
        nearest = to_edge < nearest ? to_edge : nearest;
        least_side = side < least_side ? side : least_side;
      }
    }
    if (has_interior_) nearest = least_side >= 0.0 ? height * height : nearest;
    std::memcpy(&squared[first], &nearest, sizeof nearest);
  }
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
  set.source.reserve(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && corners[order[k]] == corners[order[k - 1]]) continue;
    set.source.push_back(order[k]);
  }
  order = {};
  set.triangles.resize(set.source.size());
  tbb::parallel_for(std::size_t{0}, set.source.size(), [&](std::size_t i) {
    const Corners& c = corners[set.source[i]];
    set.triangles[i] = DistanceTriangle(c[0], c[1], c[2]);
  });
  return set;
}

}  // namespace cellocut
