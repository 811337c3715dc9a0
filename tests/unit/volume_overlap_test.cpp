// Inside and outside where lines run through edges and corners, and the overlap of known solids.
#include "cellocut/measure/volume_overlap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cellocut/base/errors.h"
#include "cellocut/base/random_stream.h"
#include "cellocut/measure/nearest_triangle.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"
#include "validity_meshes.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// The winding number by the solid angles of all faces (Van Oosterom and Strackee, 1983): another
// way, without any line. For points that are not on the surface.
double winding_by_angles(const TriangleSoup& mesh, const Point3& p) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Point3 a = mesh.points[t[0]] - p;
    const Point3 b = mesh.points[t[1]] - p;
    const Point3 c = mesh.points[t[2]] - p;
    const double la = norm(a);
    const double lb = norm(b);
    const double lc = norm(c);
    sum += 2 * std::atan2(dot(a, cross(b, c)),
                          la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

bool on_surface(const TriangleSoup& mesh, const Point3& p) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return norm(p - nearest_on_triangle(p, mesh.points[t[0]], mesh.points[t[1]],
                                        mesh.points[t[2]])) < 1e-9;
  });
}

void expect_as_angles(const TriangleSoup& mesh, const std::vector<Point3>& points) {
  const InsideTest inside(mesh);
  ASSERT_TRUE(inside.closed());
  std::size_t compared = 0;
  for (const Point3& p : points) {
    if (on_surface(mesh, p)) continue;
    const double exact = winding_by_angles(mesh, p);
    ++compared;
    const InsideTest::Place place = inside(p);
    EXPECT_EQ(place.winding, std::lround(exact)) << p[0] << ' ' << p[1] << ' ' << p[2];
    EXPECT_EQ(place.inside, std::lround(exact) % 2 != 0);
  }
  EXPECT_GT(compared, points.size() / 5);
}

// Points below and above every corner and every middle of an edge: vertical lines hit these.
std::vector<Point3> over_corners_and_edges(const TriangleSoup& mesh, double height) {
  std::vector<Point3> points;
  points.reserve(4 * 3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Point3& a = mesh.points[t[k]];
      const Point3 middle = 0.5 * (a + mesh.points[t[(k + 1) % 3]]);
      for (const double z : {-0.31 * height, 0.27 * height}) {
        points.push_back({a[0], a[1], z});
        points.push_back({middle[0], middle[1], z});
      }
    }
  }
  return points;
}

TEST(InsideTest, LinesThroughEdgesAndCorners) {
  const TriangleSoup grid = testing::gridded_box({-1, -1, -1}, {1, 1, 1}, 4);
  expect_as_angles(grid, over_corners_and_edges(grid, 1));
  const TriangleSoup torus = test::torus(1, 0.5, 16, 8);
  expect_as_angles(torus, over_corners_and_edges(torus, 1));
  const TriangleSoup upright = test::rotated(torus, {1, 0, 0}, std::numbers::pi / 2);
  expect_as_angles(upright, over_corners_and_edges(upright, 1));
  const TriangleSoup sphere = test::icosphere(2);
  expect_as_angles(sphere, over_corners_and_edges(sphere, 1));
}

TEST(InsideTest, RandomPoints) {
  const RandomStream random(3);
  std::vector<Point3> points;
  for (std::uint64_t i = 0; i < 600; ++i) {
    points.push_back({3 * random(3 * i) - 1.5, 3 * random(3 * i + 1) - 1.5, random(3 * i + 2)});
  }
  expect_as_angles(test::torus(1, 0.4, 20, 10), points);
  expect_as_angles(test::two_crossing_boxes(), points);
  expect_as_angles(test::nested_spheres(), points);
  expect_as_angles(test::inside_out(test::icosphere(2)), points);
}

TEST(InsideTest, OrderAndOrientationOfFacesDoNotMatter) {
  const TriangleSoup mesh = test::torus(1, 0.4, 20, 10);
  const InsideTest plain(mesh);
  const InsideTest shuffled(test::with_faces_flipped(
      test::with_points_permuted(test::with_faces_permuted(mesh, 3), 4), 5));
  const RandomStream random(9);
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Point3 p{3 * random(3 * i) - 1.5, 3 * random(3 * i + 1) - 1.5, random(3 * i + 2) - 0.5};
    EXPECT_EQ(plain(p).inside, shuffled(p).inside);
  }
}

