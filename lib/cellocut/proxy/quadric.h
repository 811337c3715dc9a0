// Error quadrics (Garland and Heckbert, "Surface simplification using quadric error metrics",
// 1997).
#pragma once

#include <algorithm>
#include <array>

#include "cellocut/base/point.h"

namespace cellocut {

// The squared distance from planes, each times its area. Best about an origin near by: the
// constant is a difference of squares of coordinates.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  // sum of area n n^T
  double x = 0, y = 0, z = 0;                             // sum of area (n . p) n
  double constant = 0;                                    // sum of area (n . p)^2
  double area = 0;

  void operator+=(const Quadric& q) {
    xx += q.xx;
    xy += q.xy;
    xz += q.xz;
    yy += q.yy;
    yz += q.yz;
    zz += q.zz;
    x += q.x;
    y += q.y;
    z += q.z;
    constant += q.constant;
    area += q.area;
  }
  [[nodiscard]] double at(const Point3& p) const {
    const double square = p[0] * (xx * p[0] + 2 * (xy * p[1] + xz * p[2] - x)) +
                          p[1] * (yy * p[1] + 2 * (yz * p[2] - y)) + p[2] * (zz * p[2] - 2 * z);
    return std::max(0.0, square + constant);
  }
};

// Of the plane through a triangle, with this area for its own; nothing for a degenerate one.
// `twice_area` is the cross product of two of its edges.
inline Quadric plane_quadric(const Point3& on_plane, const Point3& twice_area, double area) {
  Quadric q;
  const double length = norm(twice_area);
  if (length == 0) return q;
  const Point3 n = (1 / length) * twice_area;
  const double d = dot(n, on_plane);
  q.xx = area * n[0] * n[0];
  q.xy = area * n[0] * n[1];
  q.xz = area * n[0] * n[2];
  q.yy = area * n[1] * n[1];
  q.yz = area * n[1] * n[2];
  q.zz = area * n[2] * n[2];
  q.x = area * d * n[0];
  q.y = area * d * n[1];
  q.z = area * d * n[2];
  q.constant = area * d * d;
  q.area = area;
  return q;
}

}  // namespace cellocut
