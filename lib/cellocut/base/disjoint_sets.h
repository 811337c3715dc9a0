// Sets that only grow together (Tarjan, "Efficiency of a good but not linear set union algorithm",
// J. ACM 22, 1975; with path halving).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace cellocut {

class DisjointSets {
 public:
  // Sets of one member each.
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  // Makes one set of both. Returns whether they were apart.
  bool join(std::uint32_t i, std::uint32_t j) {
    const std::uint32_t a = root(i);
    const std::uint32_t b = root(j);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }
  // The lowest member of the set that holds i.
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace cellocut
