// Points all over a segment or a triangle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "cellocut/base/point.h"

namespace cellocut {

// Visits points on the segment that are at most `step` apart, its ends included.
template <class Visit>
void for_each_raster_point(const Point3& a, const Point3& b, double step, const Visit& visit) {
  const Point3 along = b - a;
  const int steps = std::max(1, static_cast<int>(std::ceil(norm(along) / step)));
  for (int i = 0; i <= steps; ++i) visit(a + (static_cast<double>(i) / steps) * along);
}

// Visits points within the triangle: on rows at most `step` apart between the longest edge and the
// corner opposite, which are not of the edges but for the ends of rows. As many as its area asks
// for, however thin it is.
template <class Visit>
void for_each_inner_raster_point(const std::array<Point3, 3>& corner, double step,
                                 const Visit& visit) {
  int base = 0;
  double longest = -1;
  for (int k = 0; k < 3; ++k) {
    const double length = norm(corner[(k + 1) % 3] - corner[k]);
    if (length > longest) {
      longest = length;
      base = k;
    }
  }
  const Point3& a = corner[base];
  const Point3 along = corner[(base + 1) % 3] - a;
  const Point3 side = corner[(base + 2) % 3] - a;
  const double height = longest > 0 ? norm(cross(along, side)) / longest : 0;
  const int rows = std::max(1, static_cast<int>(std::ceil(height / step)));
  for (int row = 1; row < rows; ++row) {
    const double t = static_cast<double>(row) / rows;
    const Point3 start = a + t * side;
    for_each_raster_point(start, start + (1 - t) * along, step, visit);
  }
}

// Visits points on the triangle: those and points on its edges.
template <class Visit>
void for_each_raster_point(const std::array<Point3, 3>& corner, double step, const Visit& visit) {
  for (int k = 0; k < 3; ++k) for_each_raster_point(corner[k], corner[(k + 1) % 3], step, visit);
  for_each_inner_raster_point(corner, step, visit);
}

}  // namespace cellocut
