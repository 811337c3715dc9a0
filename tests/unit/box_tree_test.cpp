// Pairs of overlapping boxes against a look at all pairs, in an order that is kept and in ones that
// are not.
#include "cellocut/validity/box_tree.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>
#include <utility>

namespace cellocut {
namespace {

using Ids = std::vector<std::uint32_t>;
using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

constexpr std::uint32_t kEdge = 40;

// A sheet of kEdge^2 squares that overlap their neighbours; numbered by tiles of 4 by 4.
std::vector<FloatBox> sheet() {
  std::vector<FloatBox> boxes;
  for (std::uint32_t n = 0; n < kEdge * kEdge; ++n) {
    const std::uint32_t tile = n / 16;
    const std::uint32_t column = 4 * (tile / (kEdge / 4)) + n / 4 % 4;
    const std::uint32_t row = 4 * (tile % (kEdge / 4)) + n % 4;
    const float x = static_cast<float>(column) / kEdge - 0.5F;
    const float y = static_cast<float>(row) / kEdge - 0.5F;
    constexpr float kSize = 1.0F / kEdge;
    boxes.push_back({{x, y, 0.1F * x, 0}, {x + kSize, y + kSize, 0.1F * (x + kSize), 0}});
  }
  boxes[77] = FloatBox::none();
  return boxes;
}

Pairs all_pairs(const std::vector<FloatBox>& boxes) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (overlap(boxes[i], boxes[j])) pairs.emplace(i, j);
    }
  }
  return pairs;
}

Pairs pairs_of(const BoxTree& tree) {
  Pairs pairs;
  for (std::size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    tree.visit_pairs_of_leaf(leaf, [&](unsigned places, std::uint32_t other) {
      EXPECT_NE(places, 0U);
      for (std::size_t i = 0; i < 8; ++i) {
        if ((places >> i & 1U) == 0) continue;
        EXPECT_TRUE(pairs.insert(std::minmax(tree.ids_of_leaf(leaf)[i], other)).second);
      }
    });
  }
  return pairs;
}

Ids order_of(const BoxTree& tree) { return {tree.ids().begin(), tree.ids().end()}; }

TEST(BoxTree, KeepsAnOrderOfNeighbours) {
  const std::vector<FloatBox> boxes = sheet();
  const BoxTree tree(boxes.size(), [&](std::uint32_t id) { return boxes[id]; });
  Ids all(boxes.size());
  std::iota(all.begin(), all.end(), 0U);
  EXPECT_EQ(order_of(tree), all);
  EXPECT_EQ(pairs_of(tree), all_pairs(boxes));
  for (std::uint32_t place = 0; place < all.size(); ++place) {
    EXPECT_EQ(tree.box(place).low, boxes[all[place]].low);
  }
}

TEST(BoxTree, SortsWhatIsInNoOrder) {
  const std::vector<FloatBox> boxes = sheet();
  Ids shuffled(boxes.size());
  std::iota(shuffled.begin(), shuffled.end(), 0U);
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937_64(3));
  const BoxTree tree(shuffled, [&](std::uint32_t id) { return boxes[id]; });
  const Ids order = order_of(tree);
  EXPECT_NE(order, shuffled);
  EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), boxes.size());
  EXPECT_EQ(pairs_of(tree), all_pairs(boxes));
  for (std::uint32_t place = 0; place < order.size(); ++place) {
    EXPECT_EQ(tree.box(place).low, boxes[order[place]].low);
  }
  // As good as that of neighbours: few of the leaves meet one box.
  std::size_t leaves = 0;
  for (std::size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    FloatBox around = FloatBox::none();
    const std::size_t members = tree.ids_of_leaf(leaf).size();
    for (std::size_t i = 0; i < members; ++i) around.include(tree.box(8 * leaf + i));
    if (overlap(around, boxes[kEdge * kEdge / 2])) ++leaves;
  }
  EXPECT_LE(leaves, 12U);
}

TEST(BoxTree, OfBoxesThatAreNowhereOrInOnePlace) {
  const BoxTree nowhere(20, [](std::uint32_t) { return FloatBox::none(); });
  EXPECT_TRUE(pairs_of(nowhere).empty());
  const BoxTree points(20, [](std::uint32_t) { return FloatBox{}; });
  EXPECT_EQ(pairs_of(points).size(), 190U);
}

}  // namespace
}  // namespace cellocut
