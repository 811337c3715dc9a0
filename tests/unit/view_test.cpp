// Cameras, rays against a plain loop over all faces, and pictures whose pixels are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "cellocut/base/errors.h"
#include "cellocut/view/render.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const ViewFrame kUnitFrame{};  // the mesh's own coordinates

View front_view(const TriangleSoup& mesh, const RenderOptions& options) {
  return render_view(RayScene(mesh, kUnitFrame),
                     canonical_views(options.up, options.perspective)[4], options);
}

// The square of edge length 1 at height z, its front towards +z.
TriangleSoup square(double z) {
  return test::translated(test::tilted_sheet({0, 0, 1}, 1, 1), {0, 0, z});
}

double covered(const View& view) {
  double count = 0;
  for (std::size_t i = 0; i < view.size(); ++i) count += view.covers(i) ? 1 : 0;
  return count;
}

TEST(Cameras, StandOnEverySideWithTheUpAxisUp) {
  for (const UpAxis up : {UpAxis::y, UpAxis::z}) {
    const auto cameras = canonical_views(up, 0);
    for (int k = 0; k < 6; ++k) {
      const Camera& c = cameras[k];
      Point3 side{0, 0, 0};
      side[k / 2] = k % 2 == 0 ? 1 : -1;
      EXPECT_EQ(c.back, side) << c.name;
      EXPECT_EQ(cross(c.right, c.up), c.back) << c.name << ": right-handed";
      EXPECT_EQ(norm(c.up), 1) << c.name;
      const int vertical = up == UpAxis::y ? 1 : 2;
      if (k / 2 != vertical) {
        EXPECT_EQ(c.up[vertical], 1) << c.name;
      } else {
        EXPECT_EQ(c.right, (Point3{1, 0, 0})) << c.name;
      }
    }
    EXPECT_EQ(cameras[0].name, "posx");
    EXPECT_EQ(cameras[5].name, "negz");
  }
}

TEST(Cameras, APerspectivePictureHasItsAngle) {
  const Camera camera = canonical_views(UpAxis::y, 60)[4];
  const Ray left = view_ray(camera, 0, 0.5, 1);
  const Ray right = view_ray(camera, 1, 0.5, 1);
  EXPECT_EQ(left.origin, right.origin);
  const double cosine =
      dot(left.direction, right.direction) / norm(left.direction) / norm(right.direction);
  EXPECT_NEAR(std::acos(cosine), std::numbers::pi / 3, 1e-12);
  EXPECT_EQ(dot(left.direction, camera.back), -1) << "distance counts along the view axis";
  // The edge of the picture is that of the near face of the cube and its margin.
  const Point3 edge = left.origin + (left.origin[2] - 0.5) * left.direction;
  EXPECT_NEAR(edge[0], -kHalfPicture, 1e-12);
}

TEST(ViewFrameOfAMesh, IsItsBox) {
  const ViewFrame frame = view_frame(test::box({1, 2, 3}, {3, 10, 4}));
  EXPECT_EQ(frame.centre, (Point3{2, 6, 3.5}));
  EXPECT_EQ(frame.unit, 8);
  TriangleSoup point;
  point.points = {{1, 1, 1}};
  point.triangles = {{0, 0, 0}};
  EXPECT_THAT([&] { view_frame(point); }, ThrowsMessage<InputError>(HasSubstr("no extent")));
  EXPECT_THAT([] { view_frame({}); }, ThrowsMessage<InputError>(HasSubstr("no faces")));
}

// ---- rays ---------------------------------------------------------------------------------------

// The distance to a triangle along a ray, or infinity: by the signs of three volumes.
double distance_to(const Ray& ray, const Point3& a, const Point3& b, const Point3& c) {
  const Point3 end = ray.origin + ray.direction;
  const double u = six_volumes(ray.origin, end, a, b);
  const double v = six_volumes(ray.origin, end, b, c);
  const double w = six_volumes(ray.origin, end, c, a);
  const bool inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
  const Point3 normal = cross(b - a, c - a);
  const double distance = dot(normal, a - ray.origin) / dot(normal, ray.direction);
  return inside && distance >= 0 ? distance : std::numeric_limits<double>::infinity();
}

