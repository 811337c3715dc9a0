#include "cellocut/base/predicates.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace cellocut {

namespace {
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
Kernel::Point_3 to_cgal(const Point3& p) { return {p[0], p[1], p[2]}; }
}  // namespace

int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return static_cast<int>(CGAL::orientation(to_cgal(a), to_cgal(b), to_cgal(c), to_cgal(d)));
}

int turn(double ax, double ay, double bx, double by, double px, double py) {
  return static_cast<int>(
      CGAL::orientation(Kernel::Point_2(ax, ay), Kernel::Point_2(bx, by), Kernel::Point_2(px, py)));
}

bool collinear(const Point3& a, const Point3& b, const Point3& c) {
  return CGAL::collinear(to_cgal(a), to_cgal(b), to_cgal(c));
}

}  // namespace cellocut
