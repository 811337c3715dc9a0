// The virtual scan sees the outer surface, all of it, and nothing behind it.
#include "cellocut/view/scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "cellocut/base/errors.h"
#include "cellocut/base/random_stream.h"
#include "cellocut/view/ray_scene.h"
#include "cellocut/view/thinning.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"
#include "support/temporary_folder.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const ScanOptions kFew{.viewpoints = 60, .rays = 3000, .points = 3000};

TEST(Scan, OfNestedSpheresIsTheOuterOne) {
  TriangleSoup mesh = test::icosphere(3);
  test::append(mesh, test::icosphere(3, 0.97));
  test::append(mesh, test::inside_out(test::icosphere(2, 0.5)));
  const Scan scan = scan_outside(mesh, kFew);
  ASSERT_GT(scan.cloud.points.size(), 2900U);
  ASSERT_EQ(scan.cloud.normals.size(), scan.cloud.points.size());
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    // Flat faces lie a little within the sphere: by 0.005 at four divisions.
    EXPECT_NEAR(norm(scan.cloud.points[i]), 0.9975, 0.004);
    EXPECT_NEAR(norm(scan.cloud.normals[i]), 1, 1e-12);
    EXPECT_GT(dot(scan.cloud.points[i], scan.cloud.normals[i]), 0.9);
  }
}

TEST(Scan, OfABoxFullOfClutterIsTheBox) {
  TriangleSoup mesh = test::box({-1, -1, -1}, {1, 1, 1});
  const RandomStream random(4);
  for (std::uint64_t i = 0; i < 30; ++i) {
    const Point3 p{1.9 * random(3 * i) - 0.95, 1.9 * random(3 * i + 1) - 0.95,
                   1.9 * random(3 * i + 2) - 0.95};
    test::append(mesh, test::icosphere(1, 0.04, p));
  }
  test::append(mesh, test::box({-0.999, -0.999, -0.999}, {0.999, 0.999, 0.999}));
  const Scan scan = scan_outside(mesh, kFew);
  for (const Point3& p : scan.cloud.points) {
    EXPECT_NEAR(std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])}), 1, 1e-9);
  }
  // Evenly: a sixth on each side, within some percent.
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto count =
          std::count_if(scan.cloud.normals.begin(), scan.cloud.normals.end(),
                        [&](const Point3& n) { return std::fabs(n[axis] - side) < 1e-9; });
      EXPECT_NEAR(static_cast<double>(count) / static_cast<double>(scan.cloud.points.size()),
                  1.0 / 6, 0.01);
    }
  }
}

TEST(Scan, RaysAtEdgesAndCornersDoNotSlipThrough) {
  // From outside, exactly at the corners and at places on the edges of a closed surface.
  const TriangleSoup sphere = test::rotated(test::icosphere(3), {1, 2, 3}, 0.7);
  TriangleSoup mesh = sphere;
  test::append(mesh, test::icosphere(2, 0.9));
  const RayScene scene(mesh, ViewFrame{});
  const RandomStream random(8);
  std::uint64_t n = 0;
  std::size_t within = 0;
  for (const Triangle& t : sphere.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Point3& a = sphere.points[t[k]];
      const Point3& b = sphere.points[t[(k + 1) % 3]];
      for (const double share : {0.0, 0.5, random(n++)}) {
        const Point3 target = a + share * (b - a);
        const Point3 eye = 3.0 * target + Point3{random(n++), random(n++), random(n++)};
        const Point3 towards = target - eye;
        const auto hit = scene.first_hit({eye, (1 / norm(towards)) * towards});
        if (hit && norm(eye + (hit->distance / norm(towards)) * towards) < 0.95) ++within;
      }
    }
  }
  EXPECT_EQ(within, 0U);
}

TEST(Scan, OfASheetHasBothSides) {
  const Point3 normal{0.3, -0.5, 0.8};
  const Scan scan = scan_outside(test::tilted_sheet(normal, 1, 4), kFew);
  const auto front = std::count_if(scan.cloud.normals.begin(), scan.cloud.normals.end(),
                                   [&](const Point3& n) { return dot(n, normal) > 0; });
  const auto all = static_cast<double>(scan.cloud.points.size());
  EXPECT_GT(all, 2900);
  EXPECT_NEAR(static_cast<double>(front) / all, 0.5, 0.02);
}

TEST(Scan, TheOrientationOfFacesDoesNotMatter) {
  const TriangleSoup mesh = test::torus(1, 0.4, 24, 12);
  const Scan plain = scan_outside(mesh, kFew);
  const Scan flipped = scan_outside(test::with_faces_flipped(mesh, 3), kFew);
  ASSERT_EQ(flipped.cloud.points.size(), plain.cloud.points.size());
  for (std::size_t i = 0; i < plain.cloud.points.size(); ++i) {
    EXPECT_LT(norm(flipped.cloud.points[i] - plain.cloud.points[i]), 1e-6);
  }
}

