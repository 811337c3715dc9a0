// A tree of axis-aligned boxes over the order they come in, where neighbours in it are neighbours
// in space as in an extracted surface, or else over their order along a Morton curve (Lauterbach,
// Garland, Sengupta, Luebke, Manocha, "Fast BVH construction on GPUs", 2009): sorting once is
// cheaper than to split at medians, and what the boxes overlap more is less than that.
//
// Every node has eight children, which one step compares with a box (as in Wald, Benthin, Boulos,
// "Getting rid of packets", 2008). All leaves lie at one depth, so that the children of a node are
// known by its number. The tree depends on the boxes alone, not on the number of threads.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "cellocut/base/lanes.h"

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

// Four comparisons at once, and no branch.
inline bool overlap(const FloatBox& a, const FloatBox& b) {
  return bits_of((four_at(a.low.data()) <= four_at(b.high.data())) &
                 (four_at(b.low.data()) <= four_at(a.high.data()))) == 0xFU;
}

// The boxes of the children of a node, coordinate by coordinate.
class EightBoxes {
 public:
  static constexpr std::size_t kSize = 8;

  void set(std::size_t i, const FloatBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_[i / 4][axis][i % 4] = box.low[axis];
      high_[i / 4][axis][i % 4] = box.high[axis];
    }
  }
  [[nodiscard]] FloatBox operator[](std::size_t i) const {
    const auto& low = low_[i / 4];
    const auto& high = high_[i / 4];
    return {{low[0][i % 4], low[1][i % 4], low[2][i % 4], 0},
            {high[0][i % 4], high[1][i % 4], high[2][i % 4], 0}};
  }

  [[nodiscard]] FloatBox around() const {
    FloatBox box = FloatBox::none();
    for (std::size_t i = 0; i < kSize; ++i) box.include((*this)[i]);
    return box;
  }

  // Bit i is set where box i overlaps the given one.
  [[nodiscard]] unsigned overlapping(const FloatBox& box) const {
    return four_overlap(box, 0) | four_overlap(box, 1) << 4U;
  }
  // Calls visit(i) for each box from `first` on that overlaps the given one, in order.
  template <class Visit>
  void overlapping(const FloatBox& box, std::size_t first, const Visit& visit) const {
    unsigned mask = overlapping(box) >> first << first;
    for (; mask != 0; mask &= mask - 1) visit(static_cast<std::size_t>(std::countr_zero(mask)));
  }

 private:
  // By bits, which of the four boxes of a half overlap the given one.
  [[nodiscard]] unsigned four_overlap(const FloatBox& box, std::size_t half) const {
    return bits_of((low_[half][0] <= box.high[0]) & (high_[half][0] >= box.low[0]) &
                   (low_[half][1] <= box.high[1]) & (high_[half][1] >= box.low[1]) &
                   (low_[half][2] <= box.high[2]) & (high_[half][2] >= box.low[2]));
  }

  std::array<std::array<FloatLanes, 3>, 2> low_;  // by half and axis
  std::array<std::array<FloatLanes, 3>, 2> high_;
};

class BoxTree {
 public:
  // The boxes of the given ids, in the coordinates of a FloatFrame (float_frame.h) around them.
  // O(n), or O(n log n) where they have to be sorted; parallel. Preconditions: ids is not empty;
  // box_of may be called at once from several threads.
  BoxTree(std::vector<std::uint32_t> ids, const std::function<FloatBox(std::uint32_t)>& box_of);
  // Of all ids below `count`.
  BoxTree(std::size_t count, const std::function<FloatBox(std::uint32_t)>& box_of);

  [[nodiscard]] std::size_t leaf_count() const { return levels_[0].size; }

  [[nodiscard]] std::span<const std::uint32_t> ids_of_leaf(std::size_t leaf) const {
    const std::size_t begin = kSize * leaf;
    return {ids_.data() + begin, std::min(kSize, ids_.size() - begin)};
  }

  // All ids in the order of the leaves: `ids()[place]`.
  [[nodiscard]] std::span<const std::uint32_t> ids() const { return ids_; }

  // The box at a place of ids().
  [[nodiscard]] FloatBox box(std::size_t place) const {
    return levels_[0][place / kSize][place % kSize];
  }

