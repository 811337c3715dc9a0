// Which components a share of the volume drops.
#include "cellocut/surface/components.h"

#include <gtest/gtest.h>

#include <utility>

#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut {
namespace {

// Boxes of volume 8, 1 and 0.125, apart.
TriangleSoup three_boxes() {
  TriangleSoup soup = test::box({0, 0, 0}, {2, 2, 2});
  test::append(soup, test::box({5, 0, 0}, {6, 1, 1}));
  test::append(soup, test::box({8, 0, 0}, {8.5, 0.5, 0.5}));
  return soup;
}

TEST(SmallComponents, AreThoseBelowTheShare) {
  for (const auto& [share, dropped] : {std::pair{0.0, 0}, std::pair{0.01, 0}, std::pair{0.02, 1},
                                       std::pair{0.1, 1}, std::pair{0.2, 2}}) {
    TriangleSoup soup = three_boxes();
    EXPECT_EQ(drop_small_components(soup, share), dropped) << share;
    EXPECT_EQ(soup.triangles.size(), 12U * static_cast<std::size_t>(3 - dropped)) << share;
    EXPECT_EQ(soup.points.size(), 8U * static_cast<std::size_t>(3 - dropped)) << share;
  }
}

TEST(SmallComponents, NeverIsTheLargest) {
  TriangleSoup soup = three_boxes();
  EXPECT_EQ(drop_small_components(soup, 1), 2);
  EXPECT_EQ(soup.triangles.size(), 12U);
  TriangleSoup alike = test::box({0, 0, 0}, {1, 1, 1});
  test::append(alike, test::box({5, 0, 0}, {6, 1, 1}));
  EXPECT_LE(drop_small_components(alike, 0.6), 1);  // by the last bit, if at all
  EXPECT_GE(alike.triangles.size(), 12U);
}

TEST(SmallComponents, CountByVolumeWhicheverWayTheyAreTurned) {
  TriangleSoup soup = three_boxes();
  for (Triangle& t : soup.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(drop_small_components(soup, 0.1), 1);
}

}  // namespace
}  // namespace cellocut
