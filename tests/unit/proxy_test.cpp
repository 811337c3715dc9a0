// The proxy keeps its distance from phi = 0, measured against analytic surfaces and not by the
// field.
#include "cellocut/proxy/proxy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "cellocut/field/distance_field.h"
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
  EXPECT_EQ(proxy.mesh.points.front(), t.frame.to_input(t.surface.points.front()));
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

}  // namespace
}  // namespace cellocut
