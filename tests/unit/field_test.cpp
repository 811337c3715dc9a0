// The fields against the plainest means: distances by brute force, signs by solid angles.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "cellocut/field/distance_field.h"
#include "cellocut/field/flood_sign.h"
#include "cellocut/field/triangle_set.h"
#include "cellocut/surface/signed_distance.h"
#include "hand_made_field.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut::testing {
namespace {

double segment_distance(const Point3& p, const Point3& a, const Point3& b) {
  const double length = squared_norm(b - a);
  const double t = length > 0 ? std::clamp(dot(p - a, b - a) / length, 0.0, 1.0) : 0;
  return norm(p - (a + t * (b - a)));
}

double triangle_distance(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
  double distance =
      std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
  // Barycentric coordinates of the foot of the perpendicular, by Cramer's rule.
  const double uu = dot(b - a, b - a);
  const double uv = dot(b - a, c - a);
  const double vv = dot(c - a, c - a);
  const double up = dot(b - a, p - a);
  const double vp = dot(c - a, p - a);
  const double determinant = uu * vv - uv * uv;
  if (determinant > 1e-14 * uu * vv) {
    const double s = (vv * up - uv * vp) / determinant;
    const double t = (uu * vp - uv * up) / determinant;
    if (s >= 0 && t >= 0 && s + t <= 1) {
      distance = std::min(distance, norm(p - (a + s * (b - a) + t * (c - a))));
    }
  }
  return distance;
}

double soup_distance(const TriangleSoup& soup, const Point3& p) {
  double distance = std::numeric_limits<double>::infinity();
  for (const Triangle& t : soup.triangles) {
    distance = std::min(
        distance, triangle_distance(p, soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]));
  }
  return distance;
}

// By solid angles (van Oosterom and Strackee 1983): 1 inside a closed outward surface, 0 outside.
double winding_number(const TriangleSoup& soup, const Point3& p) {
  double sum = 0;
  for (const Triangle& t : soup.triangles) {
    const Point3 a = soup.points[t[0]] - p;
    const Point3 b = soup.points[t[1]] - p;
    const Point3 c = soup.points[t[2]] - p;
    sum += std::atan2(dot(a, cross(b, c)), norm(a) * norm(b) * norm(c) + dot(a, b) * norm(c) +
                                               dot(b, c) * norm(a) + dot(c, a) * norm(b));
  }
  return sum / (2 * M_PI);
}

// Triangles of all sizes and shapes; one in four is degenerate.
TriangleSoup random_soup(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto point = [&] { return Point3{uniform(random), uniform(random), uniform(random)}; };
  TriangleSoup soup;
  soup.points = {{0, 0, 0}, {1, 0.1, 0.2}, {0.9, 1, 0.7}};
  soup.triangles = {{0, 1, 2}};
  for (int i = 0; i < 12; ++i) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    const Point3 a = point();
    const double size = std::exp2(-static_cast<double>(random() % 7));
    Point3 b = a + size * (point() - Point3{0.5, 0.5, 0.5});
    Point3 c = a + size * (point() - Point3{0.5, 0.5, 0.5});
    if (i % 4 == 0) c = a + uniform(random, -1, 2) * (b - a);  // on a line, up to rounding
    if (i % 8 == 4) b = a;
    if (i == 7) b = c = a;
    soup.points.insert(soup.points.end(), {a, b, c});
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

Frame frame_of(const TriangleSoup& soup, int resolution, double offset) {
  return make_frame(bounding_box(soup), resolution, offset + kBand + 1);
}

SparseField distance_field(const TriangleSoup& soup, int resolution, double offset) {
  return compute_distance_field(soup, frame_of(soup, resolution, offset), offset,
                                silent_observer());
}

// Calls visit(grid point, its place, stored, value) at all grid points of the frame.
template <class Visit>
void for_each_grid_point(const SparseField& field, const Frame& frame, const Visit& visit) {
  const openvdb::tree::ValueAccessor<const FieldTree> accessor(field.grid().tree);
  for (int x = 0; x < frame.extent; ++x) {
    for (int y = 0; y < frame.extent; ++y) {
      for (int z = 0; z < frame.extent; ++z) {
        float value = 0;
        const bool stored = accessor.probeValue(openvdb::Coord(x, y, z), value);
        visit(frame.to_input(
                  {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}),
              stored, value);
      }
    }
  }
}

constexpr double kTolerance = 0x1p-15 + 1e-6;  // rounding to the quantum, and of floats

TEST(DistanceField, EqualsBruteForceAndStoresTheBandExactly) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    for (const double offset : {0.5, 1.0, 6.3}) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed << " offset " << offset);
      const TriangleSoup soup = random_soup(seed);
      const int resolution = 16 + static_cast<int>(seed);
      const Frame frame = frame_of(soup, resolution, offset);
      std::int64_t stored_points = 0;
      const SparseField field = compute_distance_field(soup, frame, offset, silent_observer());
      int wrong = 0;
      for_each_grid_point(field, frame, [&](const Point3& p, bool stored, float value) {
        const double phi = soup_distance(soup, p) / frame.spacing - offset;
        stored_points += stored ? 1 : 0;
        const bool near_the_rim = std::fabs(std::fabs(phi) - kBand) <= kTolerance;
        const bool wrong_place = !near_the_rim && stored != (std::fabs(phi) < kBand);
        const bool wrong_value =
            stored ? std::fabs(value - phi) > kTolerance : value != (phi < 0 ? -kBand : kBand);
        wrong += wrong_place || wrong_value ? 1 : 0;
      });
      EXPECT_EQ(wrong, 0);
      EXPECT_EQ(field.stored_values(), stored_points);
      EXPECT_GT(stored_points, 0);
    }
  }
}

