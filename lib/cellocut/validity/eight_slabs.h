// Tells of up to eight faces at once, in single precision, that another face lies beyond the plane
// of each: where a sheet has two sides, most faces whose boxes overlap lie on the other one.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cellocut/base/lanes.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Each face lies in a slab: the points x with n . x between two heights, about its corner of the
// first face. What lies beyond a slab, with room for the rounding, does not meet the face. (Any n
// will do, so how it is rounded does not matter.)
class EightSlabs {
 public:
  // Precondition: one to eight ids; corners are finite.
  EightSlabs(const std::vector<Point3>& points, const std::vector<Triangle>& triangles,
             std::span<const std::uint32_t> ids);

  // Bit i is set only where face i and the triangle are proved to have no point in common; faces
  // that share a corner never are. Faces that are too large for single precision make no proof.
  [[nodiscard]] unsigned certainly_beyond(const Point3& a, const Point3& b, const Point3& c) const;

 private:
  struct Four {
    std::array<FloatLanes, 3> normal;
    FloatLanes low;  // heights of the corners
    FloatLanes high;
  };

  Point3 origin_;
  std::array<Four, 2> half_;
  float size_ = 0;  // the largest coordinate of the faces
};

}  // namespace cellocut
