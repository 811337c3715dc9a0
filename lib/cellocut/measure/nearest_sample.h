// The nearest of a set of points.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "cellocut/base/point.h"

namespace cellocut {

// Embree's hierarchy finds the candidates, in single precision and with room for its rounding; what
// decides among them is evaluated in doubles on the points as they were given. So the answer has
// the bits of a search through all points, for any number of threads.
class NearestSample {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Result {
    std::uint32_t index = kNone;  // the lowest among those at the same distance
    double distance = std::numeric_limits<double>::infinity();  // in the units of the points
  };

  // Preconditions: finite coordinates, whose squares neither overflow nor underflow; fewer than
  // 2^32 points. Errors: LimitError where Embree is out of memory. Parallel; O(n log n).
  explicit NearestSample(std::vector<Point3> points);
  ~NearestSample();
  NearestSample(NearestSample&&) noexcept;
  NearestSample& operator=(NearestSample&&) noexcept;

  // kNone where there are no points. May be called from any number of threads at once. O(log n) for
  // points on surfaces.
  [[nodiscard]] Result operator()(const Point3& p) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace cellocut
