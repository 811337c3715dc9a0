#include "cellocut/validity/box_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <cmath>
#include <utility>

namespace cellocut {

namespace {

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
    : ids_(ids.size()) {
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

  levels_.emplace_back((ids.size() + kSize - 1) / kSize);
  tbb::parallel_for(std::size_t{0}, levels_[0].size(), [&](std::size_t leaf) {
    const std::size_t begin = kSize * leaf;
    for (std::size_t i = begin; i < std::min(begin + kSize, ids.size()); ++i) {
      ids_[i] = places[i].id;
      levels_[0][leaf].set(i - begin, boxes[ids_[i]]);
    }
  });
  while (levels_.back().size() > 1) {
    const std::vector<EightBoxes>& below = levels_.back();
    std::vector<EightBoxes> level((below.size() + kSize - 1) / kSize);
    tbb::parallel_for(std::size_t{0}, level.size(), [&](std::size_t node) {
      const std::size_t begin = kSize * node;
      for (std::size_t i = begin; i < std::min(begin + kSize, below.size()); ++i) {
        level[node].set(i - begin, below[i].around());
      }
    });
    levels_.push_back(std::move(level));
  }
}

void BoxTree::replace(std::size_t place, const FloatBox& box) {
  FloatBox bounds = box;
  for (std::vector<EightBoxes>& level : levels_) {
    EightBoxes& node = level[place / kSize];
    node.set(place % kSize, bounds);
    bounds = node.around();
    place /= kSize;
  }
}

}  // namespace cellocut
