// A balanced binary tree of axis-aligned boxes, split at the median centre along the longest axis.
//
// The tree is complete: all leaves lie at one depth and hold up to eight boxes each, so that nodes
// are numbered as in a heap (root 1, children 2i and 2i + 1) and need no pointers. It depends on
// the boxes alone, not on the number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace cellocut {

// Closed box in single precision.
struct FloatBox {
  std::array<float, 3> low;
  std::array<float, 3> high;

  static FloatBox none() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  }
  void include(const FloatBox& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], other.low[axis]);
      high[axis] = std::max(high[axis], other.high[axis]);
    }
  }
  [[nodiscard]] float longest_edge() const {
    return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  }
};

// No short circuit: six comparisons cost less than one branch that is guessed wrong.
inline bool overlap(const FloatBox& a, const FloatBox& b) {
  return ((a.low[0] <= b.high[0]) & (b.low[0] <= a.high[0]) & (a.low[1] <= b.high[1]) &
          (b.low[1] <= a.high[1]) & (a.low[2] <= b.high[2]) & (b.low[2] <= a.high[2])) != 0;
}

class BoxTree {
 public:
  // The boxes `boxes[id]` of the given ids. O(n log n), parallel. Precondition: ids is not empty.
  BoxTree(const std::vector<std::uint32_t>& ids, const std::vector<FloatBox>& boxes);

  [[nodiscard]] std::size_t leaf_count() const { return std::size_t{1} << depth_; }

  [[nodiscard]] std::uint32_t first_of_leaf(std::size_t leaf) const { return ids_[begin_of(leaf)]; }

  // Calls visit(id, id) once for each pair of overlapping boxes of which one is in `leaf` and the
  // other is in the same or a later leaf; over all leaves that is each overlapping pair once.
  template <class Visit>
  void visit_pairs_of_leaf(std::size_t leaf, const Visit& visit) const {
    const std::size_t node = leaf_count() + leaf;
    const std::size_t end = begin_of(leaf + 1);
    for (std::size_t i = begin_of(leaf); i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j) {
        if (overlap(boxes_[i], boxes_[j])) visit(ids_[i], ids_[j]);
      }
    }
    const FloatBox& box = nodes_[node];
    descend(
        [&](std::size_t other, unsigned level) {
          const std::size_t past_last_leaf = (other + 1) << (depth_ - level);
          return past_last_leaf > node + 1 && overlap(nodes_[other], box);
        },
        [&](std::size_t other) {
          if (other <= leaf) return;
          const std::size_t other_end = begin_of(other + 1);
          for (std::size_t i = begin_of(leaf); i < end; ++i) {
            if (!overlap(boxes_[i], nodes_[leaf_count() + other])) continue;
            for (std::size_t j = begin_of(other); j < other_end; ++j) {
              if (overlap(boxes_[i], boxes_[j])) visit(ids_[i], ids_[j]);
            }
          }
        });
  }

  // Calls visit(id) for each box for which `wanted(box)` holds; `wanted` must hold for a box that
  // contains one for which it holds.
  template <class Wanted, class Visit>
  void visit_boxes(const Wanted& wanted, const Visit& visit) const {
    descend([&](std::size_t node, unsigned) { return wanted(nodes_[node]); },
            [&](std::size_t leaf) {
              for (std::size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i) {
                if (wanted(boxes_[i])) visit(ids_[i]);
              }
            });
  }

 private:
  struct Item;
  void build(std::size_t node, unsigned level, std::vector<Item>& items,
             const std::vector<FloatBox>& boxes);

  [[nodiscard]] std::size_t begin_of(std::size_t leaf) const {
    return ids_.size() * leaf >> depth_;
  }

  // Depth first from the root through the nodes for which enter(node, level) holds; at_leaf(leaf).
  template <class Enter, class AtLeaf>
  void descend(const Enter& enter, const AtLeaf& at_leaf) const {
    std::size_t node = 1;
    unsigned level = 0;
    for (;;) {
      if (enter(node, level)) {
        if (level < depth_) {
          node *= 2;
          ++level;
          continue;
        }
        at_leaf(node - leaf_count());
      }
      while ((node & 1U) != 0) {  // a right child is done: so is its parent
        if (node == 1) return;
        node /= 2;
        --level;
      }
      ++node;
    }
  }

  unsigned depth_ = 0;
  std::vector<std::uint32_t> ids_;  // in the order of the leaves
  std::vector<FloatBox> boxes_;     // in the order of the leaves
  std::vector<FloatBox> nodes_;     // as a heap, from 1
};

}  // namespace cellocut
