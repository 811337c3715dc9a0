// A balanced binary tree of axis-aligned boxes over their order along a Morton curve (Lauterbach,
// Garland, Sengupta, Luebke, Manocha, "Fast BVH construction on GPUs", 2009): sorting once is
// cheaper than to split at medians, and what the boxes overlap more is less than that.
//
// The tree is complete: all leaves lie at one depth and hold up to eight boxes each, so that nodes
// are numbered as in a heap (root 1, children 2i and 2i + 1) and need no pointers. It depends on
// the boxes alone, not on the number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

namespace cellocut {

// Closed box in single precision. The fourth lanes are zero: they make a corner one vector.
struct alignas(32) FloatBox {
  std::array<float, 4> low;
  std::array<float, 4> high;

  static FloatBox none() {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    return {{kInfinity, kInfinity, kInfinity, 0}, {-kInfinity, -kInfinity, -kInfinity, 0}};
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

// Four comparisons at once (a vector type of GCC and Clang), and no branch.
inline bool overlap(const FloatBox& a, const FloatBox& b) {
  using Lanes __attribute__((vector_size(4 * sizeof(float)))) = float;
  using Halves __attribute__((vector_size(4 * sizeof(float)))) = long long;
  Lanes a_low;
  Lanes a_high;
  Lanes b_low;
  Lanes b_high;
  std::memcpy(&a_low, a.low.data(), sizeof a_low);
  std::memcpy(&a_high, a.high.data(), sizeof a_high);
  std::memcpy(&b_low, b.low.data(), sizeof b_low);
  std::memcpy(&b_high, b.high.data(), sizeof b_high);
  const auto meet = reinterpret_cast<Halves>((a_low <= b_high) & (b_low <= a_high));
  return (meet[0] & meet[1]) == -1;
}

class BoxTree {
 public:
  // The boxes `boxes[id]` of the given ids. O(n log n), parallel. Precondition: ids is not empty.
  BoxTree(const std::vector<std::uint32_t>& ids, const std::vector<FloatBox>& boxes);

  [[nodiscard]] std::size_t leaf_count() const { return std::size_t{1} << depth_; }

  [[nodiscard]] std::span<const std::uint32_t> ids_of_leaf(std::size_t leaf) const {
    return {ids_.data() + begin_of(leaf), ids_.data() + begin_of(leaf + 1)};
  }

  // All ids in the order of the leaves: `ids()[place]`.
  [[nodiscard]] std::span<const std::uint32_t> ids() const { return ids_; }

  // Gives the box at a place of ids() another extent (FloatBox::none(): nothing finds it any more)
  // and bounds the nodes above anew. The tree keeps its order, so it gets worse as boxes move away.
  // O(log n); not while another thread visits.
  void replace(std::size_t place, const FloatBox& box);

  // Calls visit(place in the leaf, id of the other) once for each pair of overlapping boxes of
  // which one is in `leaf` and the other is in the same or a later leaf; over all leaves that is
  // each overlapping pair once.
  template <class Visit>
  void visit_pairs_of_leaf(std::size_t leaf, const Visit& visit) const {
    const std::size_t node = leaf_count() + leaf;
    const std::size_t begin = begin_of(leaf);
    const std::size_t end = begin_of(leaf + 1);
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j) {
        if (overlap(boxes_[i], boxes_[j])) visit(i - begin, ids_[j]);
      }
    }
    // Later leaves lie below the right siblings of the nodes on the way up.
    const FloatBox& box = nodes_[node];
    for (std::size_t ancestor = node; ancestor > 1; ancestor /= 2) {
      if ((ancestor & 1U) != 0) continue;
      descend(
          ancestor + 1, [&](std::size_t other) { return overlap(nodes_[other], box); },
          [&](std::size_t other) {
            const std::size_t other_end = begin_of(other + 1);
            for (std::size_t i = begin; i < end; ++i) {
              if (!overlap(boxes_[i], nodes_[leaf_count() + other])) continue;
              for (std::size_t j = begin_of(other); j < other_end; ++j) {
                if (overlap(boxes_[i], boxes_[j])) visit(i - begin, ids_[j]);
              }
            }
          });
    }
  }

  // Calls visit(id) for each box for which `wanted(box)` holds; `wanted` must hold for a box that
  // contains one for which it holds.
  template <class Wanted, class Visit>
  void visit_boxes(const Wanted& wanted, const Visit& visit) const {
    descend(
        1, [&](std::size_t node) { return wanted(nodes_[node]); },
        [&](std::size_t leaf) {
          for (std::size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i) {
            if (wanted(boxes_[i])) visit(ids_[i]);
          }
        });
  }

 private:
  void bound(std::size_t node);

  [[nodiscard]] std::size_t begin_of(std::size_t leaf) const {
    return ids_.size() * leaf >> depth_;
  }

  // Depth first below and from `top` through the nodes for which enter(node) holds; at_leaf(leaf).
  template <class Enter, class AtLeaf>
  void descend(std::size_t top, const Enter& enter, const AtLeaf& at_leaf) const {
    std::size_t node = top;
    for (;;) {
      if (enter(node)) {
        if (node < leaf_count()) {
          node *= 2;
          continue;
        }
        at_leaf(node - leaf_count());
      }
      while (node != top && (node & 1U) != 0) node /= 2;  // a right child is done: so is its parent
      if (node == top) return;
      ++node;
    }
  }

  unsigned depth_ = 0;
  std::vector<std::uint32_t> ids_;  // in the order of the leaves
  std::vector<FloatBox> boxes_;     // in the order of the leaves
  std::vector<FloatBox> nodes_;     // as a heap, from 1
};

}  // namespace cellocut