TEST(DistanceField, SamplesByTrilinearInterpolationAndClampsBeyondTheBand) {
  const TriangleSoup soup = test::icosphere(2);
  const SparseField field = distance_field(soup, 24, 6);
  const Frame frame = frame_of(soup, 24, 6);
  std::vector<Point3> at;
  std::vector<double> expected;
  for (const StoredValue& stored : stored_values(field)) {
    at.push_back({static_cast<double>(stored.at[0]), static_cast<double>(stored.at[1]),
                  static_cast<double>(stored.at[2])});
    expected.push_back(stored.value);
  }
  const std::vector<float> values = field.sample(at);
  for (std::size_t i = 0; i < at.size(); ++i) ASSERT_EQ(values[i], expected[i]);
  // Near phi = 0 the interpolation is close to the distance; far away it is the end of the band.
  std::mt19937_64 random(5);
  for (int i = 0; i < 200; ++i) {
    const Point3 direction{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    const Point3 p = (uniform(random, 1.35, 1.65) / norm(direction)) * direction;
    const double phi = soup_distance(soup, p) / frame.spacing - 6;
    const float sampled = field.sample({frame.to_index(p)})[0];
    if (std::fabs(phi) < 0.2) {
      EXPECT_NEAR(sampled, phi, 0.1);
    }
  }
  EXPECT_EQ(field.sample({{0, 0, 0}})[0], kBand);
  EXPECT_EQ(field.sample({frame.to_index({1, 0, 0})})[0], -kBand);
}

// The band is 4 grid steps wide around phi = 0, whatever the offset.
TEST(DistanceField, StoresInProportionToTheAreaOfTheLevelSet) {
  const TriangleSoup soup = test::icosphere(3);
  for (const double offset : {2.5, 5.0, 10.0, 20.0}) {
    const SparseField field = distance_field(soup, 64, offset);
    const double h = 2.0 / 64;
    const auto shell = [h](double radius) {
      const double low = std::max(0.0, radius - kBand * h);
      const double high = radius + kBand * h;
      return 4.0 / 3.0 * M_PI * (high * high * high - low * low * low) / (h * h * h);
    };
    const double inner = 1 - offset * h;
    const double expected = shell(1 + offset * h) + shell(inner);
    EXPECT_NEAR(static_cast<double>(field.stored_values()) / expected, 1, 0.03) << offset;
  }
}

TEST(DistanceField, MemoryGrowsWithTheSquareOfTheResolution) {
  const TriangleSoup soup = test::single_sheet();
  const auto field = [&](int resolution) {
    return distance_field(soup, resolution, resolution / 8.0);
  };
  const SparseField coarse = field(64);
  const SparseField fine = field(256);
  EXPECT_LT(fine.stored_values(), 18 * coarse.stored_values());
  EXPECT_LT(fine.bytes(), 20 * coarse.bytes());
  // Less than a dense grid by far, and not much more than its values.
  EXPECT_LT(fine.bytes(), 12 * 4 * fine.stored_values());
}

TEST(DistanceField, IsTheSameBitsForTheSameSurface) {
  TriangleSoup soup = random_soup(3);
  test::append(soup, test::single_sheet());
  const std::vector<StoredValue> expected = stored_values(distance_field(soup, 32, 1.5));
  const auto same = [&](const TriangleSoup& other) {
    return stored_values(distance_field(other, 32, 1.5)) == expected;
  };
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_TRUE(same(soup)) << threads;
  }
  EXPECT_TRUE(same(test::with_faces_permuted(soup, 1)));
  EXPECT_TRUE(same(test::with_corners_rotated(soup, 2)));
  EXPECT_TRUE(same(test::with_faces_flipped(soup, 3)));
  EXPECT_TRUE(same(test::with_points_permuted(soup, 4)));
  EXPECT_TRUE(same(test::scaled(soup, 0x1p-40)));
  EXPECT_TRUE(same(test::scaled(soup, 0x1p30)));
  TriangleSoup twice = soup;
  test::append(twice, test::inside_out(soup));
  EXPECT_TRUE(same(twice));
  EXPECT_FALSE(same(test::rotated(soup, {1, 2, 3}, 1e-3)));
}

