#include "cellocut/validity/embedded_stars.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <span>

#include "cellocut/validity/certain_side.h"
#include "cellocut/validity/fan.h"

namespace cellocut {

namespace {

// Whether each `to` is one `from`: closed fans, as far as indices go.
bool closes(const Fan& fan) {
  std::uint32_t used = 0;
  for (std::size_t n = 0; n < fan.count; ++n) {
    std::size_t m = 0;
    while (m < fan.count && (fan.from[m] != fan.to[n] || (used >> m & 1U) != 0)) ++m;
    if (m == fan.count) return false;
    used |= 1U << m;
  }
  return fan.count >= 3;
}

bool is_embedded(const std::vector<Point3>& points, std::uint32_t vertex, const Fan& fan) {
  const Point3& v = points[vertex];
  Point3 normal{};
  for (std::size_t n = 0; n < fan.count; ++n) {
    normal = normal + cross(points[fan.from[n]] - v, points[fan.to[n]] - v);
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
  }
  const int i = (axis + 1) % 3;
  const int j = (axis + 2) % 3;
  const int turn = normal[axis] > 0 ? 1 : -1;
  // Closed fans that turn one way go around a whole number of times: as often as they pass from
  // below v to above it along axis i.
  int rounds = 0;
  for (std::size_t n = 0; n < fan.count; ++n) {
    const Point3& a = points[fan.from[n]];
    const Point3& b = points[fan.to[n]];
    if (certain_side_of_line(v, a, b, i, j) != turn) return false;
    if (a[i] < v[i] && b[i] >= v[i]) ++rounds;
  }
  return rounds == 1;
}

}  // namespace

EmbeddedStars::EmbeddedStars(const std::vector<Point3>& points,
                             const std::vector<Triangle>& triangles, const Buckets& corners_at)
    : embedded_(points.size(), 0) {
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t v) {
    const std::span<const std::uint32_t> corners = corners_at[v];
    if (corners.size() > Fan::kMostFaces) return;
    const Fan fan(triangles, corners);
    const auto vertex = static_cast<std::uint32_t>(v);
    embedded_[v] = closes(fan) && is_embedded(points, vertex, fan) ? 1 : 0;
  });
}

}  // namespace cellocut
