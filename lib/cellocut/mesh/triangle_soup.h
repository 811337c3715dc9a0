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
using Rgb = std::array<std::uint8_t, 3>;  // red, green, blue, as files hold them

struct TriangleSoup {
  std::vector<Point3> points;
  std::vector<Triangle> triangles;
  std::size_t skipped_polygons = 0;  // of the file: fewer than three corners, so no face
  // One for each point; or none at all, where the file has none. Whoever adds, drops or merges
  // points keeps this so, if need be by clearing it.
  std::vector<Rgb> colours{};

  [[nodiscard]] std::size_t triangle_count() const { return triangles.size(); }
  [[nodiscard]] bool empty() const { return triangles.empty(); }
};

// The box of the points that triangles use (stray points do not count). Precondition: not empty.
Box3 bounding_box(const TriangleSoup& soup);
Box3 bounding_box(const std::vector<Point3>& points, const std::vector<Triangle>& triangles);
// Of the given faces.
Box3 bounding_box(const std::vector<Point3>& points, const std::vector<Triangle>& triangles,
                  const std::vector<std::uint32_t>& faces);
// The box of all points. Precondition: not empty.
Box3 bounding_box(const std::vector<Point3>& points);

// The points and faces with `origin` as the new one, each coordinate rounded once. Parallel.
TriangleSoup seen_from(const Point3& origin, const TriangleSoup& soup);

}  // namespace cellocut
