// Simplified surfaces: as valid as before, as near as they say, and as few faces as asked for.
#include "cellocut/surface/simplification.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/measure/surface_distance.h"
#include "cellocut/validity/surface_report.h"
#include "validity_meshes.h"

namespace cellocut {
namespace {

using testing::box;
using testing::gridded_box;
using testing::icosphere;
using testing::joined;
using testing::torus;

Simplification simplify(const TriangleSoup& surface, std::int64_t faces, double max_error = 0) {
  return simplify_surface(surface, {.faces = faces, .max_error = max_error}, silent_observer());
}

// Everything that holds for every result.
void expect_sound(const TriangleSoup& before, const Simplification& result) {
  const SurfaceReport old_report = inspect_surface(before);
  ASSERT_TRUE(old_report.valid()) << "the test's own surface";
  const SurfaceReport report = inspect_surface(result.surface);
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.euler, old_report.euler);
  EXPECT_EQ(report.components.size(), old_report.components.size());
  ASSERT_EQ(result.source.size(), result.surface.points.size());
  for (std::size_t i = 0; i < result.source.size(); ++i) {
    EXPECT_EQ(result.surface.points[i], before.points[result.source[i]]);
  }
  EXPECT_EQ(static_cast<std::int64_t>(before.triangles.size()) - 2 * result.counts.collapses,
            static_cast<std::int64_t>(result.surface.triangles.size()));
  EXPECT_LE(result.error_lower, result.error);
  EXPECT_EQ(result.reached, result.stop.empty());
  // The error once more, from samples alone.
  const NearestTriangle nearest(result.surface);
  for (const Triangle& t : before.triangles) {
    const Point3& p = before.points[t[0]];
    ASSERT_LE(nearest(p).distance, result.error * (1 + 1e-9) + 1e-12);
  }
}

TriangleSoup rotated(TriangleSoup soup, double angle) {
  for (Point3& p : soup.points) {
    const double x = std::cos(angle) * p[0] - std::sin(angle) * p[1];
    const double y = std::sin(angle) * p[0] + std::cos(angle) * p[1];
    p = {x, std::cos(angle) * y - std::sin(angle) * p[2],
         std::sin(angle) * y + std::cos(angle) * p[2]};
  }
  return soup;
}

TEST(Simplification, OfABoxLeavesTheTwelveFaces) {
  const TriangleSoup dense = gridded_box({0, 0, 0}, {1, 2, 3}, 20);
  const Simplification result = simplify(dense, 12);
  expect_sound(dense, result);
  EXPECT_TRUE(result.reached);
  EXPECT_EQ(result.surface.triangles.size(), 12U);
  EXPECT_LE(result.error, 1e-14) << "corners and edges have to survive";
  EXPECT_NEAR(inspect_surface(result.surface).volume, 6, 1e-12);
}

TEST(Simplification, OfATiltedBoxKeepsItsEdges) {
  const TriangleSoup dense = rotated(gridded_box({0, 0, 0}, {1, 1, 1}, 25), 0.7);
  for (const std::int64_t faces : {400, 12}) {
    const Simplification result = simplify(dense, faces);
    expect_sound(dense, result);
    EXPECT_LE(result.error, 1e-14);
  }
}

TEST(Simplification, WithAnErrorOfNearlyNothingFlatFacesStillMerge) {
  const TriangleSoup dense = rotated(gridded_box({0, 0, 0}, {1, 1, 1}, 12), 0.7);
  const Simplification result = simplify(dense, 0, 1e-6);
  expect_sound(dense, result);
  EXPECT_EQ(result.surface.triangles.size(), 12U);
  EXPECT_LE(result.error, 1e-6);
}

TEST(Simplification, OfASphereGetsBetterWithMoreFaces) {
  const TriangleSoup dense = icosphere(5);
  double last = 2;
  for (const std::int64_t faces : {20, 200, 2000}) {
    const Simplification result = simplify(dense, faces);
    expect_sound(dense, result);
    EXPECT_TRUE(result.reached);
    EXPECT_EQ(result.surface.triangles.size(), static_cast<std::size_t>(faces));
    EXPECT_LT(result.error, 0.4 * last);
    last = result.error;
  }
  // A regular mesh of 2000 triangles is some 0.0024 away.
  EXPECT_LT(last, 0.01);
}

TEST(Simplification, KeepsToTheErrorAllowed) {
  for (const double allowed : {0.1, 0.01, 0.001}) {
    const TriangleSoup dense = joined(torus(200, 60, 2, 0.5), icosphere(5, 1));
    const Simplification result = simplify(dense, 0, allowed);
    expect_sound(dense, result);
    EXPECT_TRUE(result.reached);
    EXPECT_LE(result.error, allowed);
    EXPECT_GE(result.error, 0.4 * allowed) << "it should make use of it";
    EXPECT_LT(result.surface.triangles.size(), dense.triangles.size() / 2);
    const SurfaceDistance distance =
        measure_surface_distance(dense, result.surface, 1e-3, silent_observer());
    EXPECT_LE(distance.lower(), allowed);
  }
}

TEST(Simplification, OfAThinPlateNeverTouchesItself) {
  // Curved, so that coarse faces of one side would cut the other.
  TriangleSoup plate = gridded_box({-1, -1, 0}, {1, 1, 0.004}, 30);
  for (Point3& p : plate.points) p[2] += 0.3 * std::cos(3 * p[0]) * std::cos(2 * p[1]);
  for (const std::int64_t faces : {2000, 300}) {
    const Simplification result = simplify(plate, faces);
    expect_sound(plate, result);
    EXPECT_LE(static_cast<std::int64_t>(result.surface.triangles.size()), 2000);
  }
  const Simplification bounded = simplify(plate, 0, 0.02);
  expect_sound(plate, bounded);
  EXPECT_LE(bounded.error, 0.02);
  EXPECT_GT(bounded.counts.refused_intersecting, 0);
}

TEST(Simplification, OfNestedSheetsKeepsThemApart) {
  // Shells so close to each other that faces of the sizes asked for would cross.
  TriangleSoup shells = icosphere(4, 1);
  for (const double radius : {0.996, 0.992, 0.988}) {
    shells = joined(
        shells, radius == 0.992 ? icosphere(4, radius) : testing::flipped(icosphere(4, radius)));
  }
  const Simplification result = simplify(shells, 4 * 300);
  expect_sound(shells, result);
  EXPECT_GT(result.counts.refused_intersecting, 0);
}

TEST(Simplification, OfInterlockedTori) {
  TriangleSoup other = torus(80, 40, 1, 0.45);
  for (Point3& p : other.points) p = {p[0] + 1, p[2], p[1]};
  for (Triangle& t : other.triangles) std::swap(t[1], t[2]);  // the swap of axes mirrors
  const TriangleSoup links = joined(torus(80, 40, 1, 0.45), other);
  for (const std::int64_t faces : {2000, 200, 60}) {
    const Simplification result = simplify(links, faces);
    expect_sound(links, result);
  }
}

TEST(Simplification, StopsWhereTheTopologyEndsAndSaysSo) {
  // No closed surface of three components has fewer than 12 faces; a torus needs 14.
  const TriangleSoup parts =
      joined(joined(icosphere(2), icosphere(2, 1, {5, 0, 0})), icosphere(2, 1, {0, 5, 0}));
  const Simplification few = simplify(parts, 2);
  expect_sound(parts, few);
  EXPECT_FALSE(few.reached);
  EXPECT_GE(few.surface.triangles.size(), 12U);
  EXPECT_LE(few.surface.triangles.size(), 60U);
  EXPECT_NE(few.stop.find("2 were asked for"), std::string::npos) << few.stop;

  const TriangleSoup ring = torus(30, 15, 1, 0.4);
  const Simplification handle = simplify(ring, 4);
  expect_sound(ring, handle);
  EXPECT_FALSE(handle.reached);
  EXPECT_GE(handle.surface.triangles.size(), 14U);
}

TEST(Simplification, StopsWhereTheErrorEndsAndSaysSo) {
  const TriangleSoup dense = icosphere(4);
  const Simplification result = simplify(dense, 50, 0.01);
  expect_sound(dense, result);
  EXPECT_FALSE(result.reached);
  EXPECT_GT(result.surface.triangles.size(), 50U);
  EXPECT_LE(result.error, 0.01);
  EXPECT_NE(result.stop.find("error allowed"), std::string::npos) << result.stop;
}

TEST(Simplification, OfNothingAskedForIsTheSurface) {
  const TriangleSoup dense = icosphere(2);
  const Simplification result = simplify(dense, 0);
  EXPECT_EQ(result.surface.triangles, dense.triangles);
  EXPECT_EQ(result.surface.points, dense.points);
  EXPECT_TRUE(result.reached);
  EXPECT_EQ(result.error, 0);
  expect_sound(dense, simplify(dense, 1000000));
}

TEST(Simplification, HasTheSameBitsInEveryRun) {
  const TriangleSoup dense = joined(torus(60, 30, 2, 0.5), icosphere(3));
  const Simplification first = simplify(dense, 500, 0.05);
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
  const Simplification second = simplify(dense, 500, 0.05);
  EXPECT_EQ(first.surface.points, second.surface.points);
  EXPECT_EQ(first.surface.triangles, second.surface.triangles);
  EXPECT_EQ(first.error, second.error);
}

TEST(Simplification, DoesNotDependOnAPowerOfTwo) {
  const TriangleSoup dense = joined(torus(60, 30, 2, 0.5), icosphere(3));
  TriangleSoup large = dense;
  for (Point3& p : large.points) p = 0x1p20 * p;
  const Simplification first = simplify(dense, 500, 0.05);
  const Simplification second = simplify(large, 500, 0x1p20 * 0.05);
  EXPECT_EQ(first.surface.triangles, second.surface.triangles);
  EXPECT_EQ(first.source, second.source);
}

TEST(Simplification, StrayPointsAreLeftOut) {
  TriangleSoup dense = icosphere(3);
  dense.points.insert(dense.points.begin(), Point3{7, 7, 7});
  for (Triangle& t : dense.triangles) t = {t[0] + 1, t[1] + 1, t[2] + 1};
  const Simplification result = simplify(dense, 100);
  expect_sound(dense, result);
  EXPECT_EQ(result.surface.points.size(), 52U);
}

TEST(Simplification, RefusesWhatIsNoClosedManifold) {
  TriangleSoup open = icosphere(2);
  open.triangles.pop_back();
  EXPECT_THROW(simplify(open, 10), InputError);
  TriangleSoup mixed = icosphere(2);
  std::swap(mixed.triangles[5][0], mixed.triangles[5][1]);
  EXPECT_THROW(simplify(mixed, 10), InputError);
  // Two boxes that share a corner.
  TriangleSoup touching = joined(box(), box({1, 1, 1}, {2, 2, 2}));
  for (Triangle& t : touching.triangles) {
    for (std::uint32_t& v : t) v = v == 8 ? 7 : v;
  }
  EXPECT_THROW(simplify(touching, 10), InputError);
  EXPECT_THROW(simplify(box(), -1), UsageError);
  EXPECT_THROW(simplify(box(), 0, -1), UsageError);
  EXPECT_THROW(simplify(box(), 0, std::nan("")), UsageError);
}

struct Listener : Observer {
  void progress(double done) override {
    EXPECT_GE(done, 0);
    EXPECT_LE(done, 1);
    largest = std::max(largest, done);
    ++calls;
  }
  [[nodiscard]] bool cancelled() const override { return calls >= stop_after; }
  double largest = 0;
  int calls = 0;
  int stop_after = 1 << 30;
};

TEST(Simplification, TellsHowFarItIsAndStopsWhenTold) {
  const TriangleSoup dense = icosphere(5);
  Listener listener;
  simplify_surface(dense, {.faces = 100}, listener);
  EXPECT_EQ(listener.largest, 1);
  EXPECT_GT(listener.calls, 5);
  Listener stopper;
  stopper.stop_after = 3;
  EXPECT_THROW(simplify_surface(dense, {.faces = 100}, stopper), Cancelled);
}

}  // namespace
}  // namespace cellocut
