// Hausdorff distances with known answers, and bounds against dense sampling.
#include "cellocut/measure/surface_distance.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

#include "cellocut/measure/nearest_triangle.h"
#include "validity_meshes.h"

namespace cellocut {
namespace {

using testing::box;
using testing::gridded_box;
using testing::icosphere;
using testing::joined;
using testing::torus;

SurfaceDistance measure(const TriangleSoup& first, const TriangleSoup& second,
                        double tolerance = 1e-3) {
  return measure_surface_distance(first, second, tolerance, silent_observer());
}

void expect_distance(const DirectedDistance& found, double expected, double tolerance) {
  EXPECT_LE(found.lower, expected * (1 + 1e-12) + 1e-15);
  EXPECT_GE(found.upper, expected * (1 - 1e-12));
  EXPECT_LE(found.upper, found.lower * (1 + tolerance) + 1e-15);
}

// A square of side 1 at the given height, in 2 n^2 faces.
TriangleSoup square(std::uint32_t n, double height) {
  TriangleSoup soup;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      soup.points.push_back({static_cast<double>(i) / n, static_cast<double>(j) / n, height});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j;
      soup.triangles.push_back({a, a + n + 1, a + n + 2});
      soup.triangles.push_back({a, a + n + 2, a + 1});
    }
  }
  return soup;
}

TEST(SurfaceDistance, OfShiftedPlanes) {
  const SurfaceDistance distance = measure(square(7, 0), square(40, 0.25));
  expect_distance(distance.forward, 0.25, 1e-3);
  expect_distance(distance.backward, 0.25, 1e-3);
}

TEST(SurfaceDistance, OfACubeInACube) {
  const SurfaceDistance distance = measure(box({0, 0, 0}, {1, 1, 1}), box({-1, -1, -1}, {2, 2, 2}));
  EXPECT_NEAR(distance.lower(), std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(distance.upper(), std::sqrt(3.0), 2e-3);
  EXPECT_LE(distance.forward.lower, 1 + 1e-12);
  EXPECT_GE(distance.forward.upper, 1 - 1e-12);
}

// The largest distance is at the centre of the face, where no surface has a point.
TEST(SurfaceDistance, InsideAFace) {
  TriangleSoup face;
  face.points = {{0, 0, 0}, {6, 0, 0}, {3, 5, 0}};
  face.triangles = {{0, 1, 2}};
  TriangleSoup corners;
  for (const Point3& p : face.points) {
    const auto first = static_cast<std::uint32_t>(corners.points.size());
    corners.points.insert(corners.points.end(), {p, p, p});
    corners.triangles.push_back({first, first + 1, first + 2});
  }
  const double a = std::sqrt(34.0);
  const double circumradius = a * a * 6 / (4 * 15.0);
  for (const double tolerance : {1e-1, 1e-3, 1e-6}) {
    const SurfaceDistance distance = measure(face, corners, tolerance);
    expect_distance(distance.forward, circumradius, tolerance);
    EXPECT_EQ(distance.backward.lower, 0);
  }
}

TEST(SurfaceDistance, OfTheSameShapeInOtherFacesIsNothing) {
  const SurfaceDistance flat =
      measure(gridded_box({0, 0, 0}, {1, 2, 3}, 25), box({0, 0, 0}, {1, 2, 3}));
  EXPECT_LE(flat.upper(), 1e-14);
  const SurfaceDistance curved = measure(torus(50, 20, 2, 0.5), torus(50, 20, 2, 0.5));
  EXPECT_LE(curved.upper(), 1e-14);
}

TEST(SurfaceDistance, OfASphereAndAnIcosahedron) {
  const SurfaceDistance distance = measure(icosphere(5), icosphere(0));
  const double inradius = std::sqrt((5 + 2 * std::sqrt(5.0)) / 15);  // circumradius 1
  EXPECT_NEAR(distance.upper(), 1 - inradius, 2e-3);
  EXPECT_LE(distance.upper(), distance.lower() * (1 + 1e-3));
}

TEST(SurfaceDistance, HoldsForDenseSamples) {
  const TriangleSoup first = joined(torus(23, 11, 2, 0.5), icosphere(2, 0.4, {0.3, 0, 0}));
  const TriangleSoup second = joined(torus(9, 5, 2.1, 0.45), icosphere(1, 0.5));
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  const auto sampled = [&](const TriangleSoup& from, const TriangleSoup& to) {
    const NearestTriangle nearest(to);
    double largest = 0;
    for (const Triangle& t : from.triangles) {
      for (int n = 0; n < 200; ++n) {
        double u = share(random);
        double v = share(random);
        if (u + v > 1) {
          u = 1 - u;
          v = 1 - v;
        }
        const Point3& a = from.points[t[0]];
        const Point3 p = a + u * (from.points[t[1]] - a) + v * (from.points[t[2]] - a);
        largest = std::max(largest, nearest(p).distance);
      }
    }
    return largest;
  };
  const SurfaceDistance distance = measure(first, second, 1e-2);
  const double forward = sampled(first, second);
  const double backward = sampled(second, first);
  EXPECT_LE(forward, distance.forward.upper);
  EXPECT_LE(backward, distance.backward.upper);
  EXPECT_LE(std::max(forward, backward), distance.upper());
  EXPECT_GE(std::max(forward, backward), 0.97 * distance.lower());
  EXPECT_LE(distance.upper(), 1.01 * distance.lower());
}

TEST(SurfaceDistance, IsTheSameForAnyNumberOfThreads) {
  const TriangleSoup first = icosphere(4);
  const TriangleSoup second = torus(40, 20, 1, 0.3);
  const SurfaceDistance one = [&] {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, 1);
    return measure(first, second, 1e-2);
  }();
  const SurfaceDistance many = measure(first, second, 1e-2);
  EXPECT_EQ(one.forward.lower, many.forward.lower);
  EXPECT_EQ(one.forward.upper, many.forward.upper);
  EXPECT_EQ(one.backward.lower, many.backward.lower);
  EXPECT_EQ(one.backward.upper, many.backward.upper);
}

TEST(SurfaceDistance, DegenerateFacesCount) {
  TriangleSoup needle = box();
  needle.points.push_back({0.5, 0.5, 4});
  needle.triangles.push_back({4, 8, 8});
  const SurfaceDistance distance = measure(needle, box());
  EXPECT_NEAR(distance.lower(), 3, 1e-12);
  EXPECT_NEAR(measure(box(), needle).lower(), 3, 1e-12);
}

TEST(SurfaceDistance, RefusesNonsense) {
  EXPECT_THROW(measure(box(), TriangleSoup{}), UsageError);
  EXPECT_THROW(measure(TriangleSoup{}, box()), UsageError);
  EXPECT_THROW(measure(box(), box(), 0), UsageError);
  struct Stop : Observer {
    [[nodiscard]] bool cancelled() const override { return true; }
  } stop;
  EXPECT_THROW(measure_surface_distance(box(), box(), 0.01, stop), Cancelled);
}

}  // namespace
}  // namespace cellocut
