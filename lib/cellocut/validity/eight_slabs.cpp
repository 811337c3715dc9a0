#include "cellocut/validity/eight_slabs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cellocut {

namespace {

using FloatPoint = std::array<float, 3>;

FloatPoint about(const Point3& p, const Point3& origin) {
  const Point3 from_origin = p - origin;
  return {static_cast<float>(from_origin[0]), static_cast<float>(from_origin[1]),
          static_cast<float>(from_origin[2])};
}

float size_of(const FloatPoint& p) {
  return std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
}

// Components of at most 1; zero where there is no such direction, or none that can be told.
FloatPoint direction_of(const Point3& normal) {
  const double size = std::max({std::fabs(normal[0]), std::fabs(normal[1]), std::fabs(normal[2])});
  if (!(size >= std::numeric_limits<double>::min()) || !std::isfinite(size)) return {};
  return about((1 / size) * normal, {});
}

template <class Scalar, class Coordinate>
Scalar height(const std::array<Scalar, 3>& normal, const std::array<Coordinate, 3>& p) {
  return normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2];
}

// Beyond this, products are not certain to be finite.
constexpr float kLargest = 1e30F;
// Heights are sums of three products of a component of at most 1 and a coordinate of at most
// `size`, rounded to 2^-24 of itself: below 13 * 2^-24 size they are off, and so are the two that a
// comparison is between. Twice that is asked for. (What may underflow adds less than the last
// term.)
float room_for_rounding(float size) { return 0x1p-18F * size + 1e-36F; }

}  // namespace

EightSlabs::EightSlabs(const std::vector<Point3>& points, const std::vector<Triangle>& triangles,
                       std::span<const std::uint32_t> ids)
    : origin_(points[triangles[ids[0]][0]]), half_{} {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Triangle& t = triangles[ids[i]];
    const Point3& a = points[t[0]];
    const FloatPoint normal = direction_of(cross(points[t[1]] - a, points[t[2]] - a));
    std::array<float, 3> heights;
    for (std::size_t k = 0; k < 3; ++k) {
      const FloatPoint corner = about(points[t[k]], origin_);
      size_ = std::max(size_, size_of(corner));
      heights[k] = height(normal, corner);
    }
    Four& half = half_[i / 4];
    for (std::size_t k = 0; k < 3; ++k) half.normal[k][i % 4] = normal[k];
    half.low[i % 4] = std::min({heights[0], heights[1], heights[2]});
    half.high[i % 4] = std::max({heights[0], heights[1], heights[2]});
  }
}

unsigned EightSlabs::certainly_beyond(const Point3& a, const Point3& b, const Point3& c) const {
  const std::array<FloatPoint, 3> corner{about(a, origin_), about(b, origin_), about(c, origin_)};
  const float size = std::max({size_, size_of(corner[0]), size_of(corner[1]), size_of(corner[2])});
  if (!(size < kLargest)) return 0;
  const float room = room_for_rounding(size);
  std::array<unsigned, 2> beyond;
  for (std::size_t h = 0; h < 2; ++h) {
    const Four& half = half_[h];
    const FloatLanes above = half.high + room;
    const FloatLanes below = half.low - room;
    IntLanes all_above{-1, -1, -1, -1};
    IntLanes all_below = all_above;
    for (const FloatPoint& p : corner) {
      const FloatLanes at = height(half.normal, p);
      all_above &= at > above;
      all_below &= at < below;
    }
    beyond[h] = bits_of(all_above | all_below);
  }
  return beyond[0] | beyond[1] << 4U;
}

}  // namespace cellocut
