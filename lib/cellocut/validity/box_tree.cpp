#include "cellocut/validity/box_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <numeric>
#include <utility>

namespace cellocut {

namespace {

struct Place {
  std::uint64_t code;  // along the curve
  std::uint32_t before;
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

// Of the centre of a box in [-1, 1].
std::uint64_t morton_code(const FloatBox& box) {
  std::uint64_t code = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float twice = box.low[axis] + box.high[axis];
    // (In this order, what is nowhere, as NaN, counts as 0.)
    const float cells = std::min(std::max(0.0F, (twice + 2) * 0x1p19F), 0x1FFFFFp0F);
    code |= spread(static_cast<std::uint64_t>(cells)) << axis;
  }
  return code;
}

std::vector<std::uint32_t> numbers_below(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

}  // namespace

template <class BoxAt>
BoxTree::Level BoxTree::level_above(std::size_t below, const BoxAt& box_at) {
  Level level((below + kSize - 1) / kSize);
  // (Summed in fixed parts: the same for any number of threads.)
  level.squared_edges = tbb::parallel_deterministic_reduce(
      tbb::blocked_range<std::size_t>(0, level.size, 1024), 0.0,
      [&](const auto& range, double sum) {
        for (std::size_t node = range.begin(); node < range.end(); ++node) {
          for (std::size_t i = 0; i < kSize; ++i) {
            const std::size_t place = kSize * node + i;
            const FloatBox box = place < below ? box_at(place) : FloatBox::none();
            level[node].set(i, box);
            const double edge = std::max(0.0F, box.longest_edge());
            sum += edge * edge;
          }
        }
        return sum;
      },
      std::plus<>());
  return level;
}

template <class BoxAt>
void BoxTree::bound(const BoxAt& box_at) {
  levels_.clear();
  levels_.push_back(level_above(ids_.size(), box_at));
  while (levels_.back().size > 1) {
    const Level& below = levels_.back();
    levels_.push_back(
        level_above(below.size, [&below](std::size_t node) { return below[node].around(); }));
  }
}

BoxTree::BoxTree(std::vector<std::uint32_t> ids,
                 const std::function<FloatBox(std::uint32_t)>& box_of)
    : ids_(std::move(ids)) {
  bound([&](std::size_t place) { return box_of(ids_[place]); });
  if (is_compact()) return;
  const std::size_t count = ids_.size();
  const Level boxes = std::move(levels_[0]);
  const auto box_before = [&boxes](std::size_t place) {
    return boxes[place / kSize][place % kSize];
  };
  const auto places = std::make_unique_for_overwrite<Place[]>(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    places[i] = {morton_code(box_before(i)), static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(places.get(), places.get() + count);
  const std::vector<std::uint32_t> ids_before = std::move(ids_);
  ids_.resize(count);
  tbb::parallel_for(std::size_t{0}, count,
                    [&](std::size_t i) { ids_[i] = ids_before[places[i].before]; });
  bound([&](std::size_t place) { return box_before(places[place].before); });
}

BoxTree::BoxTree(std::size_t count, const std::function<FloatBox(std::uint32_t)>& box_of)
    : BoxTree(numbers_below(count), box_of) {}

// How many nodes of a level a box of a surface meets grows with the sum of their squared edges. For
// compact patches of like faces that sum is about the same on every level (Morton curve: 1 to 3;
// blocks of a grid, cube by cube: 2.4 to 3.8; meshes in files: 5 to 40, measured on 30).
bool BoxTree::is_compact() const {
  constexpr double kMostOnAverage = 5;
  double above = 0;
  for (std::size_t level = 1; level < levels_.size(); ++level)
    above += levels_[level].squared_edges;
  return above <=
         kMostOnAverage * static_cast<double>(levels_.size() - 1) * levels_[0].squared_edges;
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
