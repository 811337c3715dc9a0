// Boxes in single precision around points in double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "cellocut/base/point.h"
#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/validity/box_tree.h"

namespace cellocut {

// Maps coordinates into [-1, 1] by x -> (x - centre) * scale. Each step is monotone also after
// rounding, and so is the conversion to float: boxes that overlap before do so afterwards, and no
// box needs to be widened. (Rounding may make boxes overlap that did not; an exact test sees to
// those.)
class FloatFrame {
 public:
  explicit FloatFrame(const Box3& box) {
    double extent = 0;
    for (int axis = 0; axis < 3; ++axis) {
      centre_[axis] = 0.5 * box.low[axis] + 0.5 * box.high[axis];
      extent = std::fmax(extent, 0.5 * box.high[axis] - 0.5 * box.low[axis]);
    }
    scale_ = extent > 0 ? std::ldexp(1.0, std::min(1000, -std::ilogb(extent) - 1)) : 1.0;
  }
  [[nodiscard]] Point3 operator()(const Point3& p) const { return scale_ * (p - centre_); }

 private:
  Point3 centre_{};
  double scale_ = 1;
};

// The box of points in frame coordinates.
inline FloatBox float_box(std::initializer_list<Point3> points) {
  FloatBox box = FloatBox::none();
  for (const Point3& p : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], static_cast<float>(p[axis]));
      box.high[axis] = std::max(box.high[axis], static_cast<float>(p[axis]));
    }
  }
  return box;
}

// The box of a face of a mesh.
inline FloatBox float_box(const FloatFrame& frame, const std::vector<Point3>& points,
                          const Triangle& face) {
  return float_box({frame(points[face[0]]), frame(points[face[1]]), frame(points[face[2]])});
}

}  // namespace cellocut
