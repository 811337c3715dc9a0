// Completed patches against the shapes that they should go back to. Lengths are in grid steps.
#include "cellocut/surface/fairing.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "backends/backends.h"
#include "cellocut/pipeline.h"
#include "solvers/solvers.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut {
namespace {

constexpr double kTau = 0.1;  // how far the surface keeps from the input

double noise(std::mt19937_64& random, double amplitude) {
  return amplitude * (2 * (static_cast<double>(random() >> 11U) / 9007199254740992.0) - 1);
}

struct Scene {
  TriangleSoup surface;
  std::vector<std::uint8_t> supported;
  TriangleSoup input;

  [[nodiscard]] FairingResult fair(const FairingOptions& options = {}, double scale = 1) const {
    return fair_completed(surface, supported, NearestTriangle(input), scale, scale * kTau, options,
                          silent_observer());
  }
};

void add_quad(TriangleSoup& soup, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              std::uint32_t d) {
  soup.triangles.push_back({a, b, c});
  soup.triangles.push_back({a, c, d});
}

void erase_faces_near(TriangleSoup& soup, const Point3& centre, double radius) {
  std::erase_if(soup.triangles, [&](const Triangle& t) {
    const Point3 middle = (1.0 / 3) * (soup.points[t[0]] + soup.points[t[1]] + soup.points[t[2]]);
    return norm(middle - centre) < radius;
  });
}

struct Hole {
  Point3 centre;
  double radius;
};

// A slab with a side of `side` steps, its top at z = 0 with vertices one step apart. Around each
// hole the vertices are completed: lifted to a hill with steps, and shaken. The input is the top
// without the holes, kTau below it.
Scene plate_with_holes(int side, const std::vector<Hole>& holes, double height) {
  Scene scene;
  TriangleSoup& soup = scene.surface;
  const auto at = [side](int x, int y, int layer) {
    return static_cast<std::uint32_t>((layer * (side + 1) + y) * (side + 1) + x);
  };
  for (const double z : {0.0, -10.0}) {
    for (int y = 0; y <= side; ++y) {
      for (int x = 0; x <= side; ++x) {
        soup.points.push_back({static_cast<double>(x), static_cast<double>(y), z});
      }
    }
  }
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      add_quad(soup, at(x, y, 0), at(x + 1, y, 0), at(x + 1, y + 1, 0), at(x, y + 1, 0));
    }
  }
  scene.input = soup;  // so far the top alone has faces
  for (Point3& p : scene.input.points) p[2] -= kTau;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      add_quad(soup, at(x, y, 1), at(x, y + 1, 1), at(x + 1, y + 1, 1), at(x + 1, y, 1));
    }
  }
  for (int i = 0; i < side; ++i) {
    add_quad(soup, at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 0, 0), at(i, 0, 0));
    add_quad(soup, at(i + 1, side, 1), at(i, side, 1), at(i, side, 0), at(i + 1, side, 0));
    add_quad(soup, at(0, i + 1, 1), at(0, i, 1), at(0, i, 0), at(0, i + 1, 0));
    add_quad(soup, at(side, i, 1), at(side, i + 1, 1), at(side, i + 1, 0), at(side, i, 0));
  }

  scene.supported.assign(soup.points.size(), 1);
  std::mt19937_64 random(3);
  for (const Hole& hole : holes) {
    erase_faces_near(scene.input, hole.centre, hole.radius + 0.5);
    for (std::uint32_t v = 0; v < at(0, 0, 1); ++v) {
      Point3& p = soup.points[v];
      const double distance = norm(p - hole.centre);
      if (distance > hole.radius) continue;
      scene.supported[v] = 0;
      const double hill = height * (1 - distance / hole.radius);
      p = p + Point3{noise(random, 0.2), noise(random, 0.2),
                     std::ceil(2 * hill) / 2 + noise(random, 0.2)};
    }
  }
  return scene;
}

double largest_height(const std::vector<Point3>& points) {
  double height = 0;
  for (const Point3& p : points) {
    if (p[2] > -5) height = std::max(height, std::fabs(p[2]));
  }
  return height;
}

TEST(Fairing, AHoleInAPlaneClosesFlat) {
  const Scene scene = plate_with_holes(60, {{{30, 30, 0}, 15}}, 4);
  const FairingResult result = scene.fair();
  EXPECT_GT(largest_height(scene.surface.points), 3.5);
  EXPECT_LT(largest_height(result.points), 0.01);
  EXPECT_EQ(result.patches, 1);
  EXPECT_EQ(result.patches_left, 0);
  EXPECT_GT(result.vertices_moved, 600);
  EXPECT_LT(result.bending_after, 1e-3 * result.bending_before);
  EXPECT_NEAR(result.largest_move, 4.2, 0.5);
}

