// A single-layer sheet stays one closed thin solid, whatever its direction: no hole, no ragged rim,
// two tau thick after the pull. And where a solid has concave creases, no bevel of the grid's width
// is left, and nothing slides through a wall.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cellocut/measure/nearest_triangle.h"
#include "pipeline_runs.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut::testing {
namespace {

double area_of(const TriangleSoup& soup) {
  double area = 0;
  for (const Triangle& t : soup.triangles) {
    area += triangle_area(soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]);
  }
  return area;
}

// A square cloth with folds: z = 0.1 sin(5 x) cos(4 y).
TriangleSoup cloth(int cells) {
  TriangleSoup soup;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double x = static_cast<double>(i) / cells;
      const double y = static_cast<double>(j) / cells;
      soup.points.push_back({x, y, 0.1 * std::sin(5 * x) * std::cos(4 * y)});
    }
  }
  const auto at = [cells](int i, int j) { return static_cast<std::uint32_t>(i * (cells + 1) + j); };
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      soup.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      soup.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return soup;
}

struct Sheet {
  std::string name;
  TriangleSoup soup;
  std::int64_t euler;  // of the thin solid's surface
};
std::ostream& operator<<(std::ostream& out, const Sheet& c) { return out << c.name; }

std::vector<Sheet> sheets() {
  std::vector<Sheet> list{{"cloth", cloth(40), 2},
                          {"moebius_strip", test::moebius_strip(), 0},
                          {"half_sphere", test::open_bowl(), 2}};
  std::mt19937_64 random(3);
  const auto coordinate = [&random] {
    return static_cast<double>(random() >> 11U) / 9007199254740992.0 - 0.5;
  };
  for (int n = 0; n < 12; ++n) {
    const Point3 normal{coordinate(), coordinate(), coordinate() + 0.01};
    list.push_back({"plane_" + std::to_string(n), test::tilted_sheet(normal, 1, 1), 2});
  }
  list.push_back({"plane_on_axis", test::tilted_sheet({0, 0, 1}, 1, 4), 2});
  return list;
}

class PulledSheet : public ::testing::TestWithParam<Sheet> {};

TEST_P(PulledSheet, IsOneThinSolidOnTheInput) {
  const TriangleSoup& soup = GetParam().soup;
  const RemeshResult result = run(soup, at_resolution(96, SurfaceMode::union_));
  expect_sound(result);
  const SurfaceReport& report = result.surface_report;
  EXPECT_EQ(report.components.size(), 1U);
  EXPECT_EQ(report.euler, GetParam().euler);

  // Both sides at tau, and no more than a few vertices of a crease further away.
  const double tau = result.derived.pull_distance * result.frame.unit;
  const double step = result.frame.spacing;
  EXPECT_EQ(result.pull.supported, result.pull.vertices);
  EXPECT_DOUBLE_EQ(result.pull.offset.p95, tau);
  EXPECT_LT(result.pull.offset.largest, step);
  EXPECT_LT(static_cast<double>(result.pull.went_back),
            0.001 * static_cast<double>(result.pull.vertices));
  EXPECT_NEAR(report.volume, 2 * tau * area_of(soup), 0.2 * 2 * tau * area_of(soup));

  // Nothing of the sheet is bare, its rim neither.
  const NearestTriangle nearest(result.surface);
  double largest = 0;
  for (const Triangle& t : soup.triangles) {
    const Point3& a = soup.points[t[0]];
    for (int i = 0; i <= 8; ++i) {
      for (int j = 0; i + j <= 8; ++j) {
        const Point3 p =
            a + (i / 8.0) * (soup.points[t[1]] - a) + (j / 8.0) * (soup.points[t[2]] - a);
        largest = std::max(largest, nearest(p).distance);
      }
    }
  }
  EXPECT_LT(largest, 0.5 * step);
}

INSTANTIATE_TEST_SUITE_P(Pipeline, PulledSheet, ::testing::ValuesIn(sheets()),
                         [](const ::testing::TestParamInfo<Sheet>& s) { return s.param.name; });

