// Points of the user: what they fix, what that does to the solid, and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "cellocut/base/errors.h"
#include "cellocut/complex/point_location.h"
#include "cellocut/path/path_certificate.h"
#include "pipeline_runs.h"
#include "support/defective_meshes.h"

namespace cellocut::testing {
namespace {

RemeshOptions guided_options(const Guidance& guidance, std::int64_t lambda = 20) {
  RemeshOptions options = at_resolution(64);
  options.guidance = guidance;
  options.lambda_fill = {lambda, 1};
  return options;
}

TEST(CellsHolding, AreAllAroundAFacetAnEdgeAndACorner) {
  const RemeshResult result =
      pose_cut(test::two_crossing_boxes(), at_resolution(24), *backends::make("cgal"));
  const TetComplex& complex = result.complex;
  for (std::uint32_t c = 0; c < complex.cells.size(); c += 97) {
    const std::uint32_t corner = complex.cells[c][1];
    std::vector<std::uint32_t> around;
    for (std::uint32_t d = 0; d < complex.cells.size(); ++d) {
      const auto& cell = complex.cells[d];
      if (std::find(cell.begin(), cell.end(), corner) != cell.end()) around.push_back(d);
    }
    EXPECT_EQ(cells_holding(complex, complex.points[corner]), around);
    const std::vector<std::uint32_t> own = cells_holding(complex, cell_centroid(complex, c));
    EXPECT_EQ(own, std::vector<std::uint32_t>{c});
  }
  EXPECT_TRUE(cells_holding(complex, {100, 0, 0}).empty());
}

// What nothing leads into is filled by construction. The wall is the slab, 2 eps thick.
TEST(Guidance, AnOutsidePointOpensACavity) {
  const TriangleSoup sphere = test::icosphere(4);
  RemeshOptions options = guided_options({});
  options.pull = false;
  const RemeshResult filled = run(sphere, options);
  EXPECT_GT(filled.surface_report.volume, 4);
  options.guidance.outside = {{0, 0, 0}};
  const RemeshResult opened = run(sphere, options);
  expect_sound(opened);
  EXPECT_FALSE(opened.guided.outside.empty());
  EXPECT_EQ(opened.surface_report.components.size(), 2U);
  const double thickness = 2 * opened.derived.epsilon * opened.frame.unit;
  EXPECT_NEAR(opened.surface_report.volume, 4 * std::numbers::pi * thickness,
              0.05 * 4 * std::numbers::pi * thickness);
}

TEST(Guidance, AnInsidePointFillsWhatLambdaLeavesHollow) {
  const TriangleSoup sphere = test::sphere_with_hole();
  const RemeshResult hollow = run(sphere, guided_options({}, 40));
  EXPECT_LT(hollow.surface_report.volume, 1);
  const RemeshResult filled =
      run(sphere, guided_options({.inside = {{0, 0, 0}}, .outside = {}}, 40));
  expect_sound(filled);
  EXPECT_GT(filled.surface_report.volume, 3.5);
  EXPECT_EQ(filled.initial_label, hollow.initial_label);  // L* is as it was
}

TEST(Guidance, GoesWithThePathAndTheAutomaticWeight) {
  RemeshOptions options = guided_options({.inside = {{0, 0, 0}}, .outside = {{0, 0, 1.2}}}, 1);
  const RemeshResult result = pose_cut(test::sphere_with_hole(), options, *backends::make("cgal"));
  const CellPath path = find_path(result, {1, 1}, {1000, 1}, *solvers::make("bk"));
  EXPECT_TRUE(path_checker(result, options).check(path, {{1, 1}, {1000, 1}}).valid);
  const GuidedCells nobody;
  const PathChecker unguided({.complex = result.complex,
                              .initial = result.initial_label,
                              .mode = options.exterior,
                              .guided = nobody,
                              .unit = result.frame.unit,
                              .area_bits = options.area_bits});
  EXPECT_FALSE(unguided.check(path, {{1, 1}, {1000, 1}}).valid);
  for (const std::uint32_t cell : result.guided.inside) EXPECT_EQ(path.level[cell], path.count());
  options.lambda_auto = true;
  expect_sound(run(test::sphere_with_hole(), options));
}

TEST(Guidance, RefusesWhatContradicts) {
  const TriangleSoup sphere = test::nested_spheres();
  const auto refused = [&](const Guidance& guidance, const std::string& what,
                           ExteriorMode mode = ExteriorMode::unbounded) {
    RemeshOptions options = guided_options(guidance);
    options.exterior = mode;
    try {
      (void)pose_cut(sphere, options, *backends::make("cgal"));
      ADD_FAILURE() << "not refused: " << what;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  refused({.inside = {}, .outside = {{0, 0, 1}}}, "always solid");
  refused({.inside = {{0, 0, 5}}, .outside = {}}, "beyond the hull");
  refused({.inside = {{0.01, 0, 0}}, .outside = {{0.01, 0, 0}}}, "same tetrahedron");
  // Far from the sphere but within the hull there is nothing: a corner between sphere and hull.
  const RemeshResult plain =
      pose_cut(test::two_crossing_boxes(), guided_options({}), *backends::make("cgal"));
  for (std::uint32_t c = 0; c < plain.complex.cells.size(); ++c) {
    const auto& around = plain.complex.neighbours[c];
    if (plain.initial_label[c] == kInterior ||
        std::find(around.begin(), around.end(), kOutside) == around.end()) {
      continue;
    }
    RemeshOptions options =
        guided_options({.inside = {cell_centroid(plain.complex, c)}, .outside = {}});
    options.exterior = ExteriorMode::hull_cells;
    EXPECT_THROW((void)pose_cut(test::two_crossing_boxes(), options, *backends::make("cgal")),
                 UsageError);
    break;
  }
}

TEST(Guidance, TheCertificateKnowsWhatWasFixed) {
  RemeshResult result =
      run(test::nested_spheres(), guided_options({.inside = {}, .outside = {{0, 0, 0.85}}}));
  const auto claim = [&](const GuidedCells& guided) {
    return check_certificate({.complex = result.complex,
                              .initial = result.initial_label,
                              .mode = ExteriorMode::unbounded,
                              .lambda = {20, 1},
                              .unit = result.frame.unit,
                              .area_bits = 40,
                              .facet_flow = result.facet_flow,
                              .value = result.cut.value,
                              .smallest_interior = result.smallest_interior,
                              .largest_interior = result.largest_interior,
                              .guided = guided});
  };
  EXPECT_TRUE(claim(result.guided).valid);
  EXPECT_FALSE(claim({}).valid);  // without the point this is no minimum
  GuidedCells wrong = result.guided;
  wrong.inside = wrong.outside;
  EXPECT_FALSE(claim(wrong).valid);
  wrong = result.guided;
  wrong.outside.push_back(static_cast<std::uint32_t>(result.label.size()));
  EXPECT_FALSE(claim(wrong).valid);
}

}  // namespace
}  // namespace cellocut::testing
