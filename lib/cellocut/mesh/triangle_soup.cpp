#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

Box3 bounding_box(const TriangleSoup& soup) { return bounding_box(soup.points, soup.triangles); }

Box3 bounding_box(const std::vector<Point3>& points, const std::vector<Triangle>& triangles) {
  Box3 box{points[triangles.front()[0]], points[triangles.front()[0]]};
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t v : triangle) box.include(points[v]);
  }
  return box;
}

Box3 bounding_box(const std::vector<Point3>& points) {
  Box3 box{points.front(), points.front()};
  for (const Point3& p : points) box.include(p);
  return box;
}

}  // namespace cellocut
