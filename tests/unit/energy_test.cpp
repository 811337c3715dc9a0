// The energy: lambda as a fraction, areas as integers, anchors, and the cost of a labelling.
#include "cellocut/energy/energy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cellocut/base/errors.h"
#include "support/tiny_complexes.h"

namespace cellocut::testing {
namespace {

TEST(Rational, IsReadInLowestTerms) {
  const auto expect = [](const char* text, std::int64_t numerator, std::int64_t denominator) {
    const Rational value = parse_rational(text);
    EXPECT_EQ(value.numerator, numerator) << text;
    EXPECT_EQ(value.denominator, denominator) << text;
  };
  expect("20", 20, 1);
  expect("2.5", 5, 2);
  expect("1/3", 1, 3);
  expect("40/6", 20, 3);
  expect("0.1", 1, 10);
  expect(".5", 1, 2);
  expect("3.", 3, 1);
  expect("2.5/0.5", 5, 1);
  expect("1048576", 1048576, 1);
  expect("1/1048576", 1, 1048576);
  expect("2097152/2", 1048576, 1);
  expect("0.000001", 1, 1000000);
  expect("007", 7, 1);
}

TEST(Rational, RefusesWhatIsNoPositiveFraction) {
  for (const char* text :
       {"",      "0",   "0/1",     "1/0",       "-1",        "+1",
        "1/-3",  "a",   "20x",     "1e3",       " 2",        "2 ",
        "1/2/3", "/",   "1/",      "/2",        ".",         "1..2",
        "nan",   "inf", "1048577", "1/1048577", "0.0000001", "99999999999999999999999"}) {
    EXPECT_THROW(parse_rational(text), UsageError) << "'" << text << "'";
  }
  EXPECT_THROW(parse_rational("1844674407371/0.0000001"), UsageError);  // more than 2^63
  try {  // positive, but with too many digits: the message must not deny the former alone
    parse_rational("3.14159265358979323846");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("terms up to 2^20"));
  }
}

TEST(Rational, IsWrittenAsItIsRead) {
  EXPECT_EQ(to_string(Rational{20, 1}), "20");
  EXPECT_EQ(to_string(Rational{5, 2}), "5/2");
  for (const char* text : {"20", "5/2", "1/1048576", "7/3"}) {
    EXPECT_EQ(to_string(parse_rational(text)), text);
  }
}

TEST(Facets, EveryPairOfNeighboursOnceAndEveryHullFacetOnce) {
  const TetComplex grid = cube_grid({2, 3, 2});
  const FacetList facets = list_facets(grid);
  std::size_t sides = 0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const Facet& facet = facets[f];
    EXPECT_EQ(grid.neighbours[facet.cell][facet.corner], facet.other);
    EXPECT_TRUE(facet.other == kOutside || facet.other > static_cast<std::int32_t>(facet.cell));
    sides += facet.other == kOutside ? 1 : 2;
    if (f == 0) continue;
    EXPECT_LT(std::pair(facets[f - 1].cell, facets[f - 1].corner),
              std::pair(facet.cell, facet.corner));
  }
  EXPECT_EQ(sides, 4 * grid.cells.size());
}

double area_of(const TetComplex& complex, const Facet& facet) {
  const auto corners = facet_corners(complex, facet.cell, facet.corner);
  return triangle_area(complex.points[corners[0]], complex.points[corners[1]],
                       complex.points[corners[2]]);
}

TEST(Areas, AreQuantisedByTheLargestPowerOfTwoThatFits) {
  for (const int bits : {8, 13, 30, 40, 50}) {
    for (const double unit : {1.0, 3.0, 1e-3, 1e6}) {
      const TetComplex grid = cube_grid({2, 2, 2}, 0.09, 5);
      const FacetList facets = list_facets(grid);
      const FacetAreas areas = quantise_areas(grid, facets, unit, bits);
      int exponent = 0;
      EXPECT_EQ(std::frexp(areas.scale, &exponent), 0.5);
      EXPECT_LE(areas.sum, std::int64_t{1} << bits);
      std::int64_t sum = 0;
      std::int64_t finer_sum = 0;
      double largest_error = 0;
      double total = 0;
      ASSERT_EQ(areas.quantised.size(), facets.size());
      for (std::size_t f = 0; f < facets.size(); ++f) {
        const double area = area_of(grid, facets[f]) / (unit * unit);
        EXPECT_EQ(areas.quantised[f], std::max<std::int64_t>(1, std::llround(areas.scale * area)));
        sum += areas.quantised[f];
        finer_sum += std::max<std::int64_t>(1, std::llround(2 * areas.scale * area));
        total += area;
        largest_error = std::max(
            largest_error, std::fabs(static_cast<double>(areas.quantised[f]) / areas.scale - area));
      }
      EXPECT_EQ(areas.sum, sum);
      EXPECT_GT(finer_sum, std::int64_t{1} << bits);
      EXPECT_EQ(areas.largest_error, largest_error);
      EXPECT_NEAR(areas.total_error, std::fabs(static_cast<double>(sum) / areas.scale - total),
                  1e-12 * total);
      EXPECT_EQ(areas.unit, unit);
    }
  }
}

