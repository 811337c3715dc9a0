// The proxy keeps its distance from phi = 0, measured against analytic surfaces and not by the
// field.
#include "cellocut/proxy/proxy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "cellocut/field/distance_field.h"
#include "cellocut/proxy/decimation.h"
#include "cellocut/proxy/nearest_vertex.h"
#include "cellocut/proxy/refinement.h"
#include "cellocut/surface/iso_surface.h"
#include "support/defective_meshes.h"

namespace cellocut {
namespace {

constexpr int kResolution = 96;

struct Thickened {
  Frame frame;
  SparseField phi;
  TriangleSoup surface;  // phi = 0, index coordinates
};

Thickened thicken(const TriangleSoup& soup, double steps) {
  Thickened t;
  t.frame = make_frame(bounding_box(soup), kResolution, steps + kBand + 1);
  t.phi = compute_distance_field(soup, t.frame, steps, silent_observer());
  t.surface = extract_iso_surface(t.phi);
  return t;
}

// The largest |phi(x)| in grid steps over a raster on the proxy's faces, phi in input units.
double largest_departure(const Proxy& proxy, const Frame& frame,
                         const std::function<double(const Point3&)>& phi) {
  double largest = 0;
  constexpr int kSteps = 12;
  for (const Triangle& face : proxy.mesh.triangles) {
    const Point3& a = proxy.mesh.points[face[0]];
    const Point3 u = proxy.mesh.points[face[1]] - a;
    const Point3 v = proxy.mesh.points[face[2]] - a;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Point3 p =
            (a + (static_cast<double>(i) / kSteps) * u) + (static_cast<double>(j) / kSteps) * v;
        largest = std::max(largest, std::fabs(phi(p)) / frame.spacing);
      }
    }
  }
  return largest;
}

TEST(Proxy, OfASphereStaysWithinHalfAStep) {
  const Thickened t = thicken(test::icosphere(6, 1, {0, 0, 0}), 2.0);
  const Proxy proxy = make_proxy(t.surface, t.phi, t.frame, 0.95, silent_observer());
  const double epsilon = 2.0 * t.frame.spacing;
  const double largest = largest_departure(
      proxy, t.frame, [&](const Point3& p) { return std::fabs(norm(p) - 1) - epsilon; });
  // The facets of the icosphere and the interpolation of phi add a little to the half step.
  EXPECT_LE(largest, kProxyTolerance + 0.1);
  EXPECT_LE(proxy.largest_distance, kProxyTolerance);
  EXPECT_GE(proxy.removed_share, 0.9);
  EXPECT_EQ(proxy.faces_before, static_cast<std::int64_t>(t.surface.triangles.size()));
}

TEST(Proxy, OfAThinSheetStaysWithinHalfAStep) {
  for (const Point3 normal : {Point3{0, 0, 1}, Point3{1, 2, 3}, Point3{1, 1, 0}}) {
    const Thickened t = thicken(test::tilted_sheet(normal, 1, 1), 1.0);
    const Proxy proxy = make_proxy(t.surface, t.phi, t.frame, 0.95, silent_observer());
    EXPECT_LE(proxy.largest_distance, kProxyTolerance);
    EXPECT_GE(proxy.removed_share, 0.8);
    EXPECT_FALSE(proxy.mesh.empty());
  }
}

TEST(Proxy, WithoutDecimationIsTheSurfaceItself) {
  const Thickened t = thicken(test::icosphere(3, 1, {0, 0, 0}), 2.0);
  const Proxy proxy = make_proxy(t.surface, t.phi, t.frame, 0, silent_observer());
  EXPECT_EQ(proxy.removed_share, 0);
  EXPECT_EQ(proxy.mesh.triangles.size(), t.surface.triangles.size());
  ASSERT_EQ(proxy.mesh.points.size(), t.surface.points.size());
  double largest = 0;
  bool same_move = true;
  const Point3 first = t.frame.to_index(proxy.mesh.points[0]) - t.surface.points[0];
  for (std::size_t i = 0; i < t.surface.points.size(); ++i) {
    const Point3 move = t.frame.to_index(proxy.mesh.points[i]) - t.surface.points[i];
    for (const double x : move) largest = std::max(largest, std::fabs(x));
    same_move = same_move && norm(move - first) < 1e-9;
  }
  EXPECT_LE(largest, kTieBreak + 1e-9);
  EXPECT_GE(largest, 0.9 * kTieBreak);
  EXPECT_FALSE(same_move);
}

