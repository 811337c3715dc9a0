// Points and the few vector operations that the method needs.
// Every function evaluates in the order written, so that results are the same bits on every run
// (the build sets -ffp-contract=off).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace cellocut {

using Point3 = std::array<double, 3>;

constexpr Point3 operator+(const Point3& a, const Point3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
constexpr Point3 operator-(const Point3& a, const Point3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
constexpr Point3 operator*(double s, const Point3& a) { return {s * a[0], s * a[1], s * a[2]}; }

constexpr double dot(const Point3& a, const Point3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
constexpr Point3 cross(const Point3& a, const Point3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
constexpr double squared_norm(const Point3& a) { return dot(a, a); }
inline double norm(const Point3& a) { return std::sqrt(squared_norm(a)); }

inline double triangle_area(const Point3& a, const Point3& b, const Point3& c) {
  return 0.5 * norm(cross(b - a, c - a));
}
// Six times the signed volume of (a, b, c, d): positive when d lies on the side of triangle (a, b,
// c) from which it is seen clockwise, that is, for the usual positively oriented tetrahedron
// (0,0,0), (1,0,0), (0,1,0), (0,0,1).
constexpr double six_volumes(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return dot(cross(b - a, c - a), d - a);
}

inline bool is_finite(const Point3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

struct Box3 {
  Point3 low{};
  Point3 high{};
  void include(const Point3& p) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  void include(const Box3& other) {
    include(other.low);
    include(other.high);
  }
  [[nodiscard]] double longest_edge() const {
    return std::fmax(high[0] - low[0], std::fmax(high[1] - low[1], high[2] - low[2]));
  }
};

}  // namespace cellocut
