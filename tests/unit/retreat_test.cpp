// Vertices move as far as the surface stays valid, and no further.
#include "cellocut/surface/retreat.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "cellocut/validity/incidence.h"
#include "cellocut/validity/surface_report.h"
#include "hand_made_field.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut::testing {
namespace {

Buckets corners_of(const TriangleSoup& soup) {
  return corners_by_point(soup.triangles, soup.points.size());
}

Retreat move(const TriangleSoup& soup, const std::vector<Point3>& to) {
  return move_vertices(soup.points, to, to, soup.triangles, corners_of(soup), silent_observer());
}

void expect_valid(const TriangleSoup& soup, const Retreat& moved) {
  const SurfaceReport report = inspect_surface({moved.points, soup.triangles});
  EXPECT_EQ(report.intersecting_pairs, 0);
  EXPECT_EQ(report.degenerate_faces, 0);
  EXPECT_TRUE(report.valid());
}

TEST(Retreat, WhatMeetsNothingArrives) {
  const TriangleSoup soup = test::icosphere(3);
  const std::vector<Point3> to = test::translated(test::scaled(soup, 3), {5, 0, 0}).points;
  const Retreat moved = move(soup, to);
  EXPECT_EQ(moved.points, to);
  EXPECT_EQ(moved.rounds, 0);
  EXPECT_EQ(moved.bad_faces_at_first, 0);
}

TEST(Retreat, WhatWouldBecomeAPointStopsHalfWay) {
  const TriangleSoup soup = test::icosphere(2);
  const Retreat moved = move(soup, std::vector<Point3>(soup.points.size(), Point3{0, 0, 0}));
  expect_valid(soup, moved);
  for (std::size_t v = 0; v < soup.points.size(); ++v) {
    EXPECT_EQ(moved.halvings[v], 1);
    EXPECT_EQ(moved.points[v], soup.points[v] + 0.5 * (Point3{0, 0, 0} - soup.points[v]));
  }
}

TEST(Retreat, StopsAtFloatsWhereAFileKeepsThose) {
  TriangleSoup soup = test::translated(test::icosphere(2), {1000, 0, 0});
  for (Point3& p : soup.points) p = kept(p, Coordinates::floats);
  const std::vector<Point3> centre(soup.points.size(), Point3{1000, 0, 0});
  const Retreat moved = move_vertices(soup.points, centre, centre, soup.triangles, corners_of(soup),
                                      silent_observer(), Coordinates::floats);
  expect_valid(soup, moved);
  std::size_t rounded = 0;
  for (std::size_t v = 0; v < soup.points.size(); ++v) {
    EXPECT_EQ(moved.points[v], kept(moved.points[v], Coordinates::floats));
    if (moved.points[v] != soup.points[v] + 0.5 * (centre[v] - soup.points[v])) ++rounded;
  }
  EXPECT_GT(rounded, soup.points.size() / 4);  // where half the way is no float
}

TEST(Retreat, TwoSpheresThatWouldCrossStopBeforeThat) {
  TriangleSoup soup = test::icosphere(3);
  const std::size_t first = soup.points.size();
  test::append(soup, test::icosphere(3, 1, {2.5, 0, 0}));
  std::vector<Point3> to = soup.points;
  for (std::size_t v = 0; v < first; ++v) to[v][0] += 1;  // 0.5 into the other one
  const Retreat moved = move(soup, to);
  expect_valid(soup, moved);
  EXPECT_GT(moved.bad_faces_at_first, 0);
  EXPECT_GT(moved.rounds, 0);
  for (std::size_t v = 0; v < soup.points.size(); ++v) {
    if (v >= first) {
      EXPECT_EQ(moved.points[v], soup.points[v]) << "nothing was asked of the second sphere";
    } else if (soup.points[v][0] < -0.5) {
      EXPECT_EQ(moved.points[v], to[v]) << "the far side is in nobody's way";
    }
  }
}

// A plate just above another, one vertex of which is to go through it by far more than 64 times
// their distance.
TEST(Retreat, WhatSixHalvingsDoNotCureGoesBackWithItsNeighbours) {
  TriangleSoup soup = test::box({0, 0, 0}, {4, 4, 1});
  const auto below = static_cast<std::uint32_t>(soup.points.size());
  test::append(soup, test::box({1, 1, -1}, {2, 2, -1e-4}));
  std::vector<Point3> to = soup.points;
  std::size_t raised = 0;  // the top corner of the lower box nearest to (1, 1)
  for (std::size_t v = below; v < soup.points.size(); ++v) {
    if (soup.points[v] == Point3{1, 1, -1e-4}) raised = v;
  }
  ASSERT_NE(raised, 0U);
  to[raised][2] += 0.5;
  const Retreat moved = move(soup, to);
  expect_valid(soup, moved);
  EXPECT_EQ(moved.points, soup.points);
  EXPECT_EQ(moved.halvings[raised], Retreat::kStayed);
  EXPECT_EQ(moved.rounds, Retreat::kMostHalvings + 1);
}

TEST(Retreat, AnyDisplacementEndsValidAndTheSameForAnyNumberOfThreads) {
  const TriangleSoup soup = test::icosphere(3);
  for (const double size : {0.02, 0.2, 1.0}) {
    std::mt19937_64 random(11);
    std::vector<Point3> to = soup.points;
    for (Point3& p : to) {
      for (double& x : p) x += uniform(random, -size, size);
    }
    std::vector<Retreat> results;
    for (const std::size_t threads : {1, 2, 4}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      results.push_back(move(soup, to));
    }
    expect_valid(soup, results[0]);
    EXPECT_EQ(results[1].points, results[0].points);
    EXPECT_EQ(results[2].points, results[0].points);
    EXPECT_EQ(results[2].halvings, results[0].halvings);
  }
}

TEST(Retreat, WhatCannotGoBeyondArrivesAllTheSame) {
  TriangleSoup soup = test::icosphere(3);
  const std::size_t first = soup.points.size();
  test::append(soup, test::icosphere(3, 1, {2.5, 0, 0}));
  std::vector<Point3> to = soup.points;
  std::vector<Point3> beyond = to;
  for (std::size_t v = 0; v < first; ++v) {
    to[v][0] += 0.25;
    beyond[v][0] += 1;  // 0.5 into the other one
  }
  const Retreat moved =
      move_vertices(soup.points, to, beyond, soup.triangles, corners_of(soup), silent_observer());
  expect_valid(soup, moved);
  for (std::size_t v = 0; v < first; ++v) {
    EXPECT_EQ(moved.halvings[v], 0);
    EXPECT_EQ(moved.points[v], moved.fell_short[v] == 0 ? beyond[v] : to[v]);
    if (soup.points[v][0] > 0.7) {
      EXPECT_EQ(moved.fell_short[v], 1) << "in the way of the other";
    } else if (soup.points[v][0] < -0.5) {
      EXPECT_EQ(moved.fell_short[v], 0) << "in nobody's way";
    }
  }
}

TEST(Retreat, StopsWhenAskedTo) {
  class Stop : public Observer {
    [[nodiscard]] bool cancelled() const override { return true; }
  };
  Stop stop;
  const TriangleSoup soup = test::icosphere(2);
  const std::vector<Point3> centre(soup.points.size(), Point3{0, 0, 0});
  EXPECT_THROW(move_vertices(soup.points, centre, centre, soup.triangles, corners_of(soup), stop),
               Cancelled);
}

}  // namespace
}  // namespace cellocut::testing