TEST(DistanceField, StopsWhenAskedTo) {
  struct : Observer {
    [[nodiscard]] bool cancelled() const override { return true; }
  } observer;
  const TriangleSoup soup = random_soup(1);
  EXPECT_THROW(compute_distance_field(soup, frame_of(soup, 64, 1), 1, observer), Cancelled);
}

// ---- flood

SparseField flood(const TriangleSoup& soup, int resolution) {
  return compute_flood_signed_distance(soup, frame_of(soup, resolution, 0), silent_observer());
}

void expect_signs(const SparseField& field, const Frame& frame, const TriangleSoup& solid,
                  bool tiles, bool has_inside = true) {
  int wrong = 0;
  int negative = 0;
  for_each_grid_point(field, frame, [&](const Point3& p, bool stored, float value) {
    if (!stored && !tiles) return;
    const double size = std::min<double>(kBand, soup_distance(solid, p) / frame.spacing);
    const bool inside = winding_number(solid, p) > 0.5;
    negative += inside ? 1 : 0;
    // On the surface itself either sign will do.
    if (std::fabs(value - (inside ? -size : size)) > kTolerance) ++wrong;
  });
  EXPECT_EQ(wrong, 0);
  if (has_inside) {
    EXPECT_GT(negative, 0);
  }
}

TEST(FloodSign, ClosedSurfacesHaveAnInside) {
  for (const TriangleSoup& solid :
       {test::box({0, 0, 0}, {1, 0.8, 0.6}), test::icosphere(2), test::torus(1, 0.4, 24, 12)}) {
    for (const int resolution : {12, 33}) {
      expect_signs(flood(solid, resolution), frame_of(solid, resolution, 0), solid, true);
    }
  }
}

TEST(FloodSign, DoesNotCareForOrientation) {
  const TriangleSoup solid = test::torus(1, 0.4, 24, 12);
  const std::vector<StoredValue> expected = stored_values(flood(solid, 32));
  EXPECT_EQ(stored_values(flood(test::with_faces_flipped(solid, 1), 32)), expected);
  EXPECT_EQ(stored_values(flood(test::with_faces_permuted(solid, 1), 32)), expected);
}

TEST(FloodSign, WhatIsWithinAClosedSurfaceIsInside) {
  // Only the outermost of the three counts.
  const TriangleSoup spheres = test::nested_spheres();
  const Frame frame = frame_of(spheres, 32, 0);
  const TriangleSoup outer = test::icosphere(3);
  int wrong = 0;
  for_each_grid_point(flood(spheres, 32), frame, [&](const Point3& p, bool, float value) {
    if (soup_distance(outer, p) > 1e-6 && (value < 0) != (winding_number(outer, p) > 0.5)) ++wrong;
  });
  EXPECT_EQ(wrong, 0);
}

TEST(FloodSign, ALargeHoleLeavesNoInside) {
  // One of a sphere's smallest faces is wider than three steps at this resolution.
  TriangleSoup sphere = test::icosphere(1);
  sphere.triangles.pop_back();
  for (const TriangleSoup& soup : {sphere, test::sphere_with_hole(), test::open_bowl(),
                                   test::single_sheet(), test::moebius_strip()}) {
    const SparseField field = flood(soup, 32);
    int inside = 0;
    for_each_grid_point(field, frame_of(soup, 32, 0),
                        [&](const Point3&, bool, float value) { inside += value < 0 ? 1 : 0; });
    EXPECT_EQ(inside, 0);
  }
}

TEST(FloodSign, IsTheSameForAnyNumberOfThreads) {
  const TriangleSoup soup = test::torus(1, 0.4, 24, 12);
  std::vector<std::vector<StoredValue>> values;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    values.push_back(stored_values(flood(soup, 48)));
  }
  EXPECT_EQ(values[1], values[0]);
  EXPECT_EQ(values[2], values[0]);
}

