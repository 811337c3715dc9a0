// `--lambda-fill auto`: known solids with holes are filled, open sheets are not.
#include "cellocut/path/auto_fill.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "cellocut/base/errors.h"
#include "cellocut/base/predicates.h"
#include "cellocut/complex/point_location.h"
#include "pipeline_runs.h"
#include "support/defective_meshes.h"

namespace cellocut::testing {
namespace {

TEST(SimplestBetween, HasTheSmallestTermsOfAll) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    Lambda a{static_cast<std::int64_t>(random() % 400) + 1,
             static_cast<std::int64_t>(random() % 60) + 1};
    Lambda b{static_cast<std::int64_t>(random() % 400) + 1,
             static_cast<std::int64_t>(random() % 60) + 1};
    if (a == b) continue;
    if (b < a) std::swap(a, b);
    // The first denominator that has a numerator, and the least of these.
    Lambda expected;
    for (std::int64_t q = 1; true; ++q) {
      const std::int64_t p = a.p * q / a.q + 1;
      if (!(Lambda{p, q} < b)) continue;
      expected = {p, q};
      break;
    }
    const Lambda found = simplest_between(a, b);
    EXPECT_EQ(found.p, expected.p);
    EXPECT_EQ(found.q, expected.q);
  }
}

// A path by hand: labellings at 1, 2, 3.5 and 3.5 + a little, to 9.
CellPath hand_made_path() {
  CellPath path;
  path.path.first = {1, 1};
  path.path.last = {9, 1};
  path.path.breakpoints = {{2, 1}, {7, 2}, {7000001, 2000000}};
  path.path.areas.resize(4);
  return path;
}
std::vector<SheetSides> one_sided(const std::vector<double>& areas) {
  std::vector<SheetSides> sides;
  sides.reserve(areas.size());
  for (const double area : areas) sides.push_back({area, 0});
  return sides;
}
std::vector<PathSolid> volumes(const std::vector<double>& values) {
  std::vector<PathSolid> solids;
  solids.reserve(values.size());
  for (const double value : values) solids.push_back({value, 1, 1});
  return solids;
}

TEST(ChooseFill, TakesTheMostOneSidedAndOfEqualsTheLargestLambda) {
  const CellPath path = hand_made_path();
  FillChoice choice = choose_fill(path, one_sided({1, 5, 2, 4}), volumes({9, 8, 7.9, 3}), 1000);
  EXPECT_EQ(to_string(choice.lambda), "3");
  EXPECT_TRUE(choice.chosen.to == (Lambda{7, 2}));
  ASSERT_TRUE(choice.runner_up.has_value());
  EXPECT_EQ(choice.runner_up->volume, 3);
  EXPECT_DOUBLE_EQ(choice.margin(), 0.2);
  choice = choose_fill(path, one_sided({5, 5, 2, 4}), volumes({9, 8, 7, 3}), 1000);
  EXPECT_EQ(choice.chosen.volume, 8);
  EXPECT_EQ(choice.runner_up->volume, 9);
}

TEST(ChooseFill, PassesOverIntervalsWithoutSmallFractions) {
  const CellPath path = hand_made_path();
  FillChoice choice = choose_fill(path, one_sided({1, 2, 9, 3}), volumes({9, 8, 7, 3}), 1 << 20);
  EXPECT_EQ(choice.chosen.volume, 3);
  EXPECT_EQ(choice.runner_up->volume, 8);  // not the one that was passed over
  EXPECT_THROW((void)choose_fill(path, one_sided({1, 2, 9, 3}), volumes({9, 8, 7, 3}), 1),
               LimitError);
}

TEST(ChooseFill, SaysNothingOfAMarginWhereThereIsNone) {
  const CellPath path = hand_made_path();
  FillChoice choice = choose_fill(path, one_sided({0, 0, 0, 0}), volumes({9, 8, 7, 3}), 1000);
  EXPECT_EQ(choice.chosen.volume, 3);
  EXPECT_EQ(choice.margin(), 0);
  choice = choose_fill(path, one_sided({1, 2, 3, 4}), volumes({3.1, 3.05, 3.02, 3}), 1000);
  EXPECT_FALSE(choice.runner_up.has_value());
  EXPECT_EQ(choice.margin(), 0);
}

