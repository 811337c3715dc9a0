// A triangle soup: plain arrays, nothing merged, nothing dropped. Duplicate, degenerate and
// non-manifold faces are all representable, which is why the input is not a half-edge mesh.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cellocut/base/point.h"

namespace cellocut {

using Triangle = std::array<std::uint32_t, 3>;

struct TriangleSoup {
  std::vector<Point3> points;
  std::vector<Triangle> triangles;
  std::size_t skipped_polygons = 0;  // of the file: fewer than three corners, so no face

  [[nodiscard]] std::size_t triangle_count() const { return triangles.size(); }
  [[nodiscard]] bool empty() const { return triangles.empty(); }
};

// The box of the points that triangles use (stray points do not count). Precondition: not empty.
Box3 bounding_box(const TriangleSoup& soup);

}  // namespace cellocut
