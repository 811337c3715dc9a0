// Known solids with holes cut in, filled: how far the result is from the whole shape, with and
// without --fair.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>

#include "cellocut/measure/nearest_triangle.h"
#include "pipeline_runs.h"
#include "support/defective_meshes.h"

namespace cellocut::testing {
namespace {

constexpr int kResolution = 96;

struct Solid {
  std::string name;
  TriangleSoup whole;
  double volume;
  std::function<double(const Point3&)> distance;  // from the surface of the whole shape
  std::vector<Point3> holes;                      // centres
  double radius;                                  // of each
};
std::ostream& operator<<(std::ostream& out, const Solid& c) { return out << c.name; }

// Each face of the box in 2 x 32^2 triangles, so that a hole has a round rim.
TriangleSoup fine_box(const Point3& high) {
  constexpr int kCells = 32;
  TriangleSoup soup;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      const auto first = static_cast<std::uint32_t>(soup.points.size());
      for (int i = 0; i <= kCells; ++i) {
        for (int j = 0; j <= kCells; ++j) {
          Point3 p{};
          p[axis] = side * high[axis];
          p[(axis + 1) % 3] = high[(axis + 1) % 3] * i / kCells;
          p[(axis + 2) % 3] = high[(axis + 2) % 3] * j / kCells;
          soup.points.push_back(p);
        }
      }
      for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j < kCells; ++j) {
          const auto at = [&](int di, int dj) {
            return first + static_cast<std::uint32_t>((i + di) * (kCells + 1) + j + dj);
          };
          soup.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
          soup.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
        }
      }
    }
  }
  return soup;
}

std::vector<Solid> solids() {
  const TriangleSoup box = fine_box({1, 0.8, 0.6});
  const auto box_distance = std::make_shared<NearestTriangle>(box);
  return {{"sphere",
           test::icosphere(5),
           4.0 / 3 * M_PI,
           [](const Point3& p) { return std::fabs(norm(p) - 1); },
           {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
           0.4},
          {"torus",
           test::torus(1, 0.4, 160, 64),
           2 * M_PI * M_PI * 0.4 * 0.4,
           [](const Point3& p) {
             return std::fabs(std::hypot(std::hypot(p[0], p[1]) - 1, p[2]) - 0.4);
           },
           {{1.4, 0, 0}, {0, 1, 0.4}, {-1, 0, -0.4}},
           0.2},
          {"box",
           box,
           0.48,
           [box_distance](const Point3& p) { return (*box_distance)(p).distance; },
           {{0.5, 0.4, 0.6}, {0.5, 0, 0.3}},
           0.15}};
}

TriangleSoup with_holes(const Solid& solid) {
  TriangleSoup soup = solid.whole;
  std::erase_if(soup.triangles, [&](const Triangle& t) {
    const Point3 middle = (1.0 / 3) * (soup.points[t[0]] + soup.points[t[1]] + soup.points[t[2]]);
    return std::any_of(solid.holes.begin(), solid.holes.end(),
                       [&](const Point3& hole) { return norm(middle - hole) < solid.radius; });
  });
  return soup;
}

struct Errors {
  double hausdorff;  // in grid steps, both ways
  double mean;       // of the completed vertices, in grid steps
  double volume;     // relative
};

class KnownSolid : public ::testing::TestWithParam<Solid> {
 protected:
  static Errors errors_of(bool fair) {
    const Solid& solid = GetParam();
    RemeshOptions options = at_resolution(kResolution, SurfaceMode::union_);
    options.lambda_fill = {3, 1};
    options.fair = fair;
    const RemeshResult result = run(with_holes(solid), options);
    expect_sound(result);
    EXPECT_EQ(result.surface_report.components.size(), 1U);
    const double step = result.frame.spacing;
    Errors errors{0, 0, result.surface_report.volume / solid.volume - 1};
    std::int64_t completed = 0;
    for (std::size_t v = 0; v < result.surface.points.size(); ++v) {
      const double distance = solid.distance(result.surface.points[v]) / step;
      errors.hausdorff = std::max(errors.hausdorff, distance);
      if (result.supported[v] != 0) continue;
      errors.mean += distance;
      ++completed;
    }
    EXPECT_GT(completed, 100);
    errors.mean /= static_cast<double>(completed);
    const NearestTriangle nearest(result.surface);
    for (const Point3& p : solid.whole.points) {
      errors.hausdorff = std::max(errors.hausdorff, nearest(p).distance / step);
    }
    std::cout << solid.name << (fair ? ", fair" : "") << ": Hausdorff " << errors.hausdorff
              << " h, mean of the patches " << errors.mean << " h, volume " << 100 * errors.volume
              << " %\n";
    return errors;
  }
};

TEST_P(KnownSolid, IsFilledAndFairingBringsItNearer) {
  const Errors cut = errors_of(false);
  const Errors fair = errors_of(true);
  EXPECT_LT(std::fabs(fair.volume), 3e-3);
  EXPECT_LT(fair.mean, 0.15 * cut.mean);
  // (The worst vertex depends on where cells leave the rim of a hole ragged: 0.04 to 2 at one
  // resolution or another, with this proxy and with that of quadric collapses.)
  EXPECT_LT(fair.hausdorff, 0.3 * cut.hausdorff);
}

INSTANTIATE_TEST_SUITE_P(Pipeline, KnownSolid, ::testing::ValuesIn(solids()),
                         [](const ::testing::TestParamInfo<Solid>& s) { return s.param.name; });

}  // namespace
}  // namespace cellocut::testing
