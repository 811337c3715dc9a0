#include "cellocut/validity/box_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

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

template <class BoxAt>
BoxTree::Level BoxTree::level_above(std::size_t below, const BoxAt& box_at) {
  Level level((below + kSize - 1) / kSize);
  tbb::parallel_for(std::size_t{0}, level.size, [&](std::size_t node) {
    for (std::size_t i = 0; i < kSize; ++i) {
      const std::size_t place = kSize * node + i;
      level[node].set(i, place < below ? box_at(place) : FloatBox::none());
    }
  });
  return level;
}

BoxTree::BoxTree(const std::vector<std::uint32_t>& ids,
                 const std::function<FloatBox(std::uint32_t)>& box_of)
    : ids_(ids.size()) {
  const std::size_t count = ids.size();
  const auto places = std::make_unique_for_overwrite<Place[]>(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const FloatBox box = box_of(ids[i]);
    std::uint64_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float twice = box.low[axis] + box.high[axis];  // the centre, from -2 to 2
      // (In this order, what is nowhere, as NaN, counts as 0.)
      const float cells = std::min(std::max(0.0F, (twice + 2) * 0x1p19F), 0x1FFFFFp0F);
      code |= spread(static_cast<std::uint64_t>(cells)) << axis;
    }
    places[i] = {code, ids[i]};
  });
  tbb::parallel_sort(places.get(), places.get() + count);

  levels_.push_back(level_above(count, [&](std::size_t place) {
    ids_[place] = places[place].id;
    return box_of(places[place].id);
  }));
  while (levels_.back().size > 1) {
    const Level& below = levels_.back();
    levels_.push_back(
        level_above(below.size, [&below](std::size_t node) { return below[node].around(); }));
  }
}

void BoxTree::replace(std::size_t place, const FloatBox& box) {
  FloatBox bounds = box;
  for (Level& level : levels_) {
    EightBoxes& node = level[place / kSize];
    node.set(place % kSize, bounds);
    bounds = node.around();
    place /= kSize;
  }
}

}  // namespace cellocut
