#include "cellocut/measure/face_distance.h"

#include <vector>

namespace cellocut {

namespace {

constexpr double kRounding = 1e-13;  // of the size: parts beyond a plane by less are not cut off

}  // namespace

double FaceDistance::distance_to(std::uint32_t face, const Point3& p) const {
  const Triangle& t = surface_.triangles[face];
  const std::vector<Point3>& points = surface_.points;
  return norm(p - nearest_on_triangle(p, points[t[0]], points[t[1]], points[t[2]]));
}

double FaceDistance::bound_by(std::uint32_t face, const ConvexPolygon& polygon) const {
  double bound = 0;
  for (const Point3& p : polygon) bound = std::max(bound, distance_to(face, p));
  return bound;
}

// `limit`: known to be at least the distance, but for rounding.
NearestPoint FaceDistance::nearest_to(const Point3& p, double limit) const {
  const NearestPoint nearest = nearest_(p, limit * (1 + 1e-9) + kRounding * size_);
  return nearest.found() ? nearest : nearest_(p);
}

DirectedDistance FaceDistance::measure(const std::array<Point3, 3>& corners,
                                       std::span<const std::uint32_t> near,
                                       const Goal& goal) const {
  DirectedDistance found;
  const auto threshold = [&] { return std::max(goal.enough, (1 + goal.tolerance) * found.lower); };
  ConvexPolygon whole;
  for (const Point3& p : corners) whole.add(p);
  double bound = std::numeric_limits<double>::infinity();
  for (const std::uint32_t face : near) bound = std::min(bound, bound_by(face, whole));
  if (bound <= threshold()) {
    found.upper = bound;
    return found;
  }
  std::vector<Part> parts{{whole, whole[0], std::numeric_limits<double>::infinity()}};
  while (!parts.empty()) {
    const Part part = parts.back();
    parts.pop_back();
    const Point3 centre = part.polygon.centre();
    const NearestPoint nearest = nearest_to(centre, part.distance + norm(centre - part.seen));
    found.lower = std::max(found.lower, nearest.distance);
    if (found.lower > goal.too_much) {
      found.upper = std::numeric_limits<double>::infinity();
      return found;
    }
    const double radius = part.polygon.radius_about(centre);
    const double bound_of_part =
        std::min(nearest.distance + radius, bound_by(nearest.face, part.polygon));
    // Parts of the size of rounding errors cannot be told from their centre.
    if (bound_of_part <= threshold() || radius <= kRounding * size_) {
      found.upper = std::max(found.upper, bound_of_part);
      continue;
    }
    const auto add = [&](const ConvexPolygon& polygon) {
      if (!polygon.empty()) parts.push_back({polygon, centre, nearest.distance});
    };
    if (part.polygon.crowded() || !cut_off(part.polygon, nearest.face, add)) {
      const auto [first, second] = part.polygon.halves();
      add(first);
      add(second);
    }
  }
  // Every point of the triangle is in one of the parts, so no bound is below what was found.
  found.upper = std::max(found.upper, found.lower);
  return found;
}

// Cuts the polygon by the planes through the sides of the face; add(polygon) for each part.
// Whether there was anything to cut off.
template <class Add>
bool FaceDistance::cut_off(const ConvexPolygon& polygon, std::uint32_t face, const Add& add) const {
  const Triangle& t = surface_.triangles[face];
  const Point3& a = surface_.points[t[0]];
  const Point3 normal = cross(surface_.points[t[1]] - a, surface_.points[t[2]] - a);
  ConvexPolygon rest = polygon;
  bool cut = false;
  for (int k = 0; k < 3 && !rest.empty(); ++k) {
    const Point3& p = surface_.points[t[k]];
    const Point3 outward = cross(surface_.points[t[(k + 1) % 3]] - p, normal);
    const double length = norm(outward);
    if (!(length > 0)) continue;
    std::array<double, ConvexPolygon::kRoom> height{};
    double highest = 0;
    double lowest = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      height[i] = dot(rest[i] - p, outward) / length;
      highest = std::max(highest, height[i]);
      lowest = std::min(lowest, height[i]);
    }
    if (highest <= kRounding * size_ || lowest >= -kRounding * size_) continue;
    const auto [inside, outside] = rest.cut(height);
    if (inside.empty() || outside.empty()) continue;
    add(outside);
    rest = inside;
    cut = true;
  }
  if (cut) add(rest);
  return cut;
}

}  // namespace cellocut
