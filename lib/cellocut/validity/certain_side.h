// Signs in doubles that are certain: what the filters before exact predicates are made of.
#pragma once

#include <cmath>

#include "cellocut/base/point.h"

namespace cellocut {

inline constexpr double kUnitRoundoff = 0x1p-53;

// -1 or 1 where the sign of normal . (p - origin) is certain, for the given doubles as they stand,
// and 0 elsewhere. Each term is off by one rounding of its difference, one of its product and two
// of sums, so below 5 u times its size; underflow adds less than 1e-300.
inline int certain_side_of_plane(const Point3& normal, const Point3& origin, const Point3& p) {
  double sum = 0;
  double size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double term = normal[axis] * (p[axis] - origin[axis]);
    sum += term;
    size += std::fabs(term);
  }
  const double bound = 8 * kUnitRoundoff * size + 1e-290;
  return sum > bound ? 1 : (sum < -bound ? -1 : 0);
}

// The same for the turn from b - a to p - a, seen along an axis (Shewchuk, "Adaptive precision
// floating-point arithmetic and fast robust geometric predicates", 1997, bounds it by 3 u).
inline int certain_side_of_line(const Point3& a, const Point3& b, const Point3& p, int i, int j) {
  const double left = (b[i] - a[i]) * (p[j] - a[j]);
  const double right = (b[j] - a[j]) * (p[i] - a[i]);
  const double bound = 8 * kUnitRoundoff * (std::fabs(left) + std::fabs(right)) + 1e-290;
  return left - right > bound ? 1 : (left - right < -bound ? -1 : 0);
}

}  // namespace cellocut
