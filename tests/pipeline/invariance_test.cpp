// The same solid for the same surface: bit for bit where nothing but names change, closely where
// rounding does.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "cellocut/measure/nearest_triangle.h"
#include "pipeline_runs.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut::testing {
namespace {

constexpr int kResolution = 48;

class Invariance : public ::testing::TestWithParam<test::NamedSoup> {};

void expect_same_bits(const RemeshResult& result, const RemeshResult& expected) {
  EXPECT_EQ(result.cut.value, expected.cut.value);
  EXPECT_EQ(result.label, expected.label);
  EXPECT_EQ(result.surface.points, expected.surface.points);
  EXPECT_EQ(result.surface.triangles, expected.surface.triangles);
  EXPECT_EQ(result.supported, expected.supported);
}

TEST_P(Invariance, OrderAndOrientationDoNotMatter) {
  const TriangleSoup& soup = GetParam().soup;
  for (const SurfaceMode mode : {SurfaceMode::union_, SurfaceMode::sdf, SurfaceMode::cells}) {
    const RemeshOptions options = at_resolution(kResolution, mode);
    const RemeshResult expected = run(soup, options);
    expect_same_bits(run(test::with_faces_permuted(soup, 1), options), expected);
    expect_same_bits(run(test::with_corners_rotated(soup, 2), options), expected);
    expect_same_bits(run(test::with_faces_flipped(soup, 3), options), expected);
    expect_same_bits(run(test::with_points_permuted(soup, 4), options), expected);
    for (const double scale : {0x1p-20, 0x1p20}) {
      RemeshResult scaled = run(test::scaled(soup, scale), options);
      scaled.surface = test::scaled(std::move(scaled.surface), 1 / scale);
      expect_same_bits(scaled, expected);
    }
  }
}

TEST_P(Invariance, ThreadsDoNotMatter) {
  for (const Variant<Tetrahedralizer>& backend : backends::registered()) {
    if (backend.make == nullptr) continue;
    for (const SurfaceMode mode : {SurfaceMode::union_, SurfaceMode::sdf, SurfaceMode::cells}) {
      std::vector<RemeshResult> results;
      for (const std::size_t threads : {1, 2, 8}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(run(GetParam().soup, at_resolution(kResolution, mode), backend.name));
      }
      expect_same_bits(results[1], results[0]);
      expect_same_bits(results[2], results[0]);
    }
  }
}

// From the vertices of one to the surface of the other.
double directed_distance(const TriangleSoup& from, const TriangleSoup& to) {
  const NearestTriangle surface(to);
  double largest = 0;
  for (const Point3& p : from.points) largest = std::max(largest, surface(p).distance);
  return largest;
}

void expect_hardly_changed(const TriangleSoup& soup, const RemeshOptions& options) {
  const double unit = bounding_box(soup).longest_edge();
  const RemeshResult expected = run(soup, options);
  struct Change {
    double scale;
    double offset;
  };
  for (const Change& change : {Change{1e-6, 0}, {1e6, 0}, {1, 1e3 * unit}}) {
    SCOPED_TRACE(::testing::Message() << "scale " << change.scale << " offset " << change.offset);
    const Point3 offset{change.offset, change.offset, change.offset};
    RemeshResult result = run(test::translated(test::scaled(soup, change.scale), offset), options);
    expect_sound(result);
    EXPECT_EQ(result.surface_report.components.size(), expected.surface_report.components.size());
    const double energy = relative_energy(expected, options);
    EXPECT_NEAR(relative_energy(result, options), energy, 1e-3 * energy);
    const double volume = expected.surface_report.volume;
    EXPECT_NEAR(result.surface_report.volume / std::pow(change.scale, 3), volume, 1e-3 * volume);
    const TriangleSoup back =
        test::scaled(test::translated(std::move(result.surface), -1.0 * offset), 1 / change.scale);
    const double h = unit / kResolution;
    EXPECT_LT(directed_distance(back, expected.surface), h);
    EXPECT_LT(directed_distance(expected.surface, back), h);
  }
}

TEST_P(Invariance, ScaleAndPlaceHardlyMatter) {
  const TriangleSoup& soup = GetParam().soup;
  for (const SurfaceMode mode : {SurfaceMode::union_, SurfaceMode::sdf}) {
    expect_hardly_changed(soup, at_resolution(kResolution, mode));
  }
}

INSTANTIATE_TEST_SUITE_P(Pipeline, Invariance, ::testing::ValuesIn(test::all_defective_meshes()),
                         [](const ::testing::TestParamInfo<test::NamedSoup>& mesh) {
                           return mesh.param.name;
                         });

}  // namespace
}  // namespace cellocut::testing
