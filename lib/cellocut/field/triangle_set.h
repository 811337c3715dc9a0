// Triangles prepared for distance queries, in index coordinates and in an order that does not
// depend on the order in which the input lists faces or corners.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cellocut/field/frame.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

using Eight = std::array<double, 8>;

struct EightPoints {
  Eight x;
  Eight y;
  Eight z;
};

// One triangle (possibly degenerate) with what a distance query needs.
class DistanceTriangle {
 public:
  DistanceTriangle() = default;  // the origin
  DistanceTriangle(const Point3& a, const Point3& b, const Point3& c);

  // Squared distance from p. Exact up to rounding for degenerate triangles too: where the triangle
  // has no interior above or below p, the closest point lies on one of the three edges.
  [[nodiscard]] double squared_distance(const Point3& p) const {
    if (has_interior_) {
      const Point3 pa = p - corner_[0];
      const Point3 pb = p - corner_[1];
      const Point3 pc = p - corner_[2];
      if (dot(inward_[0], pa) >= 0 && dot(inward_[1], pb) >= 0 && dot(inward_[2], pc) >= 0) {
        const double height = dot(unit_normal_, pa);
        return height * height;
      }
    }
    return std::min({squared_distance_to_edge(p, 0), squared_distance_to_edge(p, 1),
                     squared_distance_to_edge(p, 2)});
  }

  // What squared_distance gives at each of the points, bit for bit.
  void squared_distances(const EightPoints& points, Eight& squared) const;

  // A ball that holds the triangle.
  [[nodiscard]] const Point3& centre() const { return centre_; }
  [[nodiscard]] double radius() const { return radius_; }

 private:
  [[nodiscard]] double squared_distance_to_edge(const Point3& p, int k) const {
    const Point3 d = p - corner_[k];
    const double t = std::clamp(dot(d, edge_[k]) * inverse_squared_length_[k], 0.0, 1.0);
    return squared_norm(d - t * edge_[k]);
  }

  Point3 corner_[3]{};
  Point3 edge_[3]{};    // corner k to corner k + 1
  Point3 inward_[3]{};  // in the plane, normal to edge k, towards the interior
  Point3 unit_normal_{};
  double inverse_squared_length_[3]{};  // 0 for an edge of length 0
  Point3 centre_{};
  double radius_ = 0;
  bool has_interior_ = false;
};

struct TriangleSet {
  std::vector<DistanceTriangle> triangles;  // de-duplicated, canonical order
  std::vector<std::uint32_t> source;  // source[i]: lowest face index of the mesh that it stands for
};

// Corners sorted lexicographically, triangles sorted and de-duplicated by coordinates: the same set
// for another face order, another corner order and flipped faces. O(n log n).
TriangleSet make_triangle_set(const TriangleSoup& mesh, const Frame& frame);

}  // namespace cellocut
