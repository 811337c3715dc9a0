#include "cellocut/measure/surface_distance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cstdint>
#include <vector>

#include "cellocut/measure/face_distance.h"
#include "cellocut/measure/nearest_triangle.h"

namespace cellocut {

namespace {

constexpr double kSmallest = 1e-9;  // of the box: distances below are as good as none

// From one surface to the other.
class Direction {
 public:
  Direction(const TriangleSoup& from, const TriangleSoup& to, double size, double tolerance,
            Observer& observer)
      : from_(from),
        nearest_(to),
        parts_(to, nearest_, size),
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
  template <class Visit>
  void each(std::size_t count, const Visit& visit) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 256),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        observer_.check();
                        for (std::size_t i = range.begin(); i != range.end(); ++i) visit(i);
                      });
  }

  // The threshold of a face is what `lower` and its own finds make it, so that no result depends on
  // the order in which faces are measured.
  [[nodiscard]] DirectedDistance measure_face(std::size_t f, double lower) const {
    const Triangle& t = from_.triangles[f];
    const std::array<Point3, 3> corners{from_.points[t[0]], from_.points[t[1]], from_.points[t[2]]};
    const std::array<std::uint32_t, 3> near{face_[t[0]], face_[t[1]], face_[t[2]]};
    const double enough = std::max((1 + tolerance_) * lower, kSmallest * size_);
    DirectedDistance found =
        parts_.measure(corners, near, {.enough = enough, .tolerance = tolerance_});
    for (int k = 0; k < 3; ++k) {
      found.lower = std::max(found.lower, parts_.distance_to(near[k], corners[k]));
    }
    found.upper = std::max(found.upper, found.lower);
    return found;
  }

  const TriangleSoup& from_;
  NearestTriangle nearest_;
  FaceDistance parts_;
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
  Box3 box = bounding_box(first);
  box.include(bounding_box(second));
  const double size = box.longest_edge();
  // From the middle of both: far from the origin, parts could not become as small as they have to.
  const Point3 middle = 0.5 * box.low + 0.5 * box.high;
  const TriangleSoup one = seen_from(middle, first);
  const TriangleSoup two = seen_from(middle, second);
  Direction forward(one, two, size, tolerance, observer);
  Direction backward(two, one, size, tolerance, observer);
  const double lower = std::max(forward.measure_points(), backward.measure_points());
  SurfaceDistance distance;
  distance.forward = forward.measure_faces(lower);
  distance.backward = backward.measure_faces(lower);
  return distance;
}

}  // namespace cellocut
