// Samples of a surface, and the nearest of a set of points against a search through all of them.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>

#include "cellocut/base/errors.h"
#include "cellocut/measure/nearest_sample.h"
#include "cellocut/measure/sampling.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut {
namespace {

// Triangles of areas 1/2, 0, 3/2 and 2, apart from one another along x.
TriangleSoup four_areas() {
  TriangleSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0},  {0, 1, 0},  {5, 0, 0},  {6, 0, 0},  {7, 0, 0},
                 {9, 0, 0}, {12, 0, 0}, {9, 0, -1}, {20, 0, 0}, {20, 2, 0}, {20, 0, 2}};
  soup.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}};
  return soup;
}

TEST(SampleSurface, ByArea) {
  constexpr std::size_t kCount = 40'000;
  const Samples samples = sample_surface(four_areas(), kCount, 3);
  std::array<int, 4> counts{};
  for (const std::uint32_t f : samples.faces) ++counts[f];
  const std::array<double, 4> shares{0.125, 0, 0.375, 0.5};
  double chi_square = 0;
  for (std::size_t f = 0; f < 4; ++f) {
    const double expected = shares[f] * kCount;
    if (expected > 0) chi_square += std::pow(counts[f] - expected, 2) / expected;
  }
  EXPECT_LT(chi_square, 13.8) << "two degrees of freedom: more once in a thousand seeds";
  EXPECT_EQ(counts[1], 0) << "no area, no samples";
}

TEST(SampleSurface, UniformWithinAFace) {
  constexpr std::size_t kCount = 64'000;
  TriangleSoup soup;
  soup.points = {{1, 2, 3}, {5, 2, 3}, {1, 2, 11}};
  soup.triangles = {{0, 1, 2}};
  const Samples samples = sample_surface(soup, kCount, 8);
  // A triangle cut by lines parallel to its sides into 64 equal ones.
  std::array<int, 128> counts{};
  for (const Point3& p : samples.points) {
    const double u = (p[0] - 1) / 4 * 8;
    const double v = (p[2] - 3) / 8 * 8;
    EXPECT_EQ(p[1], 2);
    ASSERT_GE(u, 0);
    ASSERT_GE(v, 0);
    ASSERT_LE(u + v, 8 + 1e-12);
    const int i = std::min(static_cast<int>(u), 7);
    const int j = std::min(static_cast<int>(v), 7);
    const bool upper = (u - i) + (v - j) > 1;
    ++counts[2 * (8 * i + j) + (upper ? 1 : 0)];
  }
  double chi_square = 0;
  int parts = 0;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; i + j < 8; ++j) {
      for (int upper = 0; upper < (i + j < 7 ? 2 : 1); ++upper, ++parts) {
        const int count = counts[2 * (8 * i + j) + upper];
        chi_square += std::pow(count - 1000.0, 2) / 1000;
      }
    }
  }
  EXPECT_EQ(parts, 64);
  EXPECT_LT(chi_square, 103.4) << "63 degrees of freedom: more once in a thousand seeds";
}

TEST(SampleSurface, LiesOnItsFaceWithItsNormal) {
  const TriangleSoup soup = test::icosphere(1, 2);
  const Samples samples = sample_surface(soup, 500, 1);
  const std::vector<Point3> normals = unit_normals(soup);
  ASSERT_EQ(samples.size(), 500U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Point3& normal = normals[samples.faces[i]];
    EXPECT_EQ(samples.normals[i], normal);
    EXPECT_NEAR(norm(normal), 1, 1e-15);
    EXPECT_GT(dot(normal, samples.points[i]), 0) << "outward, by the order of the corners";
    const Point3& corner = soup.points[soup.triangles[samples.faces[i]][0]];
    EXPECT_NEAR(dot(samples.points[i] - corner, normal), 0, 1e-14);
  }
}

TEST(SampleSurface, FirstSamplesDoNotDependOnTheCountNorOneSeedOnAnother) {
  const TriangleSoup soup = test::icosphere(1);
  const Samples few = sample_surface(soup, 10, 5);
  const Samples many = sample_surface(soup, 1000, 5);
  EXPECT_TRUE(std::equal(few.points.begin(), few.points.end(), many.points.begin()));
  std::set<Point3> seen(many.points.begin(), many.points.end());
  for (const std::uint64_t seed : {0ULL, 4ULL, 6ULL, ~0ULL}) {
    for (const Point3& p : sample_surface(soup, 1000, seed).points) seen.insert(p);
  }
  EXPECT_EQ(seen.size(), 5000U);
}