TEST(Areas, DoNotDependOnAScaleByAPowerOfTwo) {
  TetComplex grid = cube_grid({2, 2, 2}, 0.09, 5);
  const FacetList facets = list_facets(grid);
  const FacetAreas expected = quantise_areas(grid, facets, 3, 40);
  for (Point3& p : grid.points) p = 0x1p-20 * p;
  const FacetAreas scaled = quantise_areas(grid, facets, 0x1p-20 * 3, 40);
  EXPECT_EQ(scaled.quantised, expected.quantised);
  EXPECT_EQ(scaled.scale, expected.scale);
}

TEST(Areas, AreAtLeastOne) {
  TetComplex grid = cube_grid({2, 1, 1});
  for (Point3& p : grid.points) p[0] = p[0] == 1 ? 1e-9 : p[0];
  for (const int bits : {8, 20}) {
    const FacetAreas areas = quantise_areas(grid, list_facets(grid), 1, bits);
    EXPECT_EQ(*std::min_element(areas.quantised.begin(), areas.quantised.end()), 1);
    EXPECT_LE(areas.sum, std::int64_t{1} << bits);
  }
}

TEST(Areas, RefuseWhatCannotFit) {
  const TetComplex grid = cube_grid({3, 3, 3});
  const FacetList facets = list_facets(grid);
  ASSERT_GT(facets.size(), 256U);
  EXPECT_THROW(quantise_areas(grid, facets, 1, 8), LimitError);
  EXPECT_THROW(quantise_areas(grid, facets, 1, 7), UsageError);
  EXPECT_THROW(quantise_areas(grid, facets, 1, 51), UsageError);
}

TEST(Anchors, FollowTheInitialLabelsAndTheMode) {
  const TetComplex grid = cube_grid({3, 3, 3});
  const CellLabels initial = random_labels(grid, 0.3, 4);
  for (const ExteriorMode mode : {ExteriorMode::unbounded, ExteriorMode::hull_cells}) {
    const std::vector<Anchor> anchors = anchor_cells(grid, initial, mode);
    for (std::size_t c = 0; c < anchors.size(); ++c) {
      const bool hull =
          *std::min_element(grid.neighbours[c].begin(), grid.neighbours[c].end()) == kOutside;
      const Anchor expected = initial[c] == kInterior                    ? Anchor::interior
                              : hull && mode == ExteriorMode::hull_cells ? Anchor::exterior
                                                                         : Anchor::free;
      EXPECT_EQ(anchors[c], expected);
    }
  }
}

// Two regular tetrahedra of edge 3 sqrt 2: seven facets, all alike.
TEST(Energy, OfTheBipyramidByHand) {
  const TetComplex complex = regular_bipyramid();
  const FacetList facets = list_facets(complex);
  FacetAreas areas = quantise_areas(complex, facets, 1, 40);
  const std::int64_t a = areas.quantised[0];
  for (const std::int64_t other : areas.quantised) ASSERT_EQ(other, a);
  const CellLabels initial{kInterior, kExterior};
  const Rational lambda{5, 2};
  areas.supported = support_by_labels(facets, areas, initial);
  const auto energy = [&](const CellLabels& labels) {
    return labelling_energy(facets, areas, lambda, labels);
  };
  // Weights are denominator = 2 where L* differs: at the three hull facets of cell 0 and between
  // the two; numerator = 5 at the hull of cell 1.
  EXPECT_EQ(energy({kInterior, kExterior}), 4 * 2 * a);
  EXPECT_EQ(energy({kInterior, kInterior}), 3 * 2 * a + 3 * 5 * a);
  EXPECT_EQ(energy({kExterior, kExterior}), 0);
  EXPECT_EQ(energy({kExterior, kInterior}), 2 * a + 3 * 5 * a);
}

TEST(Energy, RefusesSumsThatDoNotFit) {
  const TetComplex complex = regular_bipyramid();
  const FacetList facets = list_facets(complex);
  FacetAreas areas = quantise_areas(complex, facets, 1, 40);
  areas.quantised.assign(facets.size(), std::int64_t{1} << 41);
  areas.supported.assign(facets.size(), 0);
  const CellLabels all(2, kInterior);
  EXPECT_THROW(labelling_energy(facets, areas, {1 << 20, 1}, all), LimitError);
}

}  // namespace
}  // namespace cellocut::testing
