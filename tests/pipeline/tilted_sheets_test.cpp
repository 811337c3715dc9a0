// A thickened square in any direction is one solid without handles: 200 seeded directions, some of
// them remeshed as a whole.
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "cellocut/field/distance_field.h"
#include "cellocut/surface/iso_surface.h"
#include "pipeline_runs.h"
#include "support/defective_meshes.h"

namespace cellocut::testing {
namespace {

constexpr int kDirections = 200;

// Uniform on the sphere by rejection.
Point3 direction(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto coordinate = [&] {
    return 2 * (static_cast<double>(random() >> 11U) / 9007199254740992.0) - 1;
  };
  while (true) {
    const Point3 p{coordinate(), coordinate(), coordinate()};
    const double length = squared_norm(p);
    if (length > 0.01 && length <= 1) return p;
  }
}

// The square as two triangles.
TriangleSoup sheet(std::uint64_t seed) { return test::tilted_sheet(direction(seed), 1, 1); }

void expect_one_ball(const SurfaceReport& report) {
  EXPECT_EQ(report.components.size(), 1U);
  EXPECT_EQ(report.euler, 2);
}

class TiltedSheets : public ::testing::TestWithParam<int> {};

// The surface of the thickened field: closed, manifold, one component, no handle.
TEST_P(TiltedSheets, ThickenToOneBall) {
  for (std::uint64_t seed = 0; seed < kDirections; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleSoup soup = sheet(seed);
    const DerivedParameters derived = derive_parameters(soup, at_resolution(GetParam()));
    const Frame frame =
        make_frame(bounding_box(soup), GetParam(), derived.epsilon_steps + kBand + 1);
    const SparseField phi =
        compute_distance_field(soup, frame, derived.epsilon_steps, silent_observer());
    const SurfaceReport report =
        inspect_surface(extract_iso_surface(phi), SurfaceCheckOptions{.intersections = false});
    expect_one_ball(report);
    EXPECT_EQ(report.by_index.boundary_edges, 0);
    EXPECT_EQ(report.by_index.nonmanifold_edges, 0);
    EXPECT_EQ(report.by_index.nonmanifold_vertices, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Pipeline, TiltedSheets, ::testing::Values(256, 512));

void expect_remeshed(int resolution, std::uint64_t directions) {
  const auto backend = backends::make("cgal");
  const auto solver = solvers::make("bk");
  std::map<std::pair<std::size_t, std::int64_t>, int> seen;  // components, Euler number
  for (std::uint64_t seed = 0; seed < directions; ++seed) {
    SCOPED_TRACE(seed);
    const RemeshResult result = remesh(sheet(seed), at_resolution(resolution), *backend, *solver);
    expect_sound(result);
    expect_one_ball(result.surface_report);
    ++seen[{result.surface_report.components.size(), result.surface_report.euler}];
  }
  for (const auto& [kind, count] : seen) {
    std::cout << "R = " << resolution << ": " << kind.first << " components, Euler " << kind.second
              << ": " << count << " of " << directions << " directions\n";
  }
}

TEST(TiltedSheetsRemeshed, AreOneBallAtR256) { expect_remeshed(256, 60); }
TEST(TiltedSheetsRemeshed, AreOneBallAtR512) { expect_remeshed(512, 6); }

}  // namespace
}  // namespace cellocut::testing
