#include "cellocut/surface/collapse_test.h"

#include <algorithm>
#include <cmath>

#include "cellocut/validity/face_filter.h"
#include "cellocut/validity/triangle_pair.h"

namespace cellocut {

namespace {

constexpr double kLeastCosine = 0.2;  // between the normals of a face before and after
constexpr double kLeastShape = 1e-3;  // height by longest side

bool has_corner(const Triangle& t, std::uint32_t v) { return t[0] == v || t[1] == v || t[2] == v; }

Point3 normal_of(const std::vector<Point3>& points, const Triangle& t) {
  return cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
}

// Height by longest side, squared.
double squared_shape(const std::vector<Point3>& points, const Triangle& t) {
  const double longest = std::max({squared_norm(points[t[1]] - points[t[0]]),
                                   squared_norm(points[t[2]] - points[t[1]]),
                                   squared_norm(points[t[0]] - points[t[2]])});
  return squared_norm(normal_of(points, t)) / (longest * longest);
}

}  // namespace

CollapseTest::CollapseTest(const std::vector<Point3>& points, const CollapseMesh& mesh)
    : points_(points), faces_(mesh.faces()), live_(points, mesh.faces()) {}

CollapseVerdict CollapseTest::judge(const Collapse& collapse) {
  double least_shape = kLeastShape * kLeastShape;
  for (const std::uint32_t face : collapse.vanishing) {
    least_shape = std::min(least_shape, squared_shape(points_, faces_[face]));
  }
  for (const std::uint32_t face : collapse.changed) {
    least_shape = std::min(least_shape, squared_shape(points_, faces_[face]));
  }
  for (std::size_t i = 0; i < collapse.after.size(); ++i) {
    const Point3 before = normal_of(points_, faces_[collapse.changed[i]]);
    const Point3 after = normal_of(points_, collapse.after[i]);
    if (!(dot(before, after) >= kLeastCosine * (norm(before) * norm(after)))) {
      return CollapseVerdict::folds;
    }
  }
  for (const Triangle& t : collapse.after) {
    if (!(squared_shape(points_, t) >= least_shape)) return CollapseVerdict::sliver;
  }
  for (const Triangle& t : collapse.after) {
    if (is_degenerate(points_[t[0]], points_[t[1]], points_[t[2]])) {
      return CollapseVerdict::degenerate;
    }
  }
  return meets_others(collapse) ? CollapseVerdict::intersecting : CollapseVerdict::allowed;
}

bool CollapseTest::meets_others(const Collapse& collapse) {
  FloatBox all = FloatBox::none();
  boxes_.clear();
  for (const Triangle& t : collapse.after) {
    boxes_.push_back(live_.box_of(t));
    all.include(boxes_.back());
  }
  nearby_.clear();
  live_.find(all, [this](std::uint32_t face) { nearby_.push_back(face); });
  // The faces around the vertex that goes are those that are replaced.
  std::erase_if(nearby_,
                [&](std::uint32_t face) { return has_corner(faces_[face], collapse.from); });

  for (std::size_t i = 0; i < collapse.after.size(); ++i) {
    const Triangle& face = collapse.after[i];
    const PreparedFace prepared(points_, face);
    const auto meets = [&](const Triangle& other) {
      return !prepared.certainly_apart(points_, other) && faces_intersect(points_, face, other);
    };
    for (const std::uint32_t other : nearby_) {
      if (overlap(boxes_[i], live_.box(other)) && meets(faces_[other])) return true;
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (overlap(boxes_[i], boxes_[j]) && meets(collapse.after[j])) return true;
    }
  }
  return false;
}

void CollapseTest::applied(const Collapse& collapse) {
  for (std::size_t i = 0; i < collapse.changed.size(); ++i) {
    live_.change(collapse.changed[i], collapse.after[i]);
  }
  for (const std::uint32_t face : collapse.vanishing) live_.remove(face);
}

}  // namespace cellocut