TEST(InsideTest, OddEdges) {
  TriangleSoup box = test::box({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(InsideTest(box).odd_edges(), 0);
  // Every face with points of its own: closed by position.
  TriangleSoup loose;
  for (const Triangle& t : box.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.points.size());
    for (const std::uint32_t corner : t) loose.points.push_back(box.points[corner]);
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_TRUE(InsideTest(loose).closed());
  EXPECT_TRUE(InsideTest(loose)({0.5, 0.5, 0.5}).inside);
  // A fin: the edge where it stands has three faces, and two edges have one.
  TriangleSoup fin = box;
  fin.points.push_back({2, 2, 2});
  fin.triangles.push_back({0, 1, static_cast<std::uint32_t>(box.points.size())});
  EXPECT_EQ(InsideTest(fin).odd_edges(), 3);
  // Both sides of a sheet: closed, and encloses nothing.
  TriangleSoup sheet = test::single_sheet();
  EXPECT_GT(InsideTest(sheet).odd_edges(), 0);
  test::append(sheet, test::inside_out(sheet));
  EXPECT_TRUE(InsideTest(sheet).closed());
  // A face with a repeated corner has one edge, twice.
  box.triangles.push_back({0, 0, 1});
  EXPECT_TRUE(InsideTest(box).closed());
  box.triangles.erase(box.triangles.begin());
  EXPECT_EQ(InsideTest(box).odd_edges(), 3);
}

TEST(InsideTest, Refuses) {
  EXPECT_THAT([] { InsideTest{TriangleSoup{}}; }, ThrowsMessage<InputError>("no faces"));
  TriangleSoup wild = test::box({0, 0, 0}, {1, 1, 1});
  wild.points[0][0] = std::nan("");
  EXPECT_THAT([&] { InsideTest{wild}; }, ThrowsMessage<InputError>(HasSubstr("not finite")));
}

VolumeOverlap overlap_of(const TriangleSoup& mesh, const TriangleSoup& reference,
                         std::uint64_t seed = 1) {
  return measure_volume_overlap(InsideTest(mesh), InsideTest(reference), 40'000, seed);
}

void expect_iou(const VolumeOverlap& found, double exact) {
  ASSERT_TRUE(found.iou().has_value());
  EXPECT_NEAR(*found.iou(), exact, 4 * *found.standard_error() + 1e-12);
  EXPECT_NEAR(*found.standard_error(),
              std::sqrt(exact * (1 - exact) / static_cast<double>(found.in_either)), 1e-3);
}

TEST(VolumeOverlap, OfBoxes) {
  const TriangleSoup cube = test::box({0, 0, 0}, {1, 1, 1});
  expect_iou(overlap_of(test::translated(cube, {0.5, 0, 0}), cube), 1.0 / 3);
  expect_iou(overlap_of(test::translated(cube, {0.25, 0.25, 0.25}), cube), 27.0 / 101);
  expect_iou(overlap_of(test::box({0, 0, 0}, {0.5, 0.5, 0.5}), cube), 0.125);
  const VolumeOverlap nested = overlap_of(cube, test::box({-1, -1, -1}, {2, 2, 2}));
  expect_iou(nested, 1.0 / 27);
  EXPECT_EQ(nested.in_both, nested.in_mesh);
  EXPECT_EQ(nested.in_either, nested.in_reference);
  EXPECT_EQ(nested.in_either, nested.points);
  EXPECT_DOUBLE_EQ(nested.box_volume, 27);
}

TEST(VolumeOverlap, OfTheSameAndOfDisjointSolids) {
  const TriangleSoup sphere = test::icosphere(3);
  EXPECT_EQ(overlap_of(sphere, sphere).iou(), 1);
  EXPECT_EQ(overlap_of(sphere, test::inside_out(sphere)).iou(), 1);
  EXPECT_EQ(overlap_of(sphere, test::translated(sphere, {2.5, 0, 0})).iou(), 0);
  // A share of the box that is known.
  const VolumeOverlap found = overlap_of(sphere, sphere);
  EXPECT_NEAR(static_cast<double>(found.in_mesh) / 40'000, std::numbers::pi / 6, 0.01);
}

TEST(VolumeOverlap, WhatIsEnclosedTwice) {
  const TriangleSoup cube = test::box({0, 0, 0}, {1, 1, 1});
  TriangleSoup twice = cube;
  test::append(twice, test::box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}));
  const VolumeOverlap found = overlap_of(twice, cube);
  expect_iou(found, 0.875);
  EXPECT_EQ(found.enclosed_again_by_mesh, found.in_reference - found.in_mesh);
  EXPECT_GT(found.enclosed_again_by_mesh, 0);
  EXPECT_EQ(found.enclosed_again_by_reference, 0);
}

TEST(VolumeOverlap, NothingInEither) {
  TriangleSoup sheet = test::single_sheet();
  test::append(sheet, test::inside_out(sheet));
  const VolumeOverlap found = overlap_of(sheet, sheet);
  EXPECT_EQ(found.in_either, 0);
  EXPECT_FALSE(found.iou().has_value());
  EXPECT_FALSE(found.standard_error().has_value());
}

TEST(VolumeOverlap, SameCountsForAnyNumberOfThreads) {
  std::vector<VolumeOverlap> results;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(overlap_of(test::torus(1, 0.4, 24, 12), test::icosphere(3)));
  }
  EXPECT_EQ(results[1], results[0]);
  EXPECT_EQ(results[2], results[0]);
  EXPECT_NE(overlap_of(test::torus(1, 0.4, 24, 12), test::icosphere(3), 2), results[0]);
}

TEST(VolumeOverlap, RefusesOpenSurfaces) {
  const TriangleSoup cube = test::box({0, 0, 0}, {1, 1, 1});
  EXPECT_THAT([&] { overlap_of(test::open_bowl(), cube); },
              ThrowsMessage<UsageError>(HasSubstr("not closed")));
  EXPECT_THAT([&] { overlap_of(cube, test::open_bowl()); },
              ThrowsMessage<UsageError>(HasSubstr("not closed")));
}

}  // namespace
}  // namespace cellocut