TEST(Proxy, HasNoPointThatNoFaceUses) {
  const Thickened t = thicken(test::moebius_strip(), 1.0);
  const Proxy proxy = make_proxy(t.surface, t.phi, t.frame, 0.95, silent_observer());
  std::vector<bool> used(proxy.mesh.points.size(), false);
  for (const Triangle& face : proxy.mesh.triangles) {
    for (const std::uint32_t corner : face) used.at(corner) = true;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
}

TEST(Proxy, SplitsACoarseCoverUntilItIsClose) {
  const Thickened t = thicken(test::icosphere(5, 1, {0, 0, 0}), 3.0);
  // A cover of the outer sphere and of the inner by far too few faces.
  const std::vector<Triangle> coarse = decimate(t.surface, 0.99, 2.0);
  ASSERT_LT(coarse.size(), t.surface.triangles.size() / 60);
  const Refinement refined =
      refine_to_surface(t.surface, coarse, t.phi, kProxyTolerance, silent_observer());
  EXPECT_LE(refined.largest_distance, kProxyTolerance);
  EXPECT_GT(refined.faces.size(), coarse.size());
  EXPECT_LT(refined.faces.size(), t.surface.triangles.size() / 4);
  // It is still a cover: directions from the centre meet both spheres.
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Point3 centre = t.frame.to_index({0, 0, 0});
  for (int n = 0; n < 200; ++n) {
    const Point3 direction{normal(random), normal(random), normal(random)};
    const auto hits =
        std::count_if(refined.faces.begin(), refined.faces.end(), [&](const Triangle& face) {
          std::array<double, 3> volume{};
          for (int k = 0; k < 3; ++k) {
            const Point3 a = t.surface.points[face[k]] - centre;
            const Point3 b = t.surface.points[face[(k + 1) % 3]] - centre;
            volume[k] = dot(direction, cross(a, b));
          }
          const auto same = [&](double sign) {
            return std::all_of(volume.begin(), volume.end(),
                               [sign](double v) { return sign * v > 0; });
          };
          const Point3& corner = t.surface.points[face[0]];
          return dot(corner - centre, direction) > 0 && (same(1) || same(-1));
        });
    EXPECT_GE(hits, 2);
  }
}

TEST(Proxy, DecimationKeepsCornersOfTheSurface) {
  const Thickened t = thicken(test::tilted_sheet({1, 2, 3}, 1, 1), 1.0);
  const std::vector<Triangle> faces = decimate(t.surface, 0.95, kProxyTolerance);
  EXPECT_LE(faces.size(), t.surface.triangles.size() / 10);
  EXPECT_GE(faces.size(), t.surface.triangles.size() / 25);
  for (const Triangle& face : faces) {
    for (const std::uint32_t corner : face) ASSERT_LT(corner, t.surface.points.size());
    EXPECT_NE(face[0], face[1]);
    EXPECT_NE(face[1], face[2]);
    EXPECT_NE(face[2], face[0]);
  }
  EXPECT_EQ(decimate(t.surface, 0, kProxyTolerance), t.surface.triangles);
}

TEST(NearestVertex, EqualsBruteForce) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0, 12);
  std::vector<Point3> points;
  points.reserve(701);
  for (int i = 0; i < 700; ++i) points.push_back({place(random), place(random), place(random)});
  points.push_back(points[3]);  // a tie: the lower index wins
  const NearestVertex nearest(points);
  for (int n = 0; n < 500; ++n) {
    const Point3 p{place(random), place(random), place(random)};
    std::array<std::uint32_t, 2> excluded{NearestVertex::kNone, NearestVertex::kNone};
    for (std::uint32_t& next : excluded) {
      std::uint32_t expected = NearestVertex::kNone;
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (i == excluded[0] || i == excluded[1]) continue;
        if (expected == NearestVertex::kNone ||
            squared_norm(points[i] - p) < squared_norm(points[expected] - p)) {
          expected = i;
        }
      }
      ASSERT_LT(squared_norm(points[expected] - p), 4.0);
      const std::uint32_t found = nearest(p, excluded);
      EXPECT_EQ(found, expected);
      next = found;
    }
  }
}

TEST(NearestVertex, FindsNothingFarAway) {
  const std::vector<Point3> points{{1, 1, 1}, {9, 9, 9}};
  const NearestVertex nearest(points);
  EXPECT_EQ(nearest({5, 5, 5}, {}), NearestVertex::kNone);
  EXPECT_EQ(nearest({1.5, 1, 1}, std::array<std::uint32_t, 1>{0}), NearestVertex::kNone);
}

}  // namespace
}  // namespace cellocut
