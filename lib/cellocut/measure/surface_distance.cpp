#include "cellocut/measure/surface_distance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <vector>

#include "cellocut/measure/convex_polygon.h"
#include "cellocut/measure/nearest_triangle.h"

namespace cellocut {

namespace {

constexpr double kSmallest = 1e-9;   // of the box: distances below are as good as none
constexpr double kRounding = 1e-13;  // of the box: parts beyond a plane by less are not cut off

// From one surface to the other.
class Direction {
 public:
  Direction(const TriangleSoup& from, const TriangleSoup& to, double size, double tolerance,
            Observer& observer)
      : from_(from),
        to_(to),
        nearest_(to),
        size_(size),
        tolerance_(tolerance),
        observer_(observer) {}

  // Distances at the points that faces use: the largest is a lower bound.
  double measure_points() {
    std::vector<std::uint8_t> used(from_.points.size(), 0);
    for (const Triangle& t : from_.triangles) {
      for (const std::uint32_t v : t) used[v] = 1;
    }
    face_.assign(used.size(), 0);
    std::vector<double> distance(used.size(), 0.0);
    each(used.size(), [&](std::size_t i) {
      if (used[i] == 0) return;
      const NearestPoint nearest = nearest_(from_.points[i]);
      face_[i] = nearest.face;
      distance[i] = nearest.distance;
    });
    return *std::max_element(distance.begin(), distance.end());
  }

  // `lower` is known of either direction.
  DirectedDistance measure_faces(double lower) {
    std::vector<DirectedDistance> of_face(from_.triangles.size());
    each(of_face.size(), [&](std::size_t f) { of_face[f] = measure_face(f, lower); });
    DirectedDistance all;
    for (const DirectedDistance& distance : of_face) {
      all.lower = std::max(all.lower, distance.lower);
      all.upper = std::max(all.upper, distance.upper);
    }
    return all;
  }

 private:
  struct Part {
    ConvexPolygon polygon;
    Point3 seen;      // a point
    double distance;  // and that from it to the other surface, at most
  };

  template <class Visit>
  void each(std::size_t count, const Visit& visit) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 256),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        observer_.check();
                        for (std::size_t i = range.begin(); i != range.end(); ++i) visit(i);
                      });
  }

  [[nodiscard]] double distance_to(std::uint32_t face, const Point3& p) const {
    const Triangle& t = to_.triangles[face];
    return norm(p - nearest_on_triangle(p, to_.points[t[0]], to_.points[t[1]], to_.points[t[2]]));
  }

  [[nodiscard]] double bound_by(std::uint32_t face, const ConvexPolygon& polygon) const {
    double bound = 0;
    for (const Point3& p : polygon) bound = std::max(bound, distance_to(face, p));
    return bound;
  }

  // The threshold of a face is what `lower` and its own finds make it, so that no result depends on
  // the order in which faces are measured.
  [[nodiscard]] DirectedDistance measure_face(std::size_t f, double lower) const {
    const Triangle& t = from_.triangles[f];
    DirectedDistance found;
    for (const std::uint32_t v : t) {
      found.lower = std::max(found.lower, distance_to(face_[v], from_.points[v]));
    }
    const auto threshold = [&] {
      return std::max((1 + tolerance_) * std::max(lower, found.lower), kSmallest * size_);
    };
    ConvexPolygon whole;
    for (const std::uint32_t v : t) whole.add(from_.points[v]);
    double bound = std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : t) bound = std::min(bound, bound_by(face_[v], whole));
    if (bound <= threshold()) {
      found.upper = bound;
      return found;
    }
    std::vector<Part> parts{{whole, whole[0], distance_to(face_[t[0]], whole[0])}};
    while (!parts.empty()) {
      const Part part = parts.back();
      parts.pop_back();
      const Point3 centre = part.polygon.centre();
      const double limit = part.distance + norm(centre - part.seen);
      NearestPoint nearest = nearest_(centre, limit * (1 + 1e-9) + kRounding * size_);
      if (!nearest.found()) nearest = nearest_(centre);
      found.lower = std::max(found.lower, nearest.distance);
      const double by_radius = nearest.distance + part.polygon.radius_about(centre);
      const double bound_of_part = std::min(by_radius, bound_by(nearest.face, part.polygon));
      // Parts of the size of rounding errors cannot be told from their centre.
      if (bound_of_part <= threshold() || by_radius <= nearest.distance + kRounding * size_) {
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
    return found;
  }

  // Cuts the polygon by the planes through the sides of the face; add(polygon) for each part.
  // Whether there was anything to cut off.
  template <class Add>
  bool cut_off(const ConvexPolygon& polygon, std::uint32_t face, const Add& add) const {
    const Triangle& t = to_.triangles[face];
    const Point3& a = to_.points[t[0]];
    const Point3 normal = cross(to_.points[t[1]] - a, to_.points[t[2]] - a);
    ConvexPolygon rest = polygon;
    bool cut = false;
    for (int k = 0; k < 3 && !rest.empty(); ++k) {
      const Point3& p = to_.points[t[k]];
      const Point3 outward = cross(to_.points[t[(k + 1) % 3]] - p, normal);
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

  const TriangleSoup& from_;
  const TriangleSoup& to_;
  NearestTriangle nearest_;
  double size_;
  double tolerance_;
  Observer& observer_;
  std::vector<std::uint32_t> face_;  // nearest to each point
};

}  // namespace

SurfaceDistance measure_surface_distance(const TriangleSoup& first, const TriangleSoup& second,
                                         double tolerance, Observer& observer) {
  if (first.empty() || second.empty()) {
    throw UsageError("there is no distance to a surface without faces");
  }
  if (!(tolerance > 0)) throw UsageError("the tolerance of a distance must be positive");
  const Box3 box = bounding_box(first);
  const Box3 other = bounding_box(second);
  double size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    size = std::max(size, std::max(box.high[axis], other.high[axis]) -
                              std::min(box.low[axis], other.low[axis]));
  }
  Direction forward(first, second, size, tolerance, observer);
  Direction backward(second, first, size, tolerance, observer);
  const double lower = std::max(forward.measure_points(), backward.measure_points());
  SurfaceDistance distance;
  distance.forward = forward.measure_faces(lower);
  distance.backward = backward.measure_faces(lower);
  return distance;
}

}  // namespace cellocut
