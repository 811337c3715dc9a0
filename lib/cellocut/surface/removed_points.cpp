#include "cellocut/surface/removed_points.h"

#include <limits>

#include "cellocut/measure/nearest_triangle.h"

namespace cellocut {

RemovedPoints::RemovedPoints(const std::vector<Point3>& points, const CollapseMesh& mesh,
                             double bound)
    : points_(points),
      squared_bound_(bound * bound),
      first_(mesh.faces().size(), kNone),
      next_(points.size(), kNone) {}

bool RemovedPoints::allows(const Collapse& collapse) {
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
    if (!(least <= squared_bound_)) return false;
    goal_.push_back(nearest);
  }
  return true;
}

void RemovedPoints::applied(const Collapse& collapse) {
  for (const std::uint32_t face : collapse.vanishing) first_[face] = kNone;
  for (const std::uint32_t face : collapse.changed) first_[face] = kNone;
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    const std::uint32_t face = collapse.changed[goal_[i]];
    next_[moved_[i]] = first_[face];
    first_[face] = moved_[i];
  }
}

}  // namespace cellocut
