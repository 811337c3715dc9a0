#include "cellocut/validity/box_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

namespace cellocut {

namespace {
constexpr std::size_t kLeafSize = 8;
constexpr std::size_t kParallelSize = 4096;  // smaller subtrees are built by one thread
}  // namespace

struct BoxTree::Item {
  std::array<float, 3> centre;
  std::uint32_t id;
};

BoxTree::BoxTree(const std::vector<std::uint32_t>& ids, const std::vector<FloatBox>& boxes)
    : ids_(ids), boxes_(ids.size()) {
  while (ids.size() > kLeafSize << depth_) ++depth_;
  nodes_.resize(2 * leaf_count());
  std::vector<Item> items(ids.size());
  tbb::parallel_for(std::size_t{0}, ids.size(), [&](std::size_t i) {
    const FloatBox& box = boxes[ids[i]];
    items[i].id = ids[i];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      items[i].centre[axis] = 0.5F * (box.low[axis] + box.high[axis]);
    }
  });
  build(1, 0, items, boxes);
}

void BoxTree::build(std::size_t node, unsigned level, std::vector<Item>& items,
                    const std::vector<FloatBox>& boxes) {
  const std::size_t first_leaf = (node << (depth_ - level)) - leaf_count();
  const std::size_t leaves = std::size_t{1} << (depth_ - level);
  const std::size_t begin = begin_of(first_leaf);
  const std::size_t end = begin_of(first_leaf + leaves);
  FloatBox& box = nodes_[node];
  box = FloatBox::none();
  if (level == depth_) {
    for (std::size_t i = begin; i < end; ++i) {
      ids_[i] = items[i].id;
      boxes_[i] = boxes[ids_[i]];
      box.include(boxes_[i]);
    }
    return;
  }
  FloatBox centres = FloatBox::none();
  for (std::size_t i = begin; i < end; ++i) {
    centres.include({items[i].centre, items[i].centre});
  }
  std::size_t axis = 0;
  for (std::size_t other = 1; other < 3; ++other) {
    if (centres.high[other] - centres.low[other] > centres.high[axis] - centres.low[axis]) {
      axis = other;
    }
  }
  const std::size_t middle = begin_of(first_leaf + leaves / 2);
  const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [axis](const Item& a, const Item& b) {
    return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.id < b.id;
  });
  const auto left = [&] { build(2 * node, level + 1, items, boxes); };
  const auto right = [&] { build(2 * node + 1, level + 1, items, boxes); };
  if (end - begin > kParallelSize) {
    tbb::parallel_invoke(left, right);
  } else {
    left();
    right();
  }
  box.include(nodes_[2 * node]);
  box.include(nodes_[2 * node + 1]);
}

}  // namespace cellocut