  // Gives the box at a place of ids() another extent (FloatBox::none(): nothing finds it any more)
  // and bounds the nodes above anew. The tree keeps its order, so it gets worse as boxes move away.
  // O(log n); not while another thread visits.
  void replace(std::size_t place, const FloatBox& box);

  // Calls visit(places, id) for boxes in `leaf` and in later leaves that overlap some in `leaf`:
  // bit i of `places` is set where they overlap the one at place i of it. Over all leaves that is
  // each overlapping pair once.
  template <class Visit>
  void visit_pairs_of_leaf(std::size_t leaf, const Visit& visit) const {
    const EightBoxes& own = levels_[0][leaf];
    const std::size_t count = ids_of_leaf(leaf).size();
    const auto meet = [&](const FloatBox& box, unsigned among, std::uint32_t id) {
      const unsigned places = own.overlapping(box) & among;
      if (places != 0) visit(places, id);
    };
    for (std::size_t j = 1; j < count; ++j) meet(own[j], (1U << j) - 1, ids_[kSize * leaf + j]);
    // Later leaves lie below the right siblings of the nodes on the way up.
    const FloatBox box = own.around();
    std::size_t node = leaf;
    for (std::size_t level = 1; level < levels_.size(); ++level, node /= kSize) {
      const std::size_t parent = node / kSize;
      levels_[level][parent].overlapping(box, node % kSize + 1, [&](std::size_t child) {
        const std::size_t sibling = kSize * parent + child;
        descend(level - 1, sibling, box, &always, [&](std::size_t other) {
          const EightBoxes& others = levels_[0][other];
          others.overlapping(box, 0,
                             [&](std::size_t j) { meet(others[j], ~0U, ids_[kSize * other + j]); });
        });
      });
    }
  }

  // Calls visit(id) for each box that overlaps the given one.
  template <class Visit>
  void visit_boxes(const FloatBox& box, const Visit& visit) const {
    visit_boxes(box, &always, visit);
  }

  // Calls visit(id) for each box that overlaps the given one and for which `wanted(box)` holds;
  // `wanted` must hold for a box that contains one for which it holds.
  template <class Wanted, class Visit>
  void visit_boxes(const FloatBox& box, const Wanted& wanted, const Visit& visit) const {
    descend(levels_.size() - 1, 0, box, wanted, [&](std::size_t leaf) {
      levels_[0][leaf].overlapping(box, 0, [&](std::size_t i) {
        if (wanted(levels_[0][leaf][i])) visit(ids_[kSize * leaf + i]);
      });
    });
  }

 private:
  static constexpr std::size_t kSize = EightBoxes::kSize;
  static bool always(const FloatBox& /*box*/) { return true; }

  // Depth first to the leaves below a node whose boxes overlap the given one and are wanted.
  template <class Wanted, class AtLeaf>
  void descend(std::size_t level, std::size_t node, const FloatBox& box, const Wanted& wanted,
               const AtLeaf& at_leaf) const {
    if (level == 0) {
      at_leaf(node);
      return;
    }
    const EightBoxes& children = levels_[level][node];
    children.overlapping(box, 0, [&](std::size_t child) {
      if (!wanted(children[child])) return;
      descend(level - 1, kSize * node + child, box, wanted, at_leaf);
    });
  }

  // Nodes whose memory is first written by the threads that fill it.
  struct Level {
    std::size_t size;
    std::unique_ptr<EightBoxes[]> nodes;
    double squared_edges = 0;  // of the longest edge of each box, their sum

    explicit Level(std::size_t count)
        : size(count), nodes(std::make_unique_for_overwrite<EightBoxes[]>(count)) {}
    const EightBoxes& operator[](std::size_t i) const { return nodes[i]; }
    EightBoxes& operator[](std::size_t i) { return nodes[i]; }
  };

  // The level above `below` boxes, of which box_at(place) gives each.
  template <class BoxAt>
  static Level level_above(std::size_t below, const BoxAt& box_at);
  // All levels, over box_at(place) for each place.
  template <class BoxAt>
  void bound(const BoxAt& box_at);

  // Whether the boxes are in an order good enough to search.
  [[nodiscard]] bool is_compact() const;

  std::vector<std::uint32_t> ids_;  // in the order of the leaves
  // Child c of node i on level k: on level 0 the box at place 8 i + c, above it node 8 i + c of
  // level k - 1. The last level is one node.
  std::vector<Level> levels_;
};

}  // namespace cellocut