TEST(Scan, SameBitsForAnyNumberOfThreads) {
  std::vector<PointCloud> results;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(scan_outside(test::torus(1, 0.4, 24, 12), kFew).cloud);
  }
  for (const std::size_t i : {1U, 2U}) {
    EXPECT_EQ(results[i].points, results[0].points);
    EXPECT_EQ(results[i].normals, results[0].normals);
  }
  ScanOptions other = kFew;
  other.seed = 2;
  EXPECT_NE(scan_outside(test::torus(1, 0.4, 24, 12), other).cloud.points, results[0].points);
}

TEST(Scan, SpacingIsKept) {
  ScanOptions options = kFew;
  options.spacing = 0.1;
  const Scan scan = scan_outside(test::icosphere(3), options);
  const auto& points = scan.cloud.points;
  double nearest = 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (dot(scan.cloud.normals[i], scan.cloud.normals[j]) > 0) {
        nearest = std::min(nearest, norm(points[i] - points[j]));
      }
    }
  }
  EXPECT_GE(nearest, 0.1 * scan.unit * (1 - 1e-9));
  // Maximal: discs of the spacing cover the sphere, discs of half of it fit on it.
  EXPECT_GT(static_cast<double>(points.size()), 4 / (0.2 * 0.2));
  EXPECT_LT(static_cast<double>(points.size()), 4 / (0.1 * 0.1));
}

TEST(Scan, FewerHitsThanPointsKeepsAll) {
  const Scan scan = scan_outside(test::icosphere(2), {.viewpoints = 3, .rays = 50});
  EXPECT_EQ(scan.cloud.points.size(), scan.hits - scan.grazing);
  EXPECT_EQ(scan.spacing, 0);
  EXPECT_EQ(scan.rays, 150U);
}

TEST(Scan, Refuses) {
  const TriangleSoup good = test::icosphere(1);
  TriangleSoup point = good;
  for (Point3& p : point.points) p = {1, 2, 3};
  TriangleSoup line = good;
  for (Point3& p : line.points) p = {p[0], 0, 0};
  EXPECT_THAT([&] { scan_outside(point, kFew); },
              ThrowsMessage<InputError>(HasSubstr("no extent")));
  EXPECT_THAT([&] { scan_outside(line, kFew); },
              ThrowsMessage<InputError>(HasSubstr("nothing is seen")));
  EXPECT_THAT([&] { scan_outside(TriangleSoup{}, kFew); }, ThrowsMessage<InputError>("no faces"));
  EXPECT_THROW(scan_outside(good, {.viewpoints = 0}), UsageError);
  EXPECT_THROW(scan_outside(good, {.rays = 0}), UsageError);
  EXPECT_THROW(scan_outside(good, {.points = 0}), UsageError);
  EXPECT_THROW(scan_outside(good, {.spacing = 2}), UsageError);
  EXPECT_THROW(scan_outside(good, {.viewpoints = 100'000, .rays = 100'000}), UsageError);
}

TEST(Scan, PointsAreReadBackAsTheyWere) {
  const Scan scan = scan_outside(test::icosphere(2), kFew);
  const test::TemporaryFolder folder;
  const PointCloud read = read_point_cloud(folder.file("scan.ply", encode_point_cloud(scan.cloud)));
  EXPECT_EQ(read.points, scan.cloud.points);
  ASSERT_EQ(read.normals.size(), scan.cloud.normals.size());
  for (std::size_t i = 0; i < read.normals.size(); ++i) {
    EXPECT_LT(norm(read.normals[i] - scan.cloud.normals[i]), 1e-6);
  }
  const PointCloud bare{scan.cloud.points, {}};
  EXPECT_TRUE(read_point_cloud(folder.file("bare.ply", encode_point_cloud(bare))).normals.empty());
}

TEST(Thinning, OppositeNormalsDoNotSeeEachOther) {
  const PointCloud cloud{{{0, 0, 0}, {0, 0, 0}, {0.01, 0, 0}, {1, 0, 0}},
                         {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}, {0, 0, 1}}};
  const std::vector<std::uint32_t> kept = thin_to_spacing(cloud, 0.1, 1);
  EXPECT_EQ(kept.size(), 3U);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(thin_to_count(cloud, 4, 1).kept.size(), 4U);
  EXPECT_EQ(thin_to_count(cloud, 4, 1).spacing, 0);
  EXPECT_LE(thin_to_count(cloud, 3, 1).kept.size(), 3U);
}

}  // namespace
}  // namespace cellocut
