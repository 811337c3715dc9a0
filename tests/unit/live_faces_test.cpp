// The changing box tree against a look at all faces, and the queue against a sorted set.
#include "cellocut/surface/live_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "cellocut/surface/vertex_heap.h"

namespace cellocut {
namespace {

TEST(LiveFaces, FindsWhatALookAtAllFacesFinds) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<Point3> points;
  points.reserve(3000);
  for (int i = 0; i < 3000; ++i) {
    points.push_back({1e3 + coordinate(random), coordinate(random), coordinate(random)});
  }
  // Small faces at first: corners that lie near each other along one axis.
  std::sort(points.begin(), points.end());
  const auto corner = [&] { return static_cast<std::uint32_t>(random() % points.size()); };
  std::vector<Triangle> faces;
  for (std::uint32_t i = 0; i + 2 < points.size(); ++i) faces.push_back({i, i + 1, i + 2});
  LiveFaces live(points, faces);
  std::set<std::uint32_t> left;
  for (std::uint32_t f = 0; f < faces.size(); ++f) left.insert(f);
  std::set<std::uint32_t> hidden;

  // Beyond the point where the tree is built anew.
  while (left.size() > 500) {
    const auto some = std::next(left.begin(), static_cast<std::ptrdiff_t>(random() % left.size()));
    if (random() % 3 == 0) {
      faces[*some] = {corner(), corner(), corner()};
      live.change(*some, faces[*some]);
      hidden.erase(*some);
    } else if (random() % 10 == 0) {
      live.hide(*some);
      hidden.insert(*some);
    } else {
      live.remove(*some);
      left.erase(some);
    }
    if (random() % 10 != 0) continue;
    const FloatBox box = live.box_of({corner(), corner(), corner()});
    std::set<std::uint32_t> expected;
    for (const std::uint32_t f : left) {
      if (hidden.count(f) != 0) continue;
      if (overlap(live.box_of(faces[f]), box)) expected.insert(f);
    }
    std::set<std::uint32_t> found;
    live.find(box, [&](std::uint32_t f) { EXPECT_TRUE(found.insert(f).second); });
    ASSERT_EQ(found, expected);
    ASSERT_EQ(live.count(), left.size());
  }
}

TEST(VertexHeap, GivesOutByKeyThenByVertex) {
  std::mt19937_64 random(13);
  VertexHeap heap(200);
  std::set<std::pair<double, std::uint32_t>> sorted;
  const auto drop = [&](std::uint32_t v) {
    std::erase_if(sorted, [v](const auto& entry) { return entry.second == v; });
  };
  for (int n = 0; n < 20000; ++n) {
    const auto v = static_cast<std::uint32_t>(random() % 200);
    const auto action = random() % 4;
    if (action < 2) {
      const auto key = static_cast<double>(random() % 40);
      heap.set(v, key);
      drop(v);
      sorted.emplace(key, v);
    } else if (action == 2) {
      heap.remove(v);
      drop(v);
    } else if (!heap.empty()) {
      const auto [key, first] = *sorted.begin();
      EXPECT_EQ(heap.least_key(), key);
      EXPECT_EQ(heap.pop(), std::make_pair(first, key));
      sorted.erase(sorted.begin());
    }
    ASSERT_EQ(heap.empty(), sorted.empty());
  }
}

}  // namespace
}  // namespace cellocut