TEST(RayScene, FindsTheFirstFaceOfAll) {
  TriangleSoup mesh = test::nested_spheres();
  test::append(mesh, test::two_crossing_boxes());
  const ViewFrame frame = view_frame(mesh);
  const RayScene scene(mesh, frame);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> coordinate(-0.7, 0.7);
  int hits = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const auto point = [&] {
      return Point3{coordinate(random), coordinate(random), coordinate(random)};
    };
    const Ray ray{point(), point()};
    double nearest = std::numeric_limits<double>::infinity();
    for (const Triangle& t : mesh.triangles) {
      nearest = std::min(nearest, distance_to(ray, frame(mesh.points[t[0]]),
                                              frame(mesh.points[t[1]]), frame(mesh.points[t[2]])));
    }
    const auto hit = scene.first_hit(ray);
    ASSERT_EQ(hit.has_value(), std::isfinite(nearest)) << trial;
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->distance, nearest, 1e-9 * (1 + nearest)) << trial;
    EXPECT_EQ(hit->front, dot(hit->normal, ray.direction) < 0);
    EXPECT_TRUE(scene.is_blocked(ray, 1.001 * nearest + 1e-5));
    EXPECT_FALSE(scene.is_blocked(ray, 0.999 * nearest - 1e-5));
  }
  EXPECT_GT(hits, 500);
}

TEST(RayScene, OfCoincidentFacesTheFrontIsSeenAndTheLowestIsNamed) {
  TriangleSoup mesh = test::inside_out(square(0));
  for (int copy = 0; copy < 3; ++copy) test::append(mesh, square(0));
  const RayScene scene(mesh, kUnitFrame);
  for (const double side : {1.0, -1.0}) {
    const auto hit = scene.first_hit({{0.3, 0.1, side}, {0, 0, -side}});
    ASSERT_TRUE(hit.has_value());
    EXPECT_TRUE(hit->front);
    EXPECT_EQ(hit->distance, 1);
    EXPECT_LT(hit->face, side > 0 ? 4U : 2U);
  }
}

TEST(RayScene, FacesWithoutAreaAreNotThere) {
  TriangleSoup line;
  line.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}, {0, 0, 1}};
  const RayScene scene(line, kUnitFrame);
  EXPECT_FALSE(scene.first_hit({{0.5, 0, 1}, {0, 0, -1}}).has_value());
  EXPECT_FALSE(scene.is_blocked({{0.5, 0, 1}, {0, 0, -1}}, 5));
}

TEST(RayScene, RefusesWhatIsTooFarAway) {
  EXPECT_THAT(
      [] {
        RayScene(test::translated(square(0), {1e8, 0, 0}), kUnitFrame);
      },
      ThrowsMessage<InputError>(HasSubstr("a million times larger")));
}

// ---- pictures -----------------------------------------------------------------------------------

TEST(Render, ASquareHasItsSizeDepthAndNormal) {
  // 88 pixels over 1.1: 80 pixels for an edge of 1.
  const View view = front_view(square(0.25), {.resolution = 88});
  ASSERT_EQ(view.size(), 88U * 88U);
  EXPECT_EQ(covered(view), 80 * 80);
  for (int y = 0; y < 88; ++y) {
    for (int x = 0; x < 88; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * 88 + x;
      const bool inside = x >= 4 && x < 84 && y >= 4 && y < 84;
      ASSERT_EQ(view.covers(i), inside) << x << ' ' << y;
      EXPECT_EQ(view.depth[i], inside ? -0.25F : View::kNothing);
      EXPECT_EQ(view.normals[i], (inside ? std::array<float, 3>{0, 0, 1} : std::array<float, 3>{}));
    }
  }
  EXPECT_EQ(view.clay[0], (std::array<std::uint8_t, 3>{255, 255, 255}));
}

TEST(Render, UpIsUpAndRightIsRight) {
  // A small square in the upper right of the view from the front.
  const TriangleSoup mark = test::translated(test::scaled(square(0), 0.25), {0.375, 0.375, 0});
  const View view = front_view(mark, {.resolution = 88});
  for (int y = 0; y < 88; ++y) {
    for (int x = 0; x < 88; ++x) {
      ASSERT_EQ(view.covers(static_cast<std::size_t>(y) * 88 + x),
                x >= 64 && x < 84 && y >= 4 && y < 24);
    }
  }
}

TEST(Render, ASphereCoversItsDisc) {
  const TriangleSoup sphere = test::icosphere(5, 3, {7, 8, 9});
  for (const View& view :
       render_views(sphere, view_frame(sphere), {.resolution = 200, .antialiasing = 1})) {
    EXPECT_NEAR(covered(view), std::numbers::pi * std::pow(0.5 / 1.1 * 200, 2), 100) << view.name;
    for (std::size_t i = 0; i < view.size(); ++i) {
      if (!view.covers(i)) continue;
      const double x = ((static_cast<double>(i % 200) + 0.5) / 200 * 2 - 1) * kHalfPicture;
      const double y = ((static_cast<double>(i / 200) + 0.5) / 200 * 2 - 1) * kHalfPicture;
      const double z = std::sqrt(std::max(0.0, 0.25 - x * x - y * y));
      if (z < 0.1) continue;
      EXPECT_NEAR(view.depth[i], -z, 2e-3);
      EXPECT_NEAR(view.normals[i][0], 2 * x, 0.06);
      EXPECT_NEAR(view.normals[i][1], -2 * y, 0.06);
    }
  }
}

