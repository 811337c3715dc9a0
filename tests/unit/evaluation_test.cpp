// Measures with known answers, and all of them against plain loops over all pairs.
#include "cellocut/measure/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "cellocut/base/errors.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/measure/sampling.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut {
namespace {

using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// The rectangle [0, width] x [0, 1] at a height.
TriangleSoup sheet(double width, double height) {
  TriangleSoup soup;
  soup.points = {{0, 0, height}, {width, 0, height}, {width, 1, height}, {0, 1, height}};
  soup.triangles = {{0, 1, 2}, {0, 2, 3}};
  return soup;
}

Evaluation evaluate(const TriangleSoup& mesh, const TriangleSoup& reference,
                    const EvaluationOptions& options) {
  return Evaluator(reference, options)(mesh);
}

TEST(Evaluation, ConcentricSpheres) {
  // Chords of 0.04: a flat face lies up to 3e-4 within its sphere. Diameter 2, so half the gap.
  constexpr double kFlat = 3e-4;
  const Evaluation found =
      evaluate(test::icosphere(5, 1.1), test::icosphere(5, 1.0),
               {.samples = 20'000, .thresholds = {0.05 - kFlat, 0.05 + kFlat}});
  const Agreement& p2s = found.to_surface;
  for (const auto& way : {p2s.to_reference, p2s.from_reference}) {
    ASSERT_TRUE(way.has_value());
    for (const double d : {way->mean, way->median, way->p95, way->largest}) {
      EXPECT_NEAR(d, 0.05, kFlat);
    }
  }
  EXPECT_NEAR(*p2s.chamfer, 2 * 0.05 * 0.05, 4 * 0.05 * kFlat);
  EXPECT_NEAR(*p2s.hausdorff, 0.05, kFlat);
  EXPECT_GT(*p2s.normal_consistency, 0.999);
  EXPECT_THAT(p2s.f1, ElementsAre(0, 100));

  // 20,000 points stand 0.025 radii apart: the nearest is a little to the side.
  const Agreement& sampled = found.sampled;
  EXPECT_GT(*sampled.chamfer, *p2s.chamfer);
  EXPECT_LT(*sampled.chamfer, 1.1 * *p2s.chamfer);
  EXPECT_GE(*sampled.hausdorff, *p2s.hausdorff);
  EXPECT_LT(*sampled.hausdorff, 0.07);
  EXPECT_GT(*sampled.normal_consistency, 0.999);
}

TEST(Evaluation, ShiftedPlanes) {
  constexpr double kShift = 0.0625;
  const EvaluationOptions options{.samples = 5000, .thresholds = {0.03, 0.0624, 0.0626, 0.1}};
  for (const bool turned : {false, true}) {
    const TriangleSoup mesh = turned ? test::inside_out(sheet(1, kShift)) : sheet(1, kShift);
    const Agreement p2s = evaluate(mesh, sheet(1, 0), options).to_surface;
    for (const auto& way : {p2s.to_reference, p2s.from_reference}) {
      EXPECT_THAT((std::vector{way->mean, way->median, way->p95, way->largest}),
                  Each(DoubleNear(kShift, 1e-15)));
    }
    EXPECT_NEAR(*p2s.chamfer, 2 * kShift * kShift, 1e-15);
    EXPECT_NEAR(*p2s.hausdorff, kShift, 1e-15);
    EXPECT_EQ(*p2s.normal_consistency, 1) << "the cosine counts without its sign";
    EXPECT_THAT(p2s.f1, ElementsAre(0, 0, 100, 100));
  }
}

TEST(Evaluation, HalfOfASheet) {
  // From the other half distances are uniform from 0 to 1/2. 40,000 samples: within 0.01.
  const Evaluation found =
      evaluate(sheet(0.5, 0), sheet(1, 0), {.samples = 40'000, .thresholds = {0.1, 0.25}});
  const Agreement& p2s = found.to_surface;
  EXPECT_NEAR(p2s.to_reference->largest, 0, 1e-15);
  EXPECT_NEAR(p2s.from_reference->mean, 0.125, 0.01);
  EXPECT_NEAR(p2s.from_reference->mean_square, 0.5 * 0.25 / 3, 0.01);
  EXPECT_NEAR(p2s.from_reference->median, 0, 0.01);
  EXPECT_NEAR(p2s.from_reference->p95, 0.45, 0.01);
  EXPECT_NEAR(p2s.from_reference->largest, 0.5, 0.01);
  EXPECT_NEAR(*p2s.hausdorff, 0.5, 0.01) << "the larger of the two ways";
  // Everything of the mesh is near, 0.6 and 0.75 of the reference.
  EXPECT_NEAR(p2s.f1[0], 100 * 2 * 0.6 / 1.6, 1);
  EXPECT_NEAR(p2s.f1[1], 100 * 2 * 0.75 / 1.75, 1);
  EXPECT_NEAR(found.sampled.f1[0], p2s.f1[0], 1);
}

TEST(Evaluation, NormalsOfATiltedSheet) {
  // Two sheets through one another at 60 degrees.
  const TriangleSoup flat = test::tilted_sheet({0, 0, 1}, 1, 2);
  const double turn = std::numbers::pi / 3;
  const Evaluation found =
      evaluate(test::rotated(flat, {1, 0, 0}, turn), flat, {.samples = 2000, .thresholds = {}});
  EXPECT_NEAR(*found.to_surface.normal_consistency, 0.5, 1e-14);
  EXPECT_NEAR(*found.sampled.normal_consistency, 0.5, 1e-14);
  EXPECT_TRUE(found.sampled.f1.empty());
}

TEST(Evaluation, NormalsOfEachWay) {
  // Of the reference, half is the sheet and half a wall far below it, as large: all of the mesh
  // agrees with what is nearest, and half of the reference. 40,000 samples: within 0.01.
  TriangleSoup reference = sheet(1, 0);
  reference.points.insert(reference.points.end(),
                          {{0.5, 0, -2}, {0.5, 1, -2}, {0.5, 1, -1}, {0.5, 0, -1}});
  reference.triangles.insert(reference.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
  const Evaluation found = evaluate(sheet(1, 0), reference, {.samples = 40'000, .thresholds = {}});
  for (const Agreement* agreement : {&found.sampled, &found.to_surface}) {
    EXPECT_NEAR(*agreement->normals_to_reference, 1, 1e-14);
    EXPECT_NEAR(*agreement->normals_from_reference, 0.5, 0.01);
    EXPECT_EQ(*agreement->normal_consistency,
              0.5 * (*agreement->normals_to_reference + *agreement->normals_from_reference));
  }
}

// ---- against plain loops ------------------------------------------------------------------------

// The nearest of all candidates. On an edge or a corner several faces are nearest, and rounding
// picks one of them: the least and the largest |cosine| among those.
struct Found {
  double distance = std::numeric_limits<double>::infinity();
  double least_cosine = 1;
  double largest_cosine = 0;

  void meet(double d, double cosine) {
    constexpr double kRounding = 1e-12;
    if (d > distance + kRounding) return;
    if (d < distance - kRounding) {
      least_cosine = 1;
      largest_cosine = 0;
    }
    distance = std::min(distance, d);
    least_cosine = std::min(least_cosine, cosine);
    largest_cosine = std::max(largest_cosine, cosine);
  }
};

using Search = std::function<Found(const Point3& p, const Point3& normal)>;

Search among_samples(const Samples& to) {
  return [&to](const Point3& p, const Point3& normal) {
    Found best;
    for (std::size_t i = 0; i < to.size(); ++i) {
      best.meet(norm(to.points[i] - p), std::fabs(dot(normal, to.normals[i])));
    }
    return best;
  };
}

Search among_faces(const TriangleSoup& to) {
  return [&to](const Point3& p, const Point3& normal) {
    Found best;
    for (const Triangle& t : to.triangles) {
      const Point3& a = to.points[t[0]];
      const Point3& b = to.points[t[1]];
      const Point3& c = to.points[t[2]];
      const Point3 face_normal = cross(b - a, c - a);
      best.meet(norm(p - nearest_on_triangle(p, a, b, c)),
                std::fabs(dot(normal, face_normal)) / norm(face_normal));
    }
    return best;
  };
}

void expect_as_loops(const Agreement& found, const Samples& mesh, const Search& to_reference,
                     const Samples& reference, const Search& to_mesh, double threshold) {
  double chamfer = 0;
  double hausdorff = 0;
  double least_normals = 0;
  double largest_normals = 0;
  std::vector<double> near;
  for (const auto& [from, search] : {std::pair{&mesh, &to_reference}, {&reference, &to_mesh}}) {
    const auto count = static_cast<double>(from->size());
    double hits = 0;
    for (std::size_t i = 0; i < from->size(); ++i) {
      const Found nearest = (*search)(from->points[i], from->normals[i]);
      chamfer += nearest.distance * nearest.distance / count;
      hausdorff = std::max(hausdorff, nearest.distance);
      least_normals += nearest.least_cosine / count / 2;
      largest_normals += nearest.largest_cosine / count / 2;
      hits += nearest.distance < threshold ? 1 : 0;
    }
    near.push_back(hits / count);
  }
  EXPECT_NEAR(*found.chamfer, chamfer, 1e-13);
  EXPECT_NEAR(*found.hausdorff, hausdorff, 1e-14);
  EXPECT_GE(*found.normal_consistency, least_normals - 1e-13);
  EXPECT_LE(*found.normal_consistency, largest_normals + 1e-13);
  EXPECT_NEAR(found.f1[0], 200 * near[0] * near[1] / (near[0] + near[1]), 1e-12);
}

TEST(Evaluation, AgreesWithPlainLoops) {
  // The reference fills the box [-1/2, 1/2]^3, so that relative coordinates are its own.
  const TriangleSoup reference = test::box({-0.5, -0.4, -0.5}, {0.5, 0.4, 0.5});
  const TriangleSoup mesh = test::icosphere(1, 0.55, {0.05, 0, 0.1});
  constexpr double kThreshold = 0.1;
  const Evaluation found =
      evaluate(mesh, reference, {.samples = 700, .seed = 6, .thresholds = {kThreshold}});
  const Samples of_mesh = sample_surface(mesh, 700, 13);
  const Samples of_reference = sample_surface(reference, 700, 12);
  expect_as_loops(found.sampled, of_mesh, among_samples(of_reference), of_reference,
                  among_samples(of_mesh), kThreshold);
  expect_as_loops(found.to_surface, of_mesh, among_faces(reference), of_reference,
                  among_faces(mesh), kThreshold);
}

// ---- the same bits ------------------------------------------------------------------------------

TEST(Evaluation, SameBitsForAnyNumberOfThreads) {
  std::vector<Evaluation> results;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(evaluate(test::torus(1, 0.4, 24, 12), test::icosphere(3), {.samples = 5000}));
  }
  EXPECT_EQ(results[1], results[0]);
  EXPECT_EQ(results[2], results[0]);
}

TEST(Evaluation, SameBitsAtAnyPowerOfTwo) {
  const TriangleSoup mesh = test::torus(1, 0.4, 24, 12);
  const TriangleSoup reference = test::icosphere(3, 1.3, {0.1, 0.2, 0.7});
  const Evaluation found = evaluate(mesh, reference, {.samples = 3000});
  for (const double factor : {0x1p-200, 0x1p-3, 0x1p150}) {
    const Evaluator evaluator(test::scaled(reference, factor), {.samples = 3000});
    EXPECT_EQ(evaluator(test::scaled(mesh, factor)), found);
    EXPECT_EQ(evaluator.unit(), factor * Evaluator(reference, {}).unit());
  }
}

TEST(Evaluation, SeedsDifferALittle) {
  const TriangleSoup mesh = test::icosphere(3, 1.1);
  const TriangleSoup reference = test::icosphere(3);
  const double first = *evaluate(mesh, reference, {.samples = 10'000, .seed = 1}).sampled.chamfer;
  const double second = *evaluate(mesh, reference, {.samples = 10'000, .seed = 2}).sampled.chamfer;
  EXPECT_NE(first, second);
  EXPECT_NEAR(first, second, 0.01 * first);
}

TEST(Evaluation, OfAMeshWithItself) {
  const TriangleSoup mesh = test::torus(1, 0.4, 24, 12);
  const Evaluation found = evaluate(mesh, mesh, {.samples = 5000});
  EXPECT_GT(*found.sampled.hausdorff, 0.001) << "the samples are not the same";
  EXPECT_LT(*found.to_surface.hausdorff, 1e-15);
  EXPECT_THAT(found.to_surface.f1, Each(100));
}

TEST(Evaluation, FacesWithoutAreaTakeNoPart) {
  const TriangleSoup reference = test::icosphere(2);
  TriangleSoup mesh = test::icosphere(2, 0.9);
  const Evaluation found = evaluate(mesh, reference, {.samples = 3000});
  // Between the others, so that what follows is renumbered, and nearer to the reference than they.
  mesh.triangles.insert(mesh.triangles.begin() + 50, {{0, 0, 1}, {2, 2, 2}});
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  mesh.triangles.insert(mesh.triangles.begin() + 20, {first, first + 1, first + 2});
  EXPECT_EQ(evaluate(mesh, reference, {.samples = 3000}), found);
}

TEST(Evaluation, MuchSmallerThanTheReferenceOrFarAway) {
  const TriangleSoup reference = test::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  const Agreement tiny =
      evaluate(test::icosphere(1, 1e-60), reference, {.samples = 200}).to_surface;
  EXPECT_NEAR(tiny.to_reference->largest, 0.5, 1e-15);
  EXPECT_GT(tiny.from_reference->largest, 0.7);
  EXPECT_EQ(evaluate(test::icosphere(1, 1e-60), reference, {.samples = 200}).sampled.f1[0], 0);
  const Agreement far =
      evaluate(test::icosphere(1, 1, {1e50, 0, 0}), reference, {.samples = 200}).to_surface;
  EXPECT_NEAR(*far.hausdorff / 1e50, 1, 1e-12);
}

// ---- point clouds -------------------------------------------------------------------------------

PointCloud cloud_of(const TriangleSoup& soup, std::size_t count, bool normals) {
  const Samples samples = sample_surface(soup, count, 77);
  PointCloud cloud{samples.points, {}};
  if (normals) {
    for (const Point3& n : samples.normals) cloud.normals.push_back(-3 * n);
  }
  return cloud;
}

const EvaluationOptions kOptions{.samples = 10'000};

TEST(Evaluation, PointCloudWithNormals) {
  PointCloud cloud = cloud_of(test::icosphere(4), 20'000, true);
  const Evaluator evaluator(cloud, kOptions);
  EXPECT_NEAR(evaluator.unit(), 2, 0.01);
  const Evaluation found = evaluator(test::icosphere(4, 1.1));
  EXPECT_NEAR(*found.sampled.hausdorff, 0.05, 0.02);
  EXPECT_GT(*found.sampled.normal_consistency, 0.99);
  EXPECT_EQ(found.sampled.f1.size(), 4U);
  // To the mesh there is a surface, to the cloud there is none.
  EXPECT_FALSE(found.to_surface.to_reference.has_value());
  ASSERT_TRUE(found.to_surface.from_reference.has_value());
  EXPECT_NEAR(found.to_surface.from_reference->median, 0.05, 1e-3);
  EXPECT_FALSE(found.to_surface.chamfer.has_value());
  EXPECT_FALSE(found.to_surface.hausdorff.has_value());
  EXPECT_FALSE(found.to_surface.normal_consistency.has_value());
  EXPECT_TRUE(found.to_surface.f1.empty());
  // Points whose normal is zero are left out of the mean of the cosines.
  for (std::size_t i = 0; i < cloud.normals.size(); i += 2) cloud.normals[i] = {0, 0, 0};
  EXPECT_NEAR(*Evaluator(cloud, kOptions)(test::icosphere(4, 1.1)).sampled.normal_consistency,
              *found.sampled.normal_consistency, 1e-3);
  std::fill(cloud.normals.begin(), cloud.normals.end(), Point3{0, 0, 0});
  EXPECT_FALSE(
      Evaluator(cloud, kOptions)(test::icosphere(2)).sampled.normal_consistency.has_value());
}

TEST(Evaluation, PointCloudWithoutNormals) {
  const Evaluation found =
      Evaluator(cloud_of(test::icosphere(4), 20'000, false), kOptions)(test::icosphere(4, 1.1));
  EXPECT_FALSE(found.sampled.normal_consistency.has_value());
  EXPECT_NEAR(*found.sampled.hausdorff, 0.05, 0.02);
}

// ---- what cannot be measured --------------------------------------------------------------------

TEST(Evaluation, Refuses) {
  const TriangleSoup good = test::icosphere(1);
  TriangleSoup point = good;
  for (Point3& p : point.points) p = {1, 2, 3};
  TriangleSoup line = good;
  for (Point3& p : line.points) p = {p[0], 0, 0};
  TriangleSoup wild = good;
  wild.points[0][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { evaluate(good, TriangleSoup{}, {.samples = 50}); },
              ThrowsMessage<InputError>("no faces"));
  EXPECT_THAT([&] { evaluate(TriangleSoup{}, good, {.samples = 50}); },
              ThrowsMessage<InputError>("no face has an area"));
  EXPECT_THAT([&] { evaluate(good, point, {.samples = 50}); },
              ThrowsMessage<InputError>(HasSubstr("no extent")));
  EXPECT_THAT([&] { evaluate(good, line, {.samples = 50}); },
              ThrowsMessage<InputError>("no face has an area"));
  EXPECT_THAT([&] { evaluate(line, good, {.samples = 50}); },
              ThrowsMessage<InputError>("no face has an area"));
  EXPECT_THAT([&] { evaluate(good, wild, {.samples = 50}); },
              ThrowsMessage<InputError>(HasSubstr("not finite")));
  EXPECT_THAT([&] { evaluate(wild, good, {.samples = 50}); },
              ThrowsMessage<InputError>(HasSubstr("not finite")));
  EXPECT_THAT([&] { evaluate(test::scaled(good, 1e80), good, {.samples = 50}); },
              ThrowsMessage<InputError>(HasSubstr("too large beside the reference")));
  EXPECT_THAT([&] { Evaluator(PointCloud{}, {.samples = 50}); },
              ThrowsMessage<InputError>("no points"));
  EXPECT_THAT(
      [&] {
        Evaluator(PointCloud{{{1, 1, 1}}, {}}, {});
      },
      ThrowsMessage<InputError>(HasSubstr("no extent")));
  EXPECT_THAT([&] { Evaluator(good, {.samples = 0}); },
              ThrowsMessage<UsageError>(HasSubstr("samples")));
  EXPECT_THAT(
      [&] {
        Evaluator(good, {.thresholds = {0.1, 0}});
      },
      ThrowsMessage<UsageError>(HasSubstr("threshold")));
}

TEST(Evaluation, StopsWhenAsked) {
  class Stop : public Observer {
    [[nodiscard]] bool cancelled() const override { return true; }
  };
  const Evaluator evaluator(test::icosphere(1), {.samples = 500});
  EXPECT_THROW((void)evaluator(test::icosphere(1), Stop()), Cancelled);
}

}  // namespace
}  // namespace cellocut
