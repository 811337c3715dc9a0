// The regular grid on which fields live, and its place in the input's coordinates.
#pragma once

#include "cellocut/base/point.h"

namespace cellocut {

// Grid point (i, j, k) lies at origin + spacing * (i, j, k), in input units. `to_input` is one
// monotone function per axis, which is what keeps a surface embedded that is embedded in index
// coordinates (see surface/iso_surface.h).
struct Frame {
  Point3 origin{};
  double spacing = 1;  // h in input units
  double unit = 1;     // longest edge of the input's bounding box, the length of one relative unit
  int resolution = 1;  // R = unit / spacing
  int extent = 0;      // everything of interest has indices in [0, extent)

  [[nodiscard]] double to_input(double index, int axis) const {
    return origin[axis] + spacing * index;
  }
  [[nodiscard]] Point3 to_input(const Point3& index) const {
    return {to_input(index[0], 0), to_input(index[1], 1), to_input(index[2], 2)};
  }
  [[nodiscard]] Point3 to_index(const Point3& p) const {
    return {(p[0] - origin[0]) / spacing, (p[1] - origin[1]) / spacing,
            (p[2] - origin[2]) / spacing};
  }
};

// The frame for a box: spacing = longest edge / resolution, at least `margin` grid steps around the
// box, and the box shifted against the grid by an irrational fraction of a step per axis: with the
// box on the grid, every face of an axis-aligned model would put phi = 0 exactly on grid points.
// Preconditions: resolution >= 1, margin >= 0, longest edge > 0. A scale of the box by a power of
// two scales origin and spacing by exactly that.
Frame make_frame(const Box3& box, int resolution, double margin);

}  // namespace cellocut