TEST(Render, PerspectiveMakesWhatIsFartherSmaller) {
  const RenderOptions options{.resolution = 110, .perspective = 50, .antialiasing = 1};
  const View near = front_view(square(0.5), options);
  const View far = front_view(square(-0.5), options);
  EXPECT_EQ(covered(near), 100 * 100) << "the near face of the cube fills all but the margin";
  const double focal = kHalfPicture / std::tan(25 / 180.0 * std::numbers::pi);
  const double shrunk = 100 * focal / (focal + 1);
  EXPECT_NEAR(covered(far), shrunk * shrunk, 4 * shrunk);
  EXPECT_NEAR(near.depth[near.size() / 2 + 55], -0.5, 1e-6);
  EXPECT_NEAR(far.depth[far.size() / 2 + 55], 0.5, 1e-6);
}

TEST(Render, BacksOfFacesAreRedAndTheirNormalsTurned) {
  const RenderOptions options{.resolution = 32};
  const View front = front_view(square(0), options);
  const View back = front_view(test::inside_out(square(0)), options);
  const std::size_t middle = 16 * 32 + 16;
  EXPECT_GT(back.clay[middle][0], 1.5 * back.clay[middle][1]);
  EXPECT_LT(front.clay[middle][0], 1.2 * front.clay[middle][1]);
  EXPECT_EQ(back.normals, front.normals);
  EXPECT_EQ(back.depth, front.depth);
}

TEST(Render, EdgesAreAntialiasedInClayAlone) {
  const TriangleSoup turned = test::rotated(test::scaled(square(0), 0.7), {0, 0, 1}, 0.2);
  const auto shades = [&](int antialiasing) {
    const View view = front_view(turned, {.resolution = 64, .antialiasing = antialiasing});
    std::vector<std::array<std::uint8_t, 3>> all = view.clay;
    std::sort(all.begin(), all.end());
    return std::unique(all.begin(), all.end()) - all.begin();
  };
  EXPECT_EQ(shades(1), 2);
  EXPECT_GE(shades(4), 8);
}

TEST(Render, CornersAreDarkerThanPlains) {
  // Two squares at a right angle, seen from the front: the floor near the wall sees less of the
  // sky.
  TriangleSoup corner = test::tilted_sheet({0, 0, 1}, 1, 1);
  test::append(corner, test::translated(test::tilted_sheet({1, 0, 0}, 1, 1), {-0.1, 0, 0.5}));
  const View view = front_view(corner, {.resolution = 64});
  const auto row = static_cast<std::size_t>(32) * 64;
  EXPECT_LT(view.clay[row + 28][1], view.clay[row + 56][1]);
}

TEST(Render, SameBitsForAnyNumberOfThreads) {
  TriangleSoup mesh = test::duplicate_faces();
  test::append(mesh, test::flipped_faces());
  const ViewFrame frame = view_frame(mesh);
  std::vector<std::vector<View>> seen;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    seen.push_back(render_views(mesh, frame, {.resolution = 64}));
  }
  for (const auto& views : seen) {
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_EQ(views[k].clay, seen[0][k].clay);
      EXPECT_EQ(views[k].depth, seen[0][k].depth);
      EXPECT_EQ(views[k].normals, seen[0][k].normals);
    }
  }
}

TEST(Render, TheOrderOfFacesAndAPowerOfTwoChangeNothing) {
  const TriangleSoup mesh = test::sphere_with_hole();
  const auto pictures = [](const TriangleSoup& m) {
    std::vector<std::vector<std::array<std::uint8_t, 3>>> all;
    for (View& view : render_views(m, view_frame(m), {.resolution = 48}))
      all.push_back(std::move(view.clay));
    return all;
  };
  EXPECT_EQ(pictures(mesh), pictures(test::scaled(mesh, 1024)));
  EXPECT_EQ(pictures(mesh).size(), 6U);
}

TEST(Render, RefusesOptionsOutOfRange) {
  EXPECT_THAT([] { RenderOptions{.resolution = 15}.validate(); },
              ThrowsMessage<UsageError>(HasSubstr("16 to 4096")));
  EXPECT_THAT([] { RenderOptions{.resolution = 5000}.validate(); },
              ThrowsMessage<UsageError>(HasSubstr("16 to 4096")));
  for (const double angle : {-5.0, 0.5, 121.0, std::nan("")}) {
    EXPECT_THAT([angle] { RenderOptions{.perspective = angle}.validate(); },
                ThrowsMessage<UsageError>(HasSubstr("1 to 120")));
  }
  EXPECT_THAT([] { RenderOptions{.antialiasing = 9}.validate(); },
              ThrowsMessage<UsageError>(HasSubstr("1 to 8")));
}

}  // namespace
}  // namespace cellocut
