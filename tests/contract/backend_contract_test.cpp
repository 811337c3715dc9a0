// What every tetrahedralization backend promises (lib/cellocut/complex/tetrahedralizer.h), over all
// that are built.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "backends/backends.h"
#include "complex_checks.h"

namespace cellocut {
namespace {

using namespace testing_complex;

class BackendContract : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] TetComplex run(const Points& points) const {
    return backend_->tetrahedralize(points);
  }
  std::unique_ptr<Tetrahedralizer> backend_ = backends::make(GetParam());
};

TEST_P(BackendContract, TellsItsNameLicenceAndReference) {
  EXPECT_EQ(backend_->info().name, GetParam());
  EXPECT_FALSE(backend_->info().summary.empty());
  EXPECT_FALSE(backend_->info().licence.empty());
  EXPECT_FALSE(backend_->info().reference.empty());
}

TEST_P(BackendContract, OneTetrahedronWhateverTheOrderOfItsPoints) {
  Points points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::sort(points.begin(), points.end());
  do {
    const TetComplex complex = run(points);
    ASSERT_EQ(complex.cells.size(), 1U);
    expect_delaunay_complex(complex, points);
    EXPECT_DOUBLE_EQ(total_volume(complex), 1.0 / 6);
    EXPECT_THAT(complex.neighbours[0], testing::Each(kOutside));
  } while (std::next_permutation(points.begin(), points.end()));
}

TEST_P(BackendContract, FivePointsAreTwoOrThreeCells) {
  // A bipyramid: its apexes see each other when they are closer than the waist's sphere is wide.
  const Points tall = {{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}, {0, 0, 3}, {0, 0, -3}};
  const Points flat = {{1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}, {0, 0, 0.2}, {0, 0, -0.2}};
  EXPECT_EQ(run(tall).cells.size(), 2U);
  EXPECT_EQ(run(flat).cells.size(), 3U);
}

TEST_P(BackendContract, RandomPointsOfManySizes) {
  unsigned seed = 1;
  for (const std::size_t count : {5U, 6U, 8U, 13U, 40U, 100U, 333U, 1000U, 5000U, 20000U}) {
    const Points points = random_points(count, seed++);
    SCOPED_TRACE(count);
    EXPECT_EQ(expect_delaunay_complex(run(points), points), 0U);
  }
}

TEST_P(BackendContract, SphereOfEveryCellIsEmpty) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Points points = random_points(60, 100 + seed);
    expect_empty_spheres(run(points));
  }
  expect_empty_spheres(run(cube_grid(4)));
  expect_empty_spheres(run(integer_sphere(101)));
}

TEST_P(BackendContract, EveryScaleAndAnOffset) {
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double offset : {0.0, 1e3 * scale}) {
      SCOPED_TRACE(testing::Message() << "scale " << scale << ", offset " << offset);
      const Points points = random_points(500, 7, scale, offset);
      expect_delaunay_complex(run(points), points);
    }
  }
}

TEST_P(BackendContract, PowerOfTwoScaleChangesNothing) {
  const Points points = random_points(2000, 8);
  Points scaled = points;
  for (Point3& p : scaled) p = 0x1p-20 * p;
  EXPECT_EQ(run(points).cells, run(scaled).cells);
}

TEST_P(BackendContract, PointsOnACubeGrid) {
  for (const int per_edge : {2, 3, 6}) {
    const Points points = cube_grid(per_edge);
    const TetComplex complex = run(points);
    EXPECT_GT(expect_delaunay_complex(complex, points), 0U);
    EXPECT_NEAR(total_volume(complex), std::pow(per_edge - 1, 3), 1e-10);
  }
}

TEST_P(BackendContract, PointsOnASphere) {
  const Points points = integer_sphere(2 * 3 * 5 * 7 * 11);
  ASSERT_GT(points.size(), 100U);
  EXPECT_GT(expect_delaunay_complex(run(points), points), 0U);
}

TEST_P(BackendContract, PointsOnTwoSkewLines) {
  Points points;
  for (int i = 0; i < 20; ++i) {
    points.push_back({static_cast<double>(i), 0, 0});
    points.push_back({0, static_cast<double>(i), 1});
  }
  const TetComplex complex = run(points);
  expect_delaunay_complex(complex, points);
  EXPECT_EQ(complex.cells.size(), 19U * 19U);
}

TEST_P(BackendContract, DuplicatesMapToTheirFirstCopy) {
  const Points unique = random_points(200, 9);
  Points points = unique;
  points.insert(points.end(), unique.rbegin(), unique.rend());
  points.insert(points.begin(), unique[100]);
  const TetComplex complex = run(points);
  expect_delaunay_complex(complex, points);
  EXPECT_EQ(complex.first_copy[0], 0U);
  EXPECT_EQ(complex.first_copy[101], 0U);
  EXPECT_EQ(complex.first_copy[1], 1U);
  EXPECT_EQ(complex.first_copy.back(), 1U);
  EXPECT_EQ(complex.cells.size(), run(unique).cells.size());
}

TEST_P(BackendContract, NegativeZeroIsZero) {
  const Points points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-0.0, 0, 0}};
  const TetComplex complex = run(points);
  EXPECT_EQ(complex.first_copy[4], 0U);
  EXPECT_EQ(complex.cells.size(), 1U);
}

