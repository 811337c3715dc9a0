// Exact geometric predicates on doubles (CGAL's filtered kernel behind plain functions).
#pragma once

#include "cellocut/base/point.h"

namespace cellocut {

// Sign of six_volumes(a, b, c, d), exact: +1 positively oriented, 0 coplanar, -1 negative.
int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d);

// Whether the three points lie on one line (or coincide), exact.
bool collinear(const Point3& a, const Point3& b, const Point3& c);

// In the plane: +1 where (px, py) lies left of the directed line from a to b, 0 on it, -1 right;
// exact.
int turn(double ax, double ay, double bx, double by, double px, double py);

}  // namespace cellocut
