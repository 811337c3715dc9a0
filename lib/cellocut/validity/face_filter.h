// Tells without exact arithmetic that two faces of a mesh do not meet beyond their common corners:
// the filter before faces_intersect (triangle_pair.h), which decides what it leaves open.
#pragma once

#include <array>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// The plane of a face: on which side of it are others?
class CertainPlane {
 public:
  CertainPlane(const Point3& a, const Point3& b, const Point3& c);

  // Whether the first `count` points certainly lie off the plane, all of them on one side.
  [[nodiscard]] bool certainly_beside(const std::array<Point3, 3>& points, int count) const;

  [[nodiscard]] const Point3& normal() const { return normal_; }

 private:
  [[nodiscard]] int certain_side(const Point3& p) const;

  Point3 corner_;
  Point3 normal_;
  Point3 reach_;  // by axis, the longest edge from the corner
};

// One face, prepared for the test against many.
class PreparedFace {
 public:
  PreparedFace(const std::vector<Point3>& points, const Triangle& face);

  // True only where it is proved that the two meet in common corners or a common edge alone; false
  // says nothing. The proof is a plane or a line that separates them, evaluated in doubles with a
  // bound on the rounding error; infinities and underflow make no proof.
  [[nodiscard]] bool certainly_apart(const std::vector<Point3>& points, const Triangle& t) const;

 private:
  [[nodiscard]] bool separated(const Point3& through, const Point3& normal, int corner,
                               const std::array<Point3, 3>& others, int count) const;
  [[nodiscard]] bool across_edge(int third, const Point3& p) const;
  [[nodiscard]] bool across_any_side(int corner, const std::array<Point3, 3>& others,
                                     int count) const;

  Triangle corners_;
  std::array<Point3, 3> point_;
  CertainPlane plane_;
  Point3 centroid_;
};

}  // namespace cellocut
