#include "cellocut/validity/box_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_sort.h>

#include <cmath>

namespace cellocut {

namespace {

constexpr std::size_t kLeafSize = 8;
constexpr std::size_t kParallelSize = 512;  // leaves; one thread bounds smaller subtrees

struct Place {
  std::uint64_t code;  // along the curve
  std::uint32_t id;
  auto operator<=>(const Place&) const = default;
};

// The 21 lowest bits, three places apart.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32U) & 0x001F00000000FFFFU;
  x = (x | x << 16U) & 0x001F0000FF0000FFU;
  x = (x | x << 8U) & 0x100F00F00F00F00FU;
  x = (x | x << 4U) & 0x10C30C30C30C30C3U;
  return (x | x << 2U) & 0x1249249249249249U;
}

}  // namespace

BoxTree::BoxTree(const std::vector<std::uint32_t>& ids, const std::vector<FloatBox>& boxes)
    : ids_(ids.size()), boxes_(ids.size()) {
  while (ids.size() > kLeafSize << depth_) ++depth_;
  nodes_.resize(2 * leaf_count());
  FloatBox all = FloatBox::none();
  for (const std::uint32_t id : ids) all.include(boxes[id]);
  const float cells = std::ldexp(1.0F, 20);  // twice the centre has 21 bits
  const float edge = all.longest_edge();
  const float scale = edge > 0 ? cells / edge : 0;

  std::vector<Place> places(ids.size());
  tbb::parallel_for(std::size_t{0}, ids.size(), [&](std::size_t i) {
    const FloatBox& box = boxes[ids[i]];
    std::uint64_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float twice = (box.low[axis] - all.low[axis]) + (box.high[axis] - all.low[axis]);
      code |= spread(static_cast<std::uint64_t>(std::fmin(twice * scale, 0x1FFFFF))) << axis;
    }
    places[i] = {code, ids[i]};
  });
  tbb::parallel_sort(places.begin(), places.end());
  tbb::parallel_for(std::size_t{0}, ids.size(), [&](std::size_t i) {
    ids_[i] = places[i].id;
    boxes_[i] = boxes[ids_[i]];
  });
  bound(1);
}

// Finds the box of a node and of all below it.
void BoxTree::bound(std::size_t node) {
  FloatBox& box = nodes_[node];
  box = FloatBox::none();
  if (node >= leaf_count()) {
    const std::size_t leaf = node - leaf_count();
    for (std::size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i) box.include(boxes_[i]);
    return;
  }
  const auto left = [&] { bound(2 * node); };
  const auto right = [&] { bound(2 * node + 1); };
  if (node < leaf_count() / kParallelSize) {
    tbb::parallel_invoke(left, right);
  } else {
    left();
    right();
  }
  box.include(nodes_[2 * node]);
  box.include(nodes_[2 * node + 1]);
}

void BoxTree::replace(std::size_t place, const FloatBox& box) {
  boxes_[place] = box;
  // The last leaf that begins at or before the place (see begin_of).
  const std::size_t leaf = (((place + 1) << depth_) - 1) / ids_.size();
  FloatBox bounds = FloatBox::none();
  for (std::size_t i = begin_of(leaf); i < begin_of(leaf + 1); ++i) bounds.include(boxes_[i]);
  for (std::size_t node = leaf_count() + leaf;;) {
    if (nodes_[node].low == bounds.low && nodes_[node].high == bounds.high) return;
    nodes_[node] = bounds;
    if (node == 1) return;
    bounds.include(nodes_[node ^ 1U]);
    node /= 2;
  }
}

}  // namespace cellocut
