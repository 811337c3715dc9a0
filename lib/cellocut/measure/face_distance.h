// How far does a triangle go away from a surface? Branch and bound.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "cellocut/measure/convex_polygon.h"
#include "cellocut/measure/nearest_triangle.h"

namespace cellocut {

// The largest distance from a point of something to something else: at least `lower` (a point at
// that distance has been found) and at most `upper`, up to the rounding of doubles in evaluating
// them (some 1e-15 of the coordinates).
struct DirectedDistance {
  double lower = 0;
  double upper = 0;
};

// A part P of the triangle (a convex polygon) needs no further look where the distance to the
// surface is known to stay below a threshold, by one of
// - the distance is 1-Lipschitz: it is at most that of a point of P plus the radius of P about it;
// - the distance to one face F is convex: on P it is at most its maximum over the corners of P, for
//   the F that is nearest to some point of P.
// (Tang, Lee, Kim, "Interactive Hausdorff distance computation for general polygonal models",
// 2009.) Else P is cut by the planes through the sides of F, perpendicular to F, or halved where
// these leave it whole. So a triangle that coincides with many small faces costs no more than its
// overlay with these has parts.
class FaceDistance {
 public:
  // Both must outlive this; `nearest` is of `surface`. `size`: the longest edge of a box around all
  // that takes part. Parts of 1e-13 of it count as points.
  FaceDistance(const TriangleSoup& surface, const NearestTriangle& nearest, double size)
      : surface_(surface), nearest_(nearest), size_(size) {}

  struct Goal {
    double enough = 0;     // bounds need not be better than this,
    double tolerance = 0;  // nor upper <= (1 + tolerance) lower
    double too_much = std::numeric_limits<double>::infinity();  // stop once `lower` is above
  };

  // `near`: faces of the surface that are near the corners, to begin with (may be empty). Where it
  // stops at `too_much`, `upper` is infinite.
  // O((1 + parts) log n). May be called from any number of threads at once.
  [[nodiscard]] DirectedDistance measure(const std::array<Point3, 3>& corners,
                                         std::span<const std::uint32_t> near,
                                         const Goal& goal) const;

  [[nodiscard]] double distance_to(std::uint32_t face, const Point3& p) const;

 private:
  struct Part {
    ConvexPolygon polygon;
    Point3 seen;      // a point
    double distance;  // and that from it to the surface, at most
  };

  [[nodiscard]] double bound_by(std::uint32_t face, const ConvexPolygon& polygon) const;
  [[nodiscard]] NearestPoint nearest_to(const Point3& p, double limit) const;
  template <class Add>
  bool cut_off(const ConvexPolygon& polygon, std::uint32_t face, const Add& add) const;

  const TriangleSoup& surface_;
  const NearestTriangle& nearest_;
  double size_;
};

}  // namespace cellocut