TEST(Fairing, MovesNothingBeyondTheMargin) {
  const Scene scene = plate_with_holes(60, {{{30, 30, 0}, 10}}, 3);
  FairingOptions options;
  options.margin_rings = 4;
  const FairingResult result = scene.fair(options);
  std::int64_t moved = 0;
  for (std::size_t v = 0; v < result.points.size(); ++v) {
    if (result.points[v] == scene.surface.points[v]) continue;
    ++moved;
    // A ring of the lattice reaches one step further, along diagonals sqrt(2).
    EXPECT_LT(std::hypot(result.points[v][0] - 30, result.points[v][1] - 30), 10 + 4 * 1.42);
  }
  EXPECT_EQ(moved, result.vertices_moved);
}

TEST(Fairing, LeavesASurfaceWithoutCompletedVertices) {
  Scene scene = plate_with_holes(20, {}, 0);
  scene.surface.points[3] = {3.3, 0.1, 0.2};
  const FairingResult result = scene.fair();
  EXPECT_EQ(result.points, scene.surface.points);
  EXPECT_EQ(result.patches, 0);
  EXPECT_EQ(result.vertices_moved, 0);
}

TEST(Fairing, LeavesAComponentThatIsAllCompleted) {
  Scene scene;
  scene.surface = test::icosphere(2, 5);
  scene.supported.assign(scene.surface.points.size(), 0);
  scene.input = test::icosphere(0, 1, {20, 0, 0});
  const FairingResult result = scene.fair();
  EXPECT_EQ(result.points, scene.surface.points);
  EXPECT_EQ(result.patches, 1);
  EXPECT_EQ(result.patches_left, 1);
}

// A sphere of that radius whose cap up to that angle is replaced: flat, or in steps on top of that.
Scene sphere_with_flat_cap(double radius, double angle, double step_height) {
  Scene scene;
  scene.surface = test::icosphere(6, radius);
  scene.input = test::icosphere(6, radius - kTau);
  const double plane = radius * std::cos(angle);
  std::erase_if(scene.input.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return scene.input.points[v][2] > (radius - kTau) * std::cos(angle);
    });
  });
  for (Point3& p : scene.surface.points) {
    scene.supported.push_back(p[2] > plane ? 0 : 1);
    if (p[2] <= plane) continue;
    const int stair = static_cast<int>(std::floor(0.3 * p[0]) + std::floor(0.2 * p[1]));
    p[2] = plane + step_height * (stair & 1);
  }
  return scene;
}

struct Deviation {
  double largest = 0;
  double root_mean_square = 0;
};

// Of completed (or else supported) vertices from the sphere around the origin.
Deviation from_sphere(const std::vector<Point3>& points, const std::vector<std::uint8_t>& supported,
                      double radius, bool completed = true) {
  Deviation deviation;
  std::int64_t count = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if ((supported[v] == 0) != completed) continue;
    const double away = std::fabs(norm(points[v]) - radius);
    deviation.largest = std::max(deviation.largest, away);
    deviation.root_mean_square += away * away;
    ++count;
  }
  deviation.root_mean_square =
      std::sqrt(deviation.root_mean_square / static_cast<double>(std::max<std::int64_t>(count, 1)));
  return deviation;
}

struct Cap {
  double angle;
  double step_height;
  double gain;  // by which the largest deviation has to shrink
};

TEST(Fairing, AFlatCapReturnsToTheSphere) {
  constexpr double kRadius = 40;
  for (const Cap& cap :
       {Cap{0.3, 0, 20}, Cap{0.5, 0, 50}, Cap{0.5, 1, 50}, Cap{1.0, 0, 40}, Cap{1.0, 2, 30}}) {
    SCOPED_TRACE(testing::Message() << "angle " << cap.angle << " steps " << cap.step_height);
    const Scene scene = sphere_with_flat_cap(kRadius, cap.angle, cap.step_height);
    const FairingResult result = scene.fair();
    const Deviation before = from_sphere(scene.surface.points, scene.supported, kRadius);
    const Deviation after = from_sphere(result.points, scene.supported, kRadius);
    std::cout << "angle " << cap.angle << ", steps of " << cap.step_height << ": deviation "
              << before.largest << " (rms " << before.root_mean_square << ") -> " << after.largest
              << " (rms " << after.root_mean_square << ")\n";
    EXPECT_LT(after.largest * cap.gain, before.largest);
    EXPECT_LT(from_sphere(result.points, scene.supported, kRadius, false).largest, 0.15);
    EXPECT_LT(result.bending_after, result.bending_before);
  }
}

