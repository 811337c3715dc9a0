// A surface in blocks of space, so that each can be simplified by itself, in parallel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cellocut/base/point.h"

namespace cellocut {

// Things in groups, each group in the order of the things.
struct Groups {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  std::vector<std::size_t> first{0};  // of every group, and the end
  std::vector<std::uint32_t> item;    // group after group

  [[nodiscard]] std::size_t count() const { return first.size() - 1; }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t group) const {
    return std::span(item).subspan(first[group], first[group + 1] - first[group]);
  }
};

// Things whose group is kNone are in none. Parallel, O(things + groups).
Groups group(const std::vector<std::uint32_t>& group_of, std::size_t count);

inline constexpr int kBlockEdge = 64;  // units: some 50,000 faces of an iso-surface in a block

// The points of the blocks that have any, numbered in the order of the points.
struct Blocks {
  Groups points;
  std::vector<std::uint32_t> of_point;
  std::vector<std::uint32_t> rank;  // of a point in its block

  [[nodiscard]] std::size_t count() const { return points.count(); }
  // Where the block begins.
  [[nodiscard]] static Point3 corner(const Point3& inside);
};

// Precondition: 0 <= coordinates < 2^20 blocks. O(n).
Blocks make_blocks(const std::vector<Point3>& points);

}  // namespace cellocut