TEST_P(BackendContract, PointsCloserThanAnyToleranceSurvive) {
  Points points = random_points(300, 10);
  for (std::size_t i = 0; i < 100; ++i) {
    Point3 next = points[i];
    next[i % 3] = std::nextafter(next[i % 3], 2.0);
    points.push_back(next);
  }
  expect_delaunay_complex(run(points), points);

  Points cluster = random_points(50, 11);
  for (const Point3& p : random_points(300, 12, 1e-13, 0.5)) cluster.push_back(p);
  expect_delaunay_complex(run(cluster), cluster);
}

TEST_P(BackendContract, ThinSetsThatSpanSpaceAreFilled) {
  Points points = cube_grid(5);
  for (Point3& p : points) p[2] *= 1e-12;
  expect_delaunay_complex(run(points), points);

  Points flat_but_one;
  for (const Point3& p : random_points(100, 13)) flat_but_one.push_back({p[0], p[1], 0});
  flat_but_one.push_back({0.5, 0.5, 1e-11});
  expect_delaunay_complex(run(flat_but_one), flat_but_one);
}

// Points on the faces of a cube that is turned by an angle without exact sines: coplanar up to
// rounding, so a determinant in floating point tells nothing about most quadruples.
TEST_P(BackendContract, NearlyCoplanarFaces) {
  Points points;
  const double c = std::cos(0.7);
  const double s = std::sin(0.7);
  for (const Point3& p : cube_grid(8)) {
    const bool on_face = std::any_of(p.begin(), p.end(), [](double x) { return x == 0 || x == 7; });
    if (!on_face) continue;
    const Point3 turned = {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
    points.push_back({turned[0], c * turned[1] - s * turned[2], s * turned[1] + c * turned[2]});
  }
  expect_delaunay_complex(run(points), points);
}

TEST_P(BackendContract, RefusesFewerThanFourDistinctPoints) {
  EXPECT_THROW((void)run({}), InputError);
  EXPECT_THROW((void)run({{0, 0, 0}}), InputError);
  EXPECT_THROW((void)run({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), InputError);
  EXPECT_THROW((void)run({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}, {1, 0, 0}}), InputError);
}

TEST_P(BackendContract, RefusesPointsOnALineOrInAPlane) {
  EXPECT_THROW((void)run({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {7, 7, 7}}), InputError);
  EXPECT_THROW((void)run({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), InputError);
  Points tilted;
  for (const Point3& p : cube_grid(6)) tilted.push_back({p[0], p[1], 3 * p[0] - 2 * p[1] + 5});
  EXPECT_THROW((void)run(tilted), InputError);
}

TEST_P(BackendContract, RefusesCoordinatesThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Points points = random_points(20, 14);
      points[11][axis] = bad;
      EXPECT_THROW((void)run(points), InputError);
    }
  }
}

TEST_P(BackendContract, SameArraysForAnyNumberOfThreads) {
  const Points points = random_points(20000, 15);
  const Points grid = cube_grid(23);
  std::vector<std::pair<TetComplex, TetComplex>> results;
  for (const std::size_t threads : {1U, 2U, 8U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.emplace_back(run(points), run(grid));
  }
  for (const auto& [of_points, of_grid] : results) {
    EXPECT_TRUE(same_arrays(of_points, results[0].first));
    EXPECT_TRUE(same_arrays(of_grid, results[0].second));
  }
}

TEST_P(BackendContract, CallsFromTwoThreadsDoNotDisturbEachOther) {
  const Points small = random_points(300, 16, 1e-6);
  const Points large = random_points(300, 17, 1e6);
  const TetComplex expected_small = run(small);
  const TetComplex expected_large = run(large);
  bool small_is_right = true;
  bool large_is_right = true;
  std::thread other([&] {
    for (int i = 0; i < 20; ++i) small_is_right &= same_arrays(run(small), expected_small);
  });
  for (int i = 0; i < 20; ++i) large_is_right &= same_arrays(run(large), expected_large);
  other.join();
  EXPECT_TRUE(small_is_right);
  EXPECT_TRUE(large_is_right);
}

std::vector<std::string> built_backends() {
  std::vector<std::string> names;
  for (const auto& variant : backends::registered()) {
    if (variant.make != nullptr) names.push_back(variant.name);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, BackendContract, testing::ValuesIn(built_backends()),
                         [](const auto& chosen) { return chosen.param; });

TEST(Backends, AgreeOnPointsInGeneralPosition) {
  const std::vector<std::string> names = built_backends();
  ASSERT_FALSE(names.empty());
  for (const std::size_t count : {10U, 200U, 20000U}) {
    const Points points = random_points(count, 18);
    const TetComplex first = backends::make(names[0])->tetrahedralize(points);
    ASSERT_EQ(expect_locally_delaunay(first), 0U);
    for (const std::string& name : names) {
      EXPECT_TRUE(same_arrays(backends::make(name)->tetrahedralize(points), first)) << name;
    }
  }
}

TEST(Backends, UnknownNameIsAnErrorThatListsWhatIsBuilt) {
  try {
    (void)backends::make("no-such-backend");
    FAIL() << "accepted";
  } catch (const UsageError& error) {
    for (const std::string& name : built_backends()) {
      EXPECT_THAT(error.what(), testing::HasSubstr(name));
    }
  }
}

}  // namespace
}  // namespace cellocut
