#include "cellocut/surface/distance_test.h"

#include <algorithm>
#include <array>
#include <limits>

namespace cellocut {

DistanceTest::DistanceTest(const TriangleSoup& surface, const CollapseMesh& mesh, double bound)
    : DistanceTest(bounding_box(surface), surface, mesh, bound) {}

// Seen from the middle of the box, as in surface_distance.cpp.
DistanceTest::DistanceTest(const Box3& box, const TriangleSoup& surface, const CollapseMesh& mesh,
                           double bound)
    : surface_(seen_from(0.5 * box.low + 0.5 * box.high, surface)),
      points_(surface_.points),
      bound_(bound),
      nearest_(surface_),
      full_(surface_, nearest_, box.longest_edge()),
      first_(mesh.faces().size(), kNone),
      next_(surface.points.size(), kNone) {}

bool DistanceTest::keeps_removed_points(const Collapse& collapse) {
  moved_.assign(1, collapse.from);
  goal_.clear();
  const auto collect = [this](std::uint32_t v) { moved_.push_back(v); };
  for (const std::uint32_t face : collapse.vanishing) visit_face(face, collect);
  for (const std::uint32_t face : collapse.changed) visit_face(face, collect);
  for (const std::uint32_t v : moved_) {
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = 0;
    for (std::uint32_t i = 0; i < collapse.after.size(); ++i) {
      const Triangle& t = collapse.after[i];
      const Point3& p = points_[v];
      const double squared =
          squared_norm(p - nearest_on_triangle(p, points_[t[0]], points_[t[1]], points_[t[2]]));
      if (squared < least) {
        least = squared;
        nearest = i;
      }
    }
    if (!(least <= bound_ * bound_)) return false;
    goal_.push_back(nearest);
  }
  return true;
}

bool DistanceTest::keeps_faces(const Collapse& collapse) const {
  return std::all_of(collapse.after.begin(), collapse.after.end(), [this](const Triangle& t) {
    const std::array<Point3, 3> corners{points_[t[0]], points_[t[1]], points_[t[2]]};
    return full_.measure(corners, {}, {.enough = bound_, .too_much = bound_}).upper <= bound_;
  });
}

void DistanceTest::applied(const Collapse& collapse) {
  for (const std::uint32_t face : collapse.vanishing) first_[face] = kNone;
  for (const std::uint32_t face : collapse.changed) first_[face] = kNone;
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    const std::uint32_t face = collapse.changed[goal_[i]];
    next_[moved_[i]] = first_[face];
    first_[face] = moved_[i];
  }
}

}  // namespace cellocut
