// The vertex of a surface nearest to a point, for surfaces whose vertices lie a grid step or so
// apart.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cellocut/base/point.h"

namespace cellocut {

class NearestVertex {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  // Points in index coordinates, 0 to 2^20 steps. Keeps a reference. Parallel, O(n log n).
  explicit NearestVertex(const std::vector<Point3>& points);

  // The nearest of the points within two grid steps of p in every axis that is not one of
  // `excluded`, the lowest index among equals; kNone where there is none.
  [[nodiscard]] std::uint32_t operator()(const Point3& p,
                                         std::span<const std::uint32_t> excluded) const;

 private:
  struct Entry {
    std::uint64_t cell;
    std::uint32_t point;
    auto operator<=>(const Entry&) const = default;
  };
  const std::vector<Point3>& points_;
  std::vector<Entry> entries_;  // by grid cell, the last axis fastest
};

}  // namespace cellocut