TEST(SampleSurface, KnownNumbers) {
  // By an implementation of SplitMix64 in another language: a change of these changes every figure.
  TriangleSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}};
  const Samples samples = sample_surface(soup, 2, 1);
  EXPECT_EQ(samples.points[0], (Point3{0x1.e31ad9d27ad9ep-1, 0x1.72becda64fd10p-5, 0}));
  EXPECT_EQ(samples.points[1], (Point3{0x1.c0bf6eefc92b8p-3, 0x1.8c7e0c58b861cp-1, 0}));
}

TEST(SampleSurface, NoArea) {
  EXPECT_THROW(sample_surface(TriangleSoup{}, 10, 1), InputError);
  TriangleSoup line;
  line.points = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  line.triangles = {{0, 1, 2}, {0, 0, 1}};
  EXPECT_THROW(sample_surface(line, 10, 1), InputError);
  EXPECT_EQ(unit_normals(line)[0], (Point3{0, 0, 0}));
}

// The lowest index among the nearest.
NearestSample::Result search_all(const std::vector<Point3>& points, const Point3& p) {
  NearestSample::Result best;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const double squared = squared_norm(points[i] - p);
    if (squared < least) {
      least = squared;
      best = {i, std::sqrt(squared)};
    }
  }
  return best;
}

void expect_as_search(const std::vector<Point3>& points, const std::vector<Point3>& queries) {
  const NearestSample nearest(points);
  for (const Point3& p : queries) {
    const NearestSample::Result found = nearest(p);
    const NearestSample::Result wanted = search_all(points, p);
    ASSERT_EQ(found.index, wanted.index);
    ASSERT_EQ(found.distance, wanted.distance);  // the same bits
  }
}

TEST(NearestSample, IsThatOfASearchThroughAll) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto draw = [&](std::size_t count, double scale, const Point3& offset) {
    std::vector<Point3> points(count);
    for (Point3& p : points) {
      for (int axis = 0; axis < 3; ++axis) p[axis] = offset[axis] + scale * coordinate(random);
    }
    return points;
  };
  for (const double scale : {1e-40, 1.0, 1e60}) {
    const Point3 offset{scale, 40 * scale, -scale};
    expect_as_search(draw(2000, scale, offset), draw(500, 2 * scale, offset));
  }
  // Far closer together than single precision can tell, and seen from far away.
  expect_as_search(draw(300, 1e-9, {1, 1, 1}), draw(300, 1e-9, {1, 1, 1}));
  std::vector<Point3> clusters = draw(300, 1e-9, {1, 1, 1});
  for (const Point3& p : draw(300, 1e-9, {0, 0, 0})) clusters.push_back(p);
  expect_as_search(clusters, draw(300, 1e-8, {1, 1, 1}));
  expect_as_search(clusters, draw(300, 1e9, {1, 1, 1}));
}

TEST(NearestSample, LowestIndexAmongEquals) {
  std::vector<Point3> grid;
  grid.reserve(3 * 343);
  for (int i = 0; i < 3 * 343; ++i) {  // every point three times
    grid.push_back({0.1 * (i % 7), 0.1 * (i / 7 % 7), 0.1 * (i / 49 % 7)});
  }
  std::vector<Point3> between;
  between.reserve(216);
  for (int i = 0; i < 216; ++i) {
    const int layer = i / 36;
    between.push_back({0.1 * (i % 6) + 0.05, 0.1 * (i / 6 % 6) + 0.05, 0.1 * layer + 0.05});
  }
  expect_as_search(grid, between);
  expect_as_search(grid, grid);
  expect_as_search({{2, 2, 2}, {2, 2, 2}}, {{2, 2, 2}, {3, 2, 2}});
}

TEST(NearestSample, OfNothingIsNone) {
  EXPECT_EQ(NearestSample({})({0, 0, 0}).index, NearestSample::kNone);
}

TEST(Measure, SameSamplesForAnyNumberOfThreads) {
  const TriangleSoup soup = test::icosphere(4);
  std::vector<Samples> results;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(sample_surface(soup, 20'000, 9));
  }
  for (const Samples& other : results) {
    EXPECT_EQ(other.points, results[0].points);
    EXPECT_EQ(other.faces, results[0].faces);
  }
}

}  // namespace
}  // namespace cellocut
