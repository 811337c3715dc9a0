#include "cellocut/validity/triangle_pair.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cmath>

#include "cellocut/base/predicates.h"

namespace cellocut {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalPoint = Kernel::Point_3;

struct Corners {
  CgalPoint p[3];
};

CgalPoint to_cgal(const Point3& p) { return {p[0], p[1], p[2]}; }

// The corners of a triangle, starting with corner `first`.
Corners corners_from(const std::vector<Point3>& points, const Triangle& t, unsigned first) {
  return {{to_cgal(points[t[first]]), to_cgal(points[t[(first + 1) % 3]]),
           to_cgal(points[t[(first + 2) % 3]])}};
}

// `s` and `t` start with their one common corner.
bool meet_beyond_corner(const Corners& s, const Corners& t) {
  // Most pairs of a mesh end here: a triangle that lies on one side of the other's plane touches
  // that plane in the common corner alone.
  const auto strictly_beside = [](const Corners& plane, const Corners& other) {
    const CGAL::Orientation side =
        CGAL::orientation(plane.p[0], plane.p[1], plane.p[2], other.p[1]);
    return side != CGAL::COPLANAR &&
           CGAL::orientation(plane.p[0], plane.p[1], plane.p[2], other.p[2]) == side;
  };
  if (strictly_beside(s, t) || strictly_beside(t, s)) return false;
  const Kernel::Do_intersect_3 do_intersect;
  return do_intersect(Kernel::Triangle_3(s.p[0], s.p[1], s.p[2]),
                      Kernel::Segment_3(t.p[1], t.p[2])) ||
         do_intersect(Kernel::Triangle_3(t.p[0], t.p[1], t.p[2]),
                      Kernel::Segment_3(s.p[1], s.p[2]));
}

// Whether the projections of a, b, c along one axis are certainly not on one line. The bound on the
// rounding error is that of Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates", 1997, for orient2d, rounded up; the constant term covers underflow.
bool certainly_turns(const Point3& a, const Point3& b, const Point3& c, int i, int j) {
  const double left = (a[i] - c[i]) * (b[j] - c[j]);
  const double right = (a[j] - c[j]) * (b[i] - c[i]);
  const double bound = 4.0e-16 * (std::fabs(left) + std::fabs(right)) + 1e-290;
  return std::fabs(left - right) > bound && std::isfinite(bound);
}

}  // namespace

bool faces_intersect(const std::vector<Point3>& points, const Triangle& s, const Triangle& t) {
  unsigned in_s[3] = {};
  unsigned in_t[3] = {};
  int common = 0;
  for (unsigned i = 0; i < 3; ++i) {
    for (unsigned j = 0; j < 3; ++j) {
      if (s[i] != t[j]) continue;
      in_s[common] = i;
      in_t[common] = j;
      ++common;
    }
  }
  switch (common) {
    case 0: {
      const Corners p = corners_from(points, s, 0);
      const Corners q = corners_from(points, t, 0);
      return Kernel::Do_intersect_3()(Kernel::Triangle_3(p.p[0], p.p[1], p.p[2]),
                                      Kernel::Triangle_3(q.p[0], q.p[1], q.p[2]));
    }
    case 1:
      return meet_beyond_corner(corners_from(points, s, in_s[0]), corners_from(points, t, in_t[0]));
    case 2: {
      const CgalPoint a = to_cgal(points[s[in_s[0]]]);
      const CgalPoint b = to_cgal(points[s[in_s[1]]]);
      const CgalPoint p = to_cgal(points[s[3 - in_s[0] - in_s[1]]]);
      const CgalPoint q = to_cgal(points[t[3 - in_t[0] - in_t[1]]]);
      return CGAL::orientation(a, b, p, q) == CGAL::COPLANAR &&
             CGAL::coplanar_orientation(a, b, p, q) == CGAL::POSITIVE;
    }
    default:
      return true;
  }
}

bool is_degenerate(const Point3& a, const Point3& b, const Point3& c) {
  if (certainly_turns(a, b, c, 0, 1) || certainly_turns(a, b, c, 1, 2) ||
      certainly_turns(a, b, c, 2, 0)) {
    return false;
  }
  return collinear(a, b, c);
}

}  // namespace cellocut