// Each vertex ends on the side of the input on which it was: with a plane as input, the heights
// keep their signs.
TEST(Pull, KeepsEachSideOnItsOwn) {
  const TriangleSoup soup = test::tilted_sheet({0, 0, 1}, 1, 4);
  RemeshOptions options = at_resolution(64, SurfaceMode::union_);
  options.pull = false;
  const RemeshResult before = run(soup, options);
  options.pull = true;
  const RemeshResult after = run(soup, options);
  ASSERT_EQ(before.surface.points.size(), after.surface.points.size());
  EXPECT_EQ(before.surface.triangles, after.surface.triangles);
  for (std::size_t v = 0; v < after.surface.points.size(); ++v) {
    EXPECT_EQ(before.surface.points[v][2] > 0, after.surface.points[v][2] > 0);
  }
}

TEST(Pull, LeavesWhatIsNearerAndReportsTheRest) {
  TriangleSoup surface = test::icosphere(4, 1.1);
  const TriangleSoup input = test::icosphere(5, 1);
  std::vector<std::uint8_t> supported(surface.points.size(), 1);
  for (std::size_t v = 0; v < supported.size(); ++v) {
    if (surface.points[v][2] > 0.5) supported[v] = 0;
  }
  const TriangleSoup before = surface;
  const PullReport report =
      pull_to_input(surface, supported, NearestTriangle(input), 0.1, 0.01, silent_observer());
  std::int64_t count = 0;
  for (std::size_t v = 0; v < supported.size(); ++v) {
    if (supported[v] == 0) {
      EXPECT_EQ(surface.points[v], before.points[v]);
      continue;
    }
    ++count;
    EXPECT_NEAR(norm(surface.points[v]), 1.01, 2e-3);
  }
  EXPECT_EQ(report.supported, count);
  EXPECT_EQ(report.stopped_early + report.went_back, 0);
  EXPECT_DOUBLE_EQ(report.offset.median, 0.01);
  EXPECT_DOUBLE_EQ(report.offset.largest, 0.01);
  const std::vector<Point3> once = surface.points;
  pull_to_input(surface, supported, NearestTriangle(input), 0.1, 0.05, silent_observer());
  EXPECT_EQ(surface.points, once);
}

// Outside of a box, 0 within.
double distance_from_box(const Point3& p, const Point3& low, const Point3& high) {
  Point3 out{};
  for (int axis = 0; axis < 3; ++axis) {
    out[axis] = std::fmax(0, std::fmax(low[axis] - p[axis], p[axis] - high[axis]));
  }
  return std::sqrt(squared_norm(out));
}

TEST(PulledCrease, ReachesTheBottomAndPassesNoWall) {
  const Point3 axis{0.3, 1, 0.2};
  TriangleSoup soup = test::box({0, 0, 0}, {1, 1, 0.3});
  test::append(soup, test::box({0.3, 0.25, 0.2}, {0.7, 0.6, 0.9}));
  const RemeshResult result =
      run(test::rotated(soup, axis, 0.7), at_resolution(80, SurfaceMode::union_));
  expect_sound(result);
  const double tau = result.derived.pull_distance * result.frame.unit;
  const double step = result.frame.spacing;
  EXPECT_GT(result.pull.shifted, 100);

  const TriangleSoup surface = test::rotated(result.surface, axis, -0.7);
  const auto outside = [](const Point3& p) {
    return std::fmin(distance_from_box(p, {0, 0, 0}, {1, 1, 0.3}),
                     distance_from_box(p, {0.3, 0.25, 0.2}, {0.7, 0.6, 0.9}));
  };
  for (const Point3& p : surface.points) EXPECT_GT(outside(p), 0.4 * tau);
  double volume_of_bevels = 0;
  for (const Triangle& t : surface.triangles) {
    const Point3& a = surface.points[t[0]];
    const Point3& b = surface.points[t[1]];
    const Point3& c = surface.points[t[2]];
    volume_of_bevels += triangle_area(a, b, c) * outside((1.0 / 3) * (a + b + c));
  }
  // Around the foot of the tower, 1.5 long: bevels a step wide on each side have half of this, and
  // what the grid leaves without the slide is 1.4 times it.
  volume_of_bevels -= tau * area_of(surface);
  EXPECT_LT(volume_of_bevels, 0.5 * 1.5 * step * step);
}

}  // namespace
}  // namespace cellocut::testing
