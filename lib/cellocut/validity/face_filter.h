// Tells without exact arithmetic that two faces of a mesh do not meet beyond their common corners:
// the filter before faces_intersect (triangle_pair.h), which decides what it leaves open.
#pragma once

#include <array>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

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
  [[nodiscard]] bool beside_plane(const Point3& p, int& sides) const;
  [[nodiscard]] bool across_edge(int third, const Point3& p) const;
  [[nodiscard]] bool across_any_side(int corner, const std::array<Point3, 3>& others,
                                     int count) const;

  Triangle corners_;
  std::array<Point3, 3> point_;
  Point3 centroid_;
  Point3 normal_;
  Point3 reach_;  // by axis, the longest edge from the first corner
};

}  // namespace cellocut
