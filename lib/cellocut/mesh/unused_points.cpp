#include "cellocut/mesh/unused_points.h"

namespace cellocut {

TriangleSoup drop_unused_points(const std::vector<Point3>& points,
                                const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> number(points.size(), 0);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) number[v] = 1;
  }
  TriangleSoup compact;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (number[i] == 0) continue;
    number[i] = static_cast<std::uint32_t>(compact.points.size());
    compact.points.push_back(points[i]);
  }
  compact.triangles.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    compact.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  return compact;
}

}  // namespace cellocut
