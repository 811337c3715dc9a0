// Support measured on facets: against the slab of a plane, where it is known, and against sampling.
#include "cellocut/energy/facet_support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cellocut/field/distance_field.h"
#include "support/tiny_complexes.h"

namespace cellocut::testing {
namespace {

constexpr double kOffset = 1.25;  // of the slab, in grid steps

// A square of 2 x 2 around the origin in the plane z = 0, on a grid of 20 steps to the side.
struct Sheet {
  TriangleSoup soup{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}};
  Frame frame = make_frame(bounding_box(soup), 40, kOffset + kBand + 1);
  SparseField phi = compute_distance_field(soup, frame, kOffset, silent_observer());
};

// One tetrahedron.
TetComplex tetrahedron(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return make_canonical({a, b, c, d}, {{0, 1, 2, 3}}, {0, 1, 2, 3});
}

double share(const FacetAreas& areas, std::size_t f) {
  return static_cast<double>(areas.supported[f]) / static_cast<double>(areas.quantised[f]);
}

FacetAreas measured(const TetComplex& complex, const FacetList& facets, const Sheet& sheet) {
  FacetAreas areas = quantise_areas(complex, facets, 2, 40);
  areas.supported = support_by_facets(complex, facets, areas, sheet.phi, sheet.frame);
  return areas;
}

// Facets that stand on the sheet: a strip of known height is supported, of each triangle the share
// 1 - (1 - height / all)^2 from its base.
TEST(FacetSupport, OfFacetsAcrossASlabIsTheStripWithinReach) {
  const Sheet sheet;
  const double reach = (kOffset + kSupportReach) * sheet.frame.spacing;
  const double top = 0.4;
  const TetComplex complex =
      tetrahedron({-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0, 0.5, 0}, {0, -0.1, top});
  const FacetList facets = list_facets(complex);
  const FacetAreas areas = measured(complex, facets, sheet);
  const double strip = 1 - (1 - reach / top) * (1 - reach / top);
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto corners = facet_corners(complex, facets[f].cell, facets[f].corner);
    const bool in_sheet = corners[2] != 3;
    EXPECT_NEAR(share(areas, f), in_sheet ? 1 : strip, in_sheet ? 0 : 0.01);
  }
}

// In parallel to the sheet: all or nothing, on both sides of it.
TEST(FacetSupport, OfFacetsAlongTheSlabIsAllOrNothing) {
  const Sheet sheet;
  for (const double side : {-1.0, 1.0}) {
    for (const double steps : {0.0, 1.0, 1.7, 1.8, 3.0, 8.0}) {
      const double z = side * steps * sheet.frame.spacing;
      const TetComplex complex =
          tetrahedron({-0.5, -0.5, z}, {0.5, -0.5, z}, {0, 0.5, z}, {0, 0, z + 0.9});
      const FacetList facets = list_facets(complex);
      const FacetAreas areas = measured(complex, facets, sheet);
      for (std::size_t f = 0; f < facets.size(); ++f) {
        if (facets[f].corner != 3) continue;
        EXPECT_EQ(share(areas, f), steps < kOffset + kSupportReach ? 1 : 0) << z;
      }
    }
  }
}

// Facets in all positions, rim of the sheet included, against points spread evenly over each.
TEST(FacetSupport, AgreesWithSampling) {
  const Sheet sheet;
  TetComplex complex = cube_grid({4, 4, 3}, 0.08, 5);
  for (Point3& p : complex.points) {
    p = {0.6 * p[0] - 1.3, 0.6 * p[1] - 1.2, 0.21 * p[2] - 0.3};
  }
  const FacetList facets = list_facets(complex);
  const FacetAreas areas = measured(complex, facets, sheet);
  std::mt19937_64 random(3);
  constexpr int kSamples = 4000;
  int partly = 0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const auto corners = facet_corners(complex, facets[f].cell, facets[f].corner);
    std::vector<Point3> points;
    points.reserve(kSamples);
    for (int n = 0; n < kSamples; ++n) {
      double u = static_cast<double>(random() >> 11) * 0x1p-53;
      double v = static_cast<double>(random() >> 11) * 0x1p-53;
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      const Point3& a = complex.points[corners[0]];
      points.push_back(sheet.frame.to_index(a + u * (complex.points[corners[1]] - a) +
                                            v * (complex.points[corners[2]] - a)));
    }
    int within = 0;
    for (const float value : sheet.phi.sample(points)) within += value < kSupportReach ? 1 : 0;
    const double expected = static_cast<double>(within) / kSamples;
    EXPECT_NEAR(share(areas, f), expected, 0.05) << "facet " << f;
    partly += expected > 0.1 && expected < 0.9 ? 1 : 0;
    EXPECT_GE(areas.supported[f], 0);
    EXPECT_LE(areas.supported[f], areas.quantised[f]);
  }
  EXPECT_GT(partly, 50);
}

}  // namespace
}  // namespace cellocut::testing