// A membrane would draw it in to a neck.
TEST(Fairing, ABandOfACylinderKeepsItsRadius) {
  constexpr int kAround = 64;
  constexpr int kAlong = 70;
  constexpr double kRadius = 10;
  Scene scene;
  TriangleSoup& soup = scene.surface;
  const auto at = [](int i, int j) {
    return static_cast<std::uint32_t>(j * kAround + i % kAround);
  };
  for (int j = 0; j <= kAlong; ++j) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5 * (j & 1)) / kAround;
      const bool completed = j > 25 && j < 45;
      // Dented where it was completed, by steps of one grid step.
      const double radius = kRadius - (completed ? 1 + ((i / 7 + j / 5) & 1) : 0);
      soup.points.push_back({radius * std::cos(angle), radius * std::sin(angle), 1.0 * j});
      scene.supported.push_back(completed ? 0 : 1);
    }
  }
  for (int j = 0; j < kAlong; ++j) {
    for (int i = 0; i < kAround; ++i) {
      add_quad(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  scene.input = soup;
  for (Point3& p : scene.input.points) {
    const double shrunk = (kRadius - kTau) / std::hypot(p[0], p[1]);
    p = {shrunk * p[0], shrunk * p[1], p[2]};
  }
  std::erase_if(scene.input.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](auto v) { return scene.supported[v] == 0; });
  });
  for (const int j : {0, kAlong}) {
    const auto middle = static_cast<std::uint32_t>(soup.points.size());
    soup.points.push_back({0, 0, 1.0 * j});
    scene.supported.push_back(1);
    for (int i = 0; i < kAround; ++i) {
      if (j == 0) {
        soup.triangles.push_back({middle, at(i + 1, j), at(i, j)});
      } else {
        soup.triangles.push_back({middle, at(i, j), at(i + 1, j)});
      }
    }
  }
  const FairingResult result = scene.fair();
  double off = 0;
  for (std::size_t v = 0; v < result.points.size(); ++v) {
    if (scene.supported[v] != 0) continue;
    off = std::max(off, std::fabs(std::hypot(result.points[v][0], result.points[v][1]) - kRadius));
  }
  EXPECT_LT(off, 0.25);
}

// A square of input at z = 1 below a hill that would go flat through it.
TEST(Fairing, NoVertexPassesThroughTheInput) {
  Scene scene = plate_with_holes(60, {{{30, 30, 0}, 15}}, 6);
  const auto first = static_cast<std::uint32_t>(scene.input.points.size());
  for (const Point3& p :
       {Point3{26, 26, 1}, Point3{34, 26, 1}, Point3{34, 34, 1}, Point3{26, 34, 1}}) {
    scene.input.points.push_back(p);
  }
  add_quad(scene.input, first, first + 1, first + 2, first + 3);
  const NearestTriangle nearest(scene.input);
  const FairingResult result = scene.fair();
  int above = 0;
  for (std::size_t v = 0; v < result.points.size(); ++v) {
    const Point3& from = scene.surface.points[v];
    const Point3& to = result.points[v];
    if (from == to) continue;
    if ((from[2] > 1) != (to[2] > 1)) {
      const double t = (1 - from[2]) / (to[2] - from[2]);
      const Point3 p = from + t * (to - from);
      EXPECT_FALSE(p[0] >= 26 && p[0] <= 34 && p[1] >= 26 && p[1] <= 34);
    }
    EXPECT_GE(nearest(to).distance, std::min(0.37 * kTau, 0.5 * nearest(from).distance));
    if (to[0] > 27 && to[0] < 33 && to[1] > 27 && to[1] < 33) {
      EXPECT_GT(to[2], 1);
      EXPECT_LT(to[2], 3) << "it should come down to the sheet";
      ++above;
    }
  }
  EXPECT_GT(above, 10);
}

TEST(Fairing, SameBitsForAnyNumberOfThreads) {
  const Scene scene =
      plate_with_holes(70, {{{15, 15, 0}, 6}, {{50, 20, 0}, 8}, {{30, 52, 0}, 9}}, 3);
  const auto fair_with = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return scene.fair();
  };
  const FairingResult one = fair_with(1);
  const FairingResult two = fair_with(2);
  EXPECT_EQ(one.patches, 3);
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(one.bending_after, two.bending_after);
  EXPECT_EQ(one.vertices_stopped, two.vertices_stopped);
}