TEST(PointLocation, FindsACellThatHoldsThePoint) {
  const RemeshResult result =
      pose_cut(test::two_crossing_boxes(), at_resolution(32), *backends::make("cgal"));
  const TetComplex& complex = result.complex;
  const Box3 box = bounding_box(complex.points);
  std::mt19937_64 random(9);
  const auto holds = [&](std::uint32_t c, const Point3& p) {
    std::array<Point3, 4> q;
    for (int k = 0; k < 4; ++k) q[k] = complex.points[complex.cells[c][k]];
    return orientation(p, q[1], q[2], q[3]) >= 0 && orientation(q[0], p, q[2], q[3]) >= 0 &&
           orientation(q[0], q[1], p, q[3]) >= 0 && orientation(q[0], q[1], q[2], p) >= 0;
  };
  int outside = 0;
  for (int n = 0; n < 60; ++n) {
    Point3 p{};
    for (int axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>(random() % 1'000'000) / 1e6;
      p[axis] = box.low[axis] + share * (box.high[axis] - box.low[axis]);
    }
    if (n < 10) p = complex.points[complex.cells[random() % complex.cells.size()][0]];  // a corner
    const auto start = static_cast<std::uint32_t>(random() % complex.cells.size());
    const std::int32_t found = locate_from(complex, p, start);
    if (found != kOutside) {
      EXPECT_TRUE(holds(static_cast<std::uint32_t>(found), p));
      continue;
    }
    ++outside;
    for (std::uint32_t c = 0; c < complex.cells.size(); ++c) EXPECT_FALSE(holds(c, p));
  }
  EXPECT_LT(outside, 50);
}

RemeshResult run_auto(const TriangleSoup& soup) {
  RemeshOptions options = at_resolution(96);
  options.lambda_auto = true;
  RemeshResult result =
      remesh(soup, options, *backends::make("cgal"), *solvers::make("push_relabel"));
  expect_sound(result);
  EXPECT_TRUE(result.fill_choice.has_value());
  const FillChoice& choice = *result.fill_choice;
  const Lambda lambda{choice.lambda.numerator, choice.lambda.denominator};
  EXPECT_TRUE(choice.chosen.from < lambda);
  EXPECT_TRUE(lambda < choice.chosen.to);
  EXPECT_EQ(result.derived.lambda_fill.numerator, choice.lambda.numerator);
  return result;
}

TEST(AutoFill, FillsASphereWithAHole) {
  const RemeshResult result = run_auto(test::sphere_with_hole());
  EXPECT_NEAR(result.surface_report.volume, 4.0 / 3 * std::numbers::pi, 0.15);
  ASSERT_TRUE(result.fill_choice->runner_up.has_value());  // the hollow shell
  EXPECT_LT(result.fill_choice->runner_up->volume, result.fill_choice->chosen.volume / 4);
  EXPECT_GT(result.fill_choice->chosen.sides.one_sided,
            10 * result.fill_choice->runner_up->sides.one_sided);
}

TEST(AutoFill, LeavesABowlOpen) {
  const RemeshResult result = run_auto(test::open_bowl());
  EXPECT_LT(result.surface_report.volume, 0.2);  // filled it would be 2.09
}

TEST(AutoFill, LeavesASheetASheet) {
  const RemeshResult result = run_auto(test::moebius_strip());
  EXPECT_EQ(result.surface_report.euler, 0);
}

TEST(AutoFill, FillsWhatIsClosed) {
  const RemeshResult result = run_auto(test::two_crossing_boxes());
  EXPECT_GT(result.surface_report.volume, 0.9 * (2 * 1.4 * 1.0));
}

TEST(AutoFill, NeedsAnExactSolverAndTheSlab) {
  RemeshOptions options = at_resolution(32);
  options.lambda_auto = true;
  EXPECT_THROW(
      (void)remesh(test::open_bowl(), options, *backends::make("cgal"), *solvers::make("lp")),
      UsageError);
  options.surface = SurfaceMode::sdf;
  options.unary = false;
  EXPECT_THROW(options.validate(), UsageError);
}

}  // namespace
}  // namespace cellocut::testing
