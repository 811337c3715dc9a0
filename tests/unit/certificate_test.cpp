// The certificate checker accepts what is true: claims that a slow maximum flow on the whole
// complex makes, and that enumeration of all labellings confirms.
#include "cellocut/energy/certificate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/reference_cut.h"
#include "support/tiny_complexes.h"

namespace cellocut::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr Rational kLambdas[] = {{20, 1}, {1, 1}, {1, 3}, {5, 2}, {3, 7}};

TEST(TinyComplexes, EveryCellIsPositivelyOriented) {
  for (const TetComplex& complex :
       {cube_grid({2, 3, 2}), cube_grid({3, 3, 3}, 0.08, 5), regular_bipyramid()}) {
    for (std::uint32_t c = 0; c < complex.cells.size(); ++c) EXPECT_GT(cell_volume(complex, c), 0);
  }
}

TEST(Certificate, NamesItsChecksInOrder) {
  std::vector<std::string> names;
  for (const CertificateCheck& check : tied_claim(ExteriorMode::unbounded).check().checks) {
    names.push_back(check.name);
    EXPECT_FALSE(check.detail.empty());
  }
  EXPECT_THAT(names, ElementsAre("sizes", "capacities", "conservation", "anchors",
                                 "smallest_energy", "largest_energy", "flow_value",
                                 "smallest_canonical", "largest_canonical"));
}

// The canonical labellings against their definition, by enumeration of all labellings.
TEST(Certificate, AgreesWithEnumeration) {
  for (const ExteriorMode mode : kModes) {
    for (const Rational& lambda : kLambdas) {
      for (std::uint64_t seed = 0; seed < 4; ++seed) {
        TetComplex complex = cube_grid({2, 1, 1}, seed % 2 == 0 ? 0 : 0.08, seed);
        CellLabels labels = random_labels(complex, 0.3, seed);
        const Claim claim = solved(std::move(complex), std::move(labels), mode, lambda, 2);
        const ReferenceCut graph(claim);
        const std::size_t cells = claim.initial.size();
        Wide least = std::numeric_limits<std::int64_t>::max();
        CellLabels smallest;
        CellLabels largest;
        for (std::uint32_t bits = 0; bits < (1U << cells); ++bits) {
          CellLabels candidate(cells);
          bool allowed = true;
          for (std::size_t c = 0; c < cells; ++c) {
            candidate[c] = (bits >> c) & 1U;
            if (graph.anchors[c] == Anchor::interior && candidate[c] != kInterior) allowed = false;
            if (graph.anchors[c] == Anchor::exterior && candidate[c] != kExterior) allowed = false;
          }
          if (!allowed) continue;
          const Wide cost = graph.cost(candidate);
          if (cost < least) smallest = largest = candidate;
          least = std::min(least, cost);
          if (cost != least) continue;
          for (std::size_t c = 0; c < cells; ++c) {
            smallest[c] = std::max(smallest[c], candidate[c]);
            largest[c] = std::min(largest[c], candidate[c]);
          }
        }
        EXPECT_EQ(claim.value, static_cast<std::int64_t>(least));
        EXPECT_EQ(claim.smallest, smallest);
        EXPECT_EQ(claim.largest, largest);
        EXPECT_THAT(claim.failures(), IsEmpty());
      }
    }
  }
}

TEST(Certificate, AcceptsMinimumCuts) {
  for (const ExteriorMode mode : kModes) {
    int ambiguous = 0;
    for (const Rational& lambda : kLambdas) {
      for (std::uint64_t seed = 0; seed < 4; ++seed) {
        TetComplex complex = cube_grid({3, 2, 3}, seed < 2 ? 0 : 0.08, seed);
        CellLabels labels = random_labels(complex, 0.2 + 0.1 * double(seed), seed);
        const int bits = seed % 2 == 0 ? 40 : 12;
        const Claim claim = solved(std::move(complex), std::move(labels), mode, lambda, 3, bits);
        EXPECT_THAT(claim.failures(), IsEmpty());
        ambiguous += claim.smallest != claim.largest ? 1 : 0;
      }
    }
    EXPECT_GT(ambiguous, 0);
  }
}

TEST(Certificate, FacetsBelowHalfAQuantumCountAsOne) {
  TetComplex complex = cube_grid({2, 1, 1});
  for (Point3& point : complex.points) point[0] = point[0] == 1 ? 1e-3 : point[0];
  CellLabels labels(complex.cells.size(), kExterior);
  for (const std::uint32_t c : cells_of_cube(complex, 0, 0, 0)) labels[c] = kInterior;
  const Claim claim =
      solved(std::move(complex), std::move(labels), ExteriorMode::unbounded, {20, 1}, 2, 8);
  const ReferenceCut reference(claim);
  EXPECT_THAT(reference.capacities, Contains(Wide{1}));
  EXPECT_THAT(claim.failures(), IsEmpty());
}

TEST(Certificate, AcceptsTheTiedBipyramid) {
  // The free cell costs 3 quanta of lambda 1/3 as interior, one facet of weight 1 as exterior.
  const Claim claim =
      solved(regular_bipyramid(), {kInterior, kExterior}, ExteriorMode::unbounded, {1, 3}, 4);
  EXPECT_THAT(claim.failures(), IsEmpty());
  EXPECT_THAT(claim.smallest, ElementsAre(kInterior, kExterior));
  EXPECT_THAT(claim.largest, ElementsAre(kInterior, kInterior));
}

TEST(Certificate, AcceptsUniformLabels) {
  for (const ExteriorMode mode : kModes) {
    const TetComplex complex = cube_grid({2, 2, 2});
    for (const std::uint8_t label : {kInterior, kExterior}) {
      const CellLabels labels(complex.cells.size(), label);
      const Claim claim = solved(complex, labels, mode, {20, 1}, 2);
      EXPECT_THAT(claim.failures(), IsEmpty());
      EXPECT_EQ(claim.largest, labels);
      EXPECT_EQ(claim.value == 0, label == kExterior);
    }
  }
  EXPECT_THAT(Claim{}.failures(), IsEmpty());  // no cells at all
}

TEST(Certificate, EnclosedFreeCellsAreInteriorInEveryMinimum) {
  for (const ExteriorMode mode : kModes) {
    TetComplex complex = cube_grid({3, 3, 3});
    const std::vector<std::uint32_t> pocket = cells_of_cube(complex, 1, 1, 1);
    ASSERT_EQ(pocket.size(), 6U);
    CellLabels labels(complex.cells.size(), kInterior);
    for (const std::uint32_t c : pocket) labels[c] = kExterior;
    const CellLabels filled(complex.cells.size(), kInterior);
    Claim claim = solved(std::move(complex), std::move(labels), mode, {20, 1}, 3);
    EXPECT_THAT(claim.failures(), IsEmpty());
    EXPECT_EQ(claim.smallest, filled);
    for (const std::uint32_t c : pocket) claim.smallest[c] = kExterior;
    EXPECT_THAT(claim.failures(), ElementsAre("smallest_energy", "smallest_canonical"));
  }
}

}  // namespace
}  // namespace cellocut::testing
