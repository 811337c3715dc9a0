// Small convex polygons in space, to be cut into parts.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "cellocut/base/point.h"

namespace cellocut {

// The corners in order. Room for those that a triangle gets from a few cuts: see crowded().
class ConvexPolygon {
 public:
  static constexpr std::size_t kRoom = 12;

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ < 3; }
  // Another cut through three planes might not find room.
  [[nodiscard]] bool crowded() const { return size_ + 3 > kRoom; }
  [[nodiscard]] const Point3& operator[](std::size_t i) const { return corner_[i]; }
  [[nodiscard]] const Point3* begin() const { return corner_.data(); }
  [[nodiscard]] const Point3* end() const { return corner_.data() + size_; }
  void add(const Point3& p) { corner_[size_++] = p; }

  // The mean of the corners: a point of the polygon.
  [[nodiscard]] Point3 centre() const {
    Point3 sum{};
    for (const Point3& p : *this) sum = sum + p;
    return (1.0 / static_cast<double>(size_)) * sum;
  }
  // The largest distance of a corner, so of any point, from p.
  [[nodiscard]] double radius_about(const Point3& p) const {
    double squared = 0;
    for (const Point3& q : *this) squared = std::max(squared, squared_norm(q - p));
    return std::sqrt(squared);
  }

  // The parts where `height` is at most 0 and at least 0, for heights at the corners of an affine
  // function. A part without extent is empty.
  [[nodiscard]] std::pair<ConvexPolygon, ConvexPolygon> cut(
      const std::array<double, kRoom>& height) const {
    std::pair<ConvexPolygon, ConvexPolygon> parts;
    for (std::size_t i = 0; i < size_; ++i) {
      const std::size_t j = i + 1 < size_ ? i + 1 : 0;
      if (height[i] <= 0) parts.first.add(corner_[i]);
      if (height[i] >= 0) parts.second.add(corner_[i]);
      if ((height[i] < 0 && height[j] > 0) || (height[i] > 0 && height[j] < 0)) {
        const double t = height[i] / (height[i] - height[j]);
        const Point3 p = corner_[i] + t * (corner_[j] - corner_[i]);
        parts.first.add(p);
        parts.second.add(p);
      }
    }
    return parts;
  }

  // Two parts: by a diagonal where there are more than four corners, else by the line from the
  // middle of the longest side to what lies opposite.
  [[nodiscard]] std::pair<ConvexPolygon, ConvexPolygon> halves() const {
    std::pair<ConvexPolygon, ConvexPolygon> parts;
    if (size_ > 4) {
      const std::size_t half = size_ / 2;
      for (std::size_t i = 0; i <= half; ++i) parts.first.add(corner_[i]);
      for (std::size_t i = half; i < size_; ++i) parts.second.add(corner_[i]);
      parts.second.add(corner_[0]);
      return parts;
    }
    std::size_t longest = 0;
    double length = -1;
    for (std::size_t i = 0; i < size_; ++i) {
      const double squared = squared_norm(corner_[(i + 1) % size_] - corner_[i]);
      if (squared > length) {
        length = squared;
        longest = i;
      }
    }
    const auto at = [&](std::size_t i) { return corner_[(longest + i) % size_]; };
    const Point3 middle = 0.5 * (at(0) + at(1));
    const Point3 opposite = size_ == 3 ? at(2) : 0.5 * (at(2) + at(3));
    for (const Point3& p : {at(0), middle, opposite}) parts.first.add(p);
    if (size_ == 4) parts.first.add(at(3));
    for (const Point3& p : {middle, at(1), at(2)}) parts.second.add(p);
    if (size_ == 4) parts.second.add(opposite);
    return parts;
  }

 private:
  std::array<Point3, kRoom> corner_;
  std::size_t size_ = 0;
};

}  // namespace cellocut