// ---- signed distance of a boundary

SparseField signed_field(const TriangleSoup& boundary, int resolution) {
  return compute_signed_distance(boundary, frame_of(boundary, resolution, 0), silent_observer());
}

TEST(SignedDistance, HasTheRightSignWhereverItIsStored) {
  TriangleSoup shell = test::icosphere(2);
  test::append(shell, test::inside_out(test::icosphere(2, 0.93)));
  TriangleSoup parts = test::torus(1, 0.3, 20, 9);
  test::append(parts, test::icosphere(1, 0.5));
  for (const TriangleSoup& solid :
       {test::box({0, 0, 0}, {1, 0.5, 0.2}), shell, parts, test::bow_tie_vertex()}) {
    for (const int resolution : {11, 32}) {
      expect_signs(signed_field(solid, resolution), frame_of(solid, resolution, 0), solid, false);
    }
  }
  // Thinner than a grid step: no grid point need be inside.
  const TriangleSoup plate = test::box({0, 0, 0}, {1, 0.5, 0.01});
  expect_signs(signed_field(plate, 32), frame_of(plate, 32, 0), plate, false, false);
}

TEST(SignedDistance, DoesNotCareForOrientationNorForFacesThatMeetTwice) {
  const TriangleSoup solid = test::torus(1, 0.3, 20, 9);
  const std::vector<StoredValue> expected = stored_values(signed_field(solid, 32));
  EXPECT_EQ(stored_values(signed_field(test::with_faces_flipped(solid, 1), 32)), expected);
  // Two equal faces are no boundary: inside and outside as before.
  TriangleSoup more = solid;
  more.triangles.insert(more.triangles.end(), 2, solid.triangles[17]);
  EXPECT_EQ(stored_values(signed_field(more, 32)), expected);
}

TEST(SignedDistance, IsTheSameForAnyNumberOfThreads) {
  const TriangleSoup soup = test::torus(1, 0.4, 24, 12);
  std::vector<std::vector<StoredValue>> values;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    values.push_back(stored_values(signed_field(soup, 48)));
  }
  EXPECT_EQ(values[1], values[0]);
  EXPECT_EQ(values[2], values[0]);
}

// ---- frame

TEST(Frame, KeepsTheMarginAndShiftsTheBoxAgainstTheGrid) {
  const Box3 box{{-1, 2, 5}, {3, 3, 6}};
  const Frame frame = make_frame(box, 64, 3.5);
  EXPECT_EQ(frame.unit, 4);
  EXPECT_EQ(frame.spacing, 4.0 / 64);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = frame.to_index(box.low)[axis];
    const double high = frame.to_index(box.high)[axis];
    EXPECT_GE(low, 3.5);
    EXPECT_LE(high, frame.extent - 1 - 3.5);
    EXPECT_GT(std::fabs(low - std::round(low)), 0.2);
  }
  const Frame larger = make_frame({{-8, 16, 40}, {24, 24, 48}}, 64, 3.5);
  EXPECT_EQ(larger.spacing, 8 * frame.spacing);
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(larger.origin[axis], 8 * frame.origin[axis]);
}

// Whatever the processor: the lanes do what one point at a time does, bit for bit.
TEST(DistanceTriangle, EightPointsAtOnceHaveTheDistancesOfEach) {
  std::mt19937_64 random(1);
  const auto coordinate = [&random] { return 20 * 0x1p-53 * static_cast<double>(random() >> 11); };
  const auto point = [&] { return Point3{coordinate(), coordinate(), coordinate()}; };
  for (int trial = 0; trial < 20000; ++trial) {
    const Point3 a = point();
    const Point3 b = trial % 11 == 0 ? a : point();  // some have no interior, some no length
    const Point3 c = trial % 5 == 0 ? b : (trial % 7 == 0 ? 0.5 * (a + b) : point());
    const DistanceTriangle triangle(a, b, c);
    EightPoints points{};
    for (std::size_t i = 0; i < 8; ++i) {
      const Point3 p = trial % 3 == 0 && i == 0 ? a : point();
      points.x[i] = p[0];
      points.y[i] = p[1];
      points.z[i] = p[2];
    }
    Eight squared{};
    triangle.squared_distances(points, squared);
    for (std::size_t i = 0; i < 8; ++i) {
      const Point3 p{points.x[i], points.y[i], points.z[i]};
      ASSERT_EQ(std::bit_cast<std::uint64_t>(squared[i]),
                std::bit_cast<std::uint64_t>(triangle.squared_distance(p)));
    }
  }
}

}  // namespace
}  // namespace cellocut::testing
