#include "cellocut/field/frame.h"

#include <cmath>

namespace cellocut {

Frame make_frame(const Box3& box, int resolution, double margin) {
  // Fractional parts of sqrt(2), sqrt(3) and the golden ratio.
  constexpr Point3 kShift{0.41421356237309503, 0.73205080756887729, 0.61803398874989490};
  Frame frame;
  frame.resolution = resolution;
  frame.unit = box.longest_edge();
  frame.spacing = frame.unit / resolution;
  const double steps = std::ceil(margin) + 1;
  for (int axis = 0; axis < 3; ++axis) {
    frame.origin[axis] = box.low[axis] - (steps + kShift[axis]) * frame.spacing;
  }
  frame.extent = resolution + 2 * static_cast<int>(steps) + 3;
  return frame;
}

}  // namespace cellocut
