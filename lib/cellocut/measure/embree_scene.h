// Embree's hierarchy of boxes around things of our own, for nearest-point queries. Internal to the
// searches of this folder.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cellocut/base/point.h"

namespace cellocut {

// Single precision in the hierarchy: relative to the coordinates, a few units in the last place.
constexpr double kEmbreeRounding = 1e-6;

// A frame for single precision: the box lies in [-1/2, 1/2]^3.
struct EmbreeFrame {
  Point3 centre{};
  double unit = 1;

  EmbreeFrame() = default;
  explicit EmbreeFrame(const Box3& box)
      : centre(0.5 * (box.low + box.high)),
        unit(box.longest_edge() > 0 ? box.longest_edge() : 1.0) {}
  [[nodiscard]] Point3 operator()(const Point3& p) const {
    return {(p[0] - centre[0]) / unit, (p[1] - centre[1]) / unit, (p[2] - centre[2]) / unit};
  }
};

// What the rounding of a query point adds to distances, in the frame.
inline double embree_slack(const Point3& p) {
  return kEmbreeRounding * std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2]), 1.0});
}

// The bounds of a thing within `box` (of the frame), with room for rounding.
inline void set_embree_bounds(RTCBounds& bounds, const Box3& box, double margin = kEmbreeRounding) {
  bounds.lower_x = static_cast<float>(box.low[0] - margin);
  bounds.lower_y = static_cast<float>(box.low[1] - margin);
  bounds.lower_z = static_cast<float>(box.low[2] - margin);
  bounds.upper_x = static_cast<float>(box.high[0] + margin);
  bounds.upper_y = static_cast<float>(box.high[1] + margin);
  bounds.upper_z = static_cast<float>(box.high[2] + margin);
}

class EmbreeScene {
 public:
  using Bounds = void (*)(const RTCBoundsFunctionArguments*);
  using Visit = bool (*)(RTCPointQueryFunctionArguments*);

  EmbreeScene() = default;  // of nothing: no query visits anything
  ~EmbreeScene() { release(); }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  // Builds the hierarchy over `count` things, 1 to 2^32 - 1. `bounds` finds `data` in its
  // geometryUserPtr; `visit` finds what query() is given in its userPtr. Once. Parallel.
  // Errors: LimitError where memory is short.
  void build(std::size_t count, void* data, Bounds bounds, Visit visit);
  // Visits what may lie within `radius` of p (both in the frame); a visit may lower the radius and
  // then returns true. From any number of threads at once.
  void query(const Point3& p, float radius, void* data) const;

 private:
  void release();
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace cellocut