TEST(Fairing, PatchesDoNotKnowOfEachOther) {
  const Scene both = plate_with_holes(70, {{{15, 15, 0}, 6}, {{50, 50, 0}, 8}}, 3);
  Scene first = both;
  for (std::size_t v = 0; v < first.supported.size(); ++v) {
    if (first.surface.points[v][0] > 35) first.supported[v] = 1;
  }
  const FairingResult together = both.fair();
  const FairingResult alone = first.fair();
  EXPECT_EQ(alone.patches, 1);
  for (std::size_t v = 0; v < alone.points.size(); ++v) {
    if (both.surface.points[v][0] < 35) {
      EXPECT_EQ(alone.points[v], together.points[v]);
    }
  }
}

TEST(Fairing, FollowsTheUnitOfLength) {
  const Scene scene = sphere_with_flat_cap(40, 0.4, 0.5);
  const FairingResult plain = scene.fair();
  for (const double scale : {std::ldexp(1.0, -40), std::ldexp(1.0, 30)}) {
    Scene scaled = scene;
    scaled.surface = test::scaled(scene.surface, scale);
    scaled.input = test::scaled(scene.input, scale);
    const FairingResult result = scaled.fair({}, scale);
    EXPECT_EQ(result.vertices_moved, plain.vertices_moved);
    EXPECT_NEAR(result.bending_after, plain.bending_after, 1e-9 * plain.bending_after);
    for (std::size_t v = 0; v < plain.points.size(); ++v) {
      ASSERT_LT(norm((1 / scale) * result.points[v] - plain.points[v]), 1e-9);
    }
  }
}

TEST(Fairing, NamesWhatItCannotUse) {
  Scene scene = plate_with_holes(12, {}, 0);
  FairingOptions options;
  options.rim_rings = 9;
  options.margin_rings = 4;
  EXPECT_THROW((void)scene.fair(options), UsageError);
  options = {};
  options.data_weight = 0;
  EXPECT_THROW((void)scene.fair(options), UsageError);
  EXPECT_THROW((void)scene.fair({}, 0), UsageError);
  EXPECT_THROW((void)scene.fair({}, std::numeric_limits<double>::quiet_NaN()), UsageError);
  scene.supported.pop_back();
  EXPECT_THROW((void)scene.fair(), UsageError);
}

TEST(Fairing, CanBeStopped) {
  class Stop : public Observer {
    [[nodiscard]] bool cancelled() const override { return true; }
  } stop;
  const Scene scene = plate_with_holes(40, {{{20, 20, 0}, 8}}, 3);
  EXPECT_THROW((void)fair_completed(scene.surface, scene.supported, NearestTriangle(scene.input), 1,
                                    kTau, {}, stop),
               Cancelled);
}

// Twelve holes in a sphere, closed by a cut.
TEST(FairingOfACut, HolesInASphereFollowItsCurvature) {
  const double hole = 0.25;  // radians from its middle to its rim
  TriangleSoup input = test::icosphere(6);
  for (const Point3& axis : test::icosphere(0).points) {
    erase_faces_near(input, axis, 2 * std::sin(hole / 2));
  }
  RemeshOptions options;
  options.resolution = 96;
  options.surface = SurfaceMode::sdf;
  options.lambda_fill = {4, 1};  // or else it stays a hollow shell
  const RemeshResult cut = remesh(input, options, *backends::make("cgal"), *solvers::make("bk"));
  const double step = cut.frame.spacing;
  const double epsilon = cut.derived.epsilon * cut.frame.unit;
  const NearestTriangle nearest(input);
  std::vector<std::uint8_t> supported;
  for (const Point3& p : cut.surface.points) {
    supported.push_back(nearest(p, 1.6 * epsilon).found() ? 1 : 0);
  }
  const FairingResult result =
      fair_completed(cut.surface, supported, nearest, step, epsilon, {}, silent_observer());
  EXPECT_EQ(result.patches, 12);
  EXPECT_EQ(result.patches_left, 0);
  const Deviation before = from_sphere(cut.surface.points, supported, 1 + epsilon);
  const Deviation after = from_sphere(result.points, supported, 1 + epsilon);
  std::cout << "in steps: deviation " << before.largest / step << " (rms "
            << before.root_mean_square / step << ") -> " << after.largest / step << " (rms "
            << after.root_mean_square / step << ")\n";
  EXPECT_LT(after.largest, 0.4 * step);
  EXPECT_LT(5 * after.largest, before.largest);
  EXPECT_LT(10 * after.root_mean_square, before.root_mean_square);
  // What is left to the caller, who puts vertices back until there is none.
  TriangleSoup faired = cut.surface;
  faired.points = result.points;
  EXPECT_LT(inspect_surface(faired).intersecting_pairs, 30);
}

}  // namespace
}  // namespace cellocut
