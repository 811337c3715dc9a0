// The certificate checker names what is wrong with each corrupted claim.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "cellocut/energy/certificate.h"
#include "support/reference_cut.h"
#include "support/tiny_complexes.h"

namespace cellocut::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;

TEST(CertificateCorruption, CatchesEveryChangedFlow) {
  for (const ExteriorMode mode : kModes) {
    const Claim claim = tied_claim(mode);
    const ReferenceCut graph(claim);
    for (std::size_t f = 0; f < graph.facets.size(); ++f) {
      for (const std::int64_t step : {-1, 1}) {
        Claim wrong = claim;
        wrong.flow[f] += step;
        const Anchor a = graph.anchors[graph.facets[f].cell];
        const Anchor b = graph.anchors[graph.head(f)];
        if (a == Anchor::free || b == Anchor::free) {
          EXPECT_THAT(wrong.failures(), Contains("conservation")) << f;
        } else if (a != b) {
          EXPECT_THAT(wrong.failures(), Contains("flow_value")) << f;  // was saturated
        } else {
          wrong.flow[f] = step;  // between anchors of a kind any flow will do
          EXPECT_THAT(wrong.failures(), IsEmpty()) << f;
        }
        // At the capacity it is allowed, one above it is not.
        const auto capacity = static_cast<std::int64_t>(graph.capacities[f]);
        wrong.flow[f] = step * capacity;
        EXPECT_THAT(wrong.failures(), Not(Contains("capacities"))) << f;
        wrong.flow[f] = step * (capacity + 1);
        EXPECT_THAT(wrong.failures(), Contains("capacities")) << f;
      }
    }
  }
}

TEST(CertificateCorruption, CatchesEveryFlippedLabel) {
  for (const ExteriorMode mode : kModes) {
    const Claim claim = tied_claim(mode);
    const ReferenceCut graph(claim);
    ASSERT_FALSE(graph.nodes_of(Anchor::free).empty());
    ASSERT_FALSE(graph.nodes_of(Anchor::interior).empty());
    ASSERT_EQ(graph.nodes_of(Anchor::exterior).size() > 1, mode == ExteriorMode::hull_cells);
    for (std::size_t c = 0; c < claim.initial.size(); ++c) {
      for (const bool smallest : {true, false}) {
        Claim wrong = claim;
        (smallest ? wrong.smallest : wrong.largest)[c] ^= 1U;
        const std::vector<std::string> failures = wrong.failures();
        EXPECT_THAT(failures, Contains(smallest ? "smallest_canonical" : "largest_canonical"));
        EXPECT_THAT(failures, Not(Contains(smallest ? "largest_canonical" : "smallest_canonical")));
        const bool anchored = graph.anchors[c] != Anchor::free;
        EXPECT_EQ(std::count(failures.begin(), failures.end(), "anchors"), anchored ? 1 : 0);
      }
    }
  }
}

TEST(CertificateCorruption, CatchesAWrongValue) {
  for (const std::int64_t step : {-1, 1}) {
    Claim claim = tied_claim(ExteriorMode::unbounded);
    claim.value += step;
    EXPECT_THAT(claim.failures(), ElementsAre("smallest_energy", "largest_energy", "flow_value"));
  }
}

TEST(CertificateCorruption, CatchesSwappedLabellings) {
  for (const ExteriorMode mode : kModes) {
    Claim claim = tied_claim(mode);
    ASSERT_NE(claim.smallest, claim.largest);
    std::swap(claim.smallest, claim.largest);
    EXPECT_THAT(claim.failures(), ElementsAre("smallest_canonical", "largest_canonical"));
  }
}

// A contraction that inflates an arc which no minimum cut uses leaves value and labels as they are:
// only the flow tells.
TEST(CertificateCorruption, CatchesAnInflatedUncutCapacity) {
  const Claim claim = tied_claim(ExteriorMode::unbounded);
  int caught = 0;
  for (std::size_t f = 0; f < claim.flow.size(); ++f) {
    Claim wrong = claim;
    ReferenceCut graph(claim);
    const std::size_t tail = graph.facets[f].cell;
    const std::size_t head = graph.head(f);
    if (graph.anchors[tail] != Anchor::free || graph.anchors[head] != Anchor::free) continue;
    if (claim.smallest[tail] != claim.smallest[head]) continue;
    if (claim.largest[tail] != claim.largest[head]) continue;
    graph.solve(wrong);
    const std::vector<int> back = graph.search({head}, true, static_cast<int>(f));
    if (back[tail] == ReferenceCut::kNotReached) continue;
    // A circulation through the inflated facet.
    graph.flow[f] += graph.augment(back, tail);
    if (graph.flow[f] <= graph.capacities[f]) continue;
    graph.capacities[f] = graph.flow[f] + 1;
    graph.solve(wrong);
    EXPECT_THAT(wrong.failures(),
                ElementsAre("capacities", "smallest_canonical", "largest_canonical"));
    EXPECT_EQ(wrong.value, claim.value);
    EXPECT_EQ(wrong.smallest, claim.smallest);
    EXPECT_EQ(wrong.largest, claim.largest);
    ++caught;
  }
  EXPECT_GT(caught, 0);
}

TEST(CertificateCorruption, CatchesADeflatedUncutCapacity) {
  const Claim claim = tied_claim(ExteriorMode::unbounded);
  int caught = 0;
  for (std::size_t f = 0; f < claim.flow.size(); ++f) {
    ReferenceCut graph(claim);
    graph.capacities[f] = 1;
    Claim wrong = claim;
    graph.solve(wrong);
    if (wrong.value == claim.value) continue;
    EXPECT_THAT(wrong.failures(), IsSupersetOf({"smallest_energy", "largest_energy"}));
    EXPECT_THAT(wrong.failures(), Not(Contains("flow_value")));
    ++caught;
  }
  EXPECT_GT(caught, 0);
}

TEST(CertificateCorruption, CatchesAConstantThatContractionLost) {
  Claim claim = tied_claim(ExteriorMode::hull_cells);
  const ReferenceCut graph(claim);
  std::int64_t constant = 0;
  for (std::size_t f = 0; f < graph.facets.size(); ++f) {
    const Anchor a = graph.anchors[graph.facets[f].cell];
    const Anchor b = graph.anchors[graph.head(f)];
    if (a == b || a == Anchor::free || b == Anchor::free) continue;
    claim.flow[f] = 0;
    constant += static_cast<std::int64_t>(graph.capacities[f]);
  }
  ASSERT_GT(constant, 0);
  EXPECT_THAT(claim.failures(),
              ElementsAre("flow_value", "smallest_canonical", "largest_canonical"));
  claim.value -= constant;
  EXPECT_THAT(claim.failures(), ElementsAre("smallest_energy", "largest_energy",
                                            "smallest_canonical", "largest_canonical"));
}

TEST(CertificateCorruption, CatchesANonMinimalLabellingWithANonMaximalFlow) {
  Claim claim = tied_claim(ExteriorMode::unbounded);
  ASSERT_NE(claim.largest, claim.initial);
  claim.smallest = claim.largest = claim.initial;  // the anchors alone
  claim.value = static_cast<std::int64_t>(ReferenceCut(claim).cost(claim.initial));
  std::fill(claim.flow.begin(), claim.flow.end(), 0);
  EXPECT_THAT(claim.failures(),
              ElementsAre("flow_value", "smallest_canonical", "largest_canonical"));
}

TEST(CertificateCorruption, CatchesWrongParameters) {
  TetComplex complex = cube_grid({3, 3, 3}, 0.08, 3);
  CellLabels labels = random_labels(complex, 0.35, 7);
  const Claim claim =
      solved(std::move(complex), std::move(labels), ExteriorMode::unbounded, {5, 2}, 3);
  ASSERT_THAT(claim.failures(), IsEmpty());
  for (const Rational& lambda : {Rational{5, 3}, Rational{6, 2}, Rational{4, 2}, Rational{5, 1}}) {
    Claim wrong = claim;
    wrong.lambda = lambda;
    EXPECT_THAT(wrong.failures(), IsSupersetOf({"smallest_energy", "largest_energy"}));
  }
  for (const int bits : {39, 41}) {
    Claim wrong = claim;
    wrong.area_bits = bits;
    EXPECT_THAT(wrong.failures(), IsSupersetOf({"smallest_energy", "largest_energy"}));
  }
  Claim wrong = claim;
  wrong.area_bits = 8;  // 378 facets and more do not fit
  EXPECT_THAT(wrong.failures(), IsSupersetOf({"capacities", "smallest_energy"}));
  wrong = claim;
  wrong.mode = ExteriorMode::hull_cells;
  EXPECT_FALSE(wrong.check().valid);
  wrong = claim;
  wrong.initial = claim.largest;
  ASSERT_NE(claim.initial, claim.largest);
  EXPECT_FALSE(wrong.check().valid);
}

TEST(CertificateCorruption, CatchesWrongSizes) {
  const Claim claim = tied_claim(ExteriorMode::unbounded);
  const std::size_t checks = claim.check().checks.size();
  const auto expect_wrong = [&](auto&& damage) {
    Claim wrong = claim;
    damage(wrong);
    const std::vector<std::string> failures = wrong.failures();
    EXPECT_EQ(failures.size(), checks);  // nothing else means anything
    EXPECT_THAT(failures, Contains("sizes"));
  };
  expect_wrong([](Claim& c) { c.flow.pop_back(); });
  expect_wrong([](Claim& c) { c.flow.push_back(0); });
  expect_wrong([](Claim& c) { c.initial.pop_back(); });
  expect_wrong([](Claim& c) { c.smallest.push_back(0); });
  expect_wrong([](Claim& c) { c.largest.clear(); });
  expect_wrong([](Claim& c) { c.largest[3] = 2; });
  expect_wrong([](Claim& c) { c.lambda = {0, 1}; });
  expect_wrong([](Claim& c) { c.lambda = {1, (1 << 20) + 1}; });
  expect_wrong([](Claim& c) { c.area_bits = 62; });
  expect_wrong([](Claim& c) { c.unit = std::numeric_limits<double>::quiet_NaN(); });
  expect_wrong([](Claim& c) { c.complex.neighbours.pop_back(); });
  expect_wrong([](Claim& c) { c.complex.points.pop_back(); });
  expect_wrong([](Claim& c) { c.complex.neighbours[5][0] = -2; });
  expect_wrong([](Claim& c) { c.complex.neighbours[5][0] = 1 << 20; });
  // A neighbour that the other side does not know of, from either side.
  for (const bool lower : {true, false}) {
    expect_wrong([&](Claim& c) {
      const FacetList facets = list_facets(c.complex);
      const Facet facet = *std::find_if(facets.begin(), facets.end(),
                                        [](const Facet& f) { return f.other != kOutside; });
      const auto here = static_cast<std::int32_t>(facet.cell);
      auto& around = c.complex.neighbours[lower ? facet.cell : facet.other];
      *std::find(around.begin(), around.end(), lower ? facet.other : here) = kOutside;
    });
  }
}

TEST(CertificateCorruption, AddsIn128Bits) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  const Rational steep{1 << 20, 1};
  TetComplex complex = cube_grid({3, 3, 3});
  CellLabels labels(complex.cells.size(), kExterior);
  for (const std::uint32_t c : cells_of_cube(complex, 1, 1, 1)) labels[c] = kInterior;
  const CellLabels filled(complex.cells.size(), kInterior);
  for (const int bits : {40, 42, 50}) {  // all capacities sum to 2^60, 2^62, 2^70
    const Claim claim = solved(complex, labels, ExteriorMode::unbounded, steep, 3, bits);
    EXPECT_THAT(claim.failures(), IsEmpty());
    Claim wrong = claim;
    wrong.largest = filled;
    EXPECT_THAT(wrong.failures(), ElementsAre("largest_energy", "largest_canonical"));
    for (const std::int64_t extreme : {kMost, kLeast}) {
      wrong = claim;
      std::fill(wrong.flow.begin(), wrong.flow.end(), extreme);
      EXPECT_THAT(wrong.failures(), IsSupersetOf({"capacities", "conservation", "flow_value"}));
      wrong = claim;
      wrong.value = extreme;
      EXPECT_THAT(wrong.failures(), ElementsAre("smallest_energy", "largest_energy", "flow_value"));
    }
  }
}

// Four outflows of 2^62 are zero in 64 bits, and each is within its capacity here.
TEST(CertificateCorruption, DoesNotTakeAWrappedSumForBalance) {
  Claim claim = solved(regular_bipyramid(), {kExterior, kExterior}, ExteriorMode::unbounded,
                       {1 << 20, 1}, 4, 50);
  ASSERT_THAT(claim.failures(), IsEmpty());
  const ReferenceCut graph(claim);
  for (std::size_t f = 0; f < graph.facets.size(); ++f) {
    ASSERT_GT(graph.capacities[f], Wide{1} << 62U);
    if (graph.facets[f].cell == 0) claim.flow[f] = std::int64_t{1} << 62U;
  }
  const auto leave = std::find_if(graph.facets.begin(), graph.facets.end(),
                                  [](const Facet& f) { return f.cell == 1; });
  claim.flow[static_cast<std::size_t>(leave - graph.facets.begin())] = std::int64_t{1} << 62U;
  EXPECT_THAT(claim.failures(),
              ElementsAre("conservation", "smallest_canonical", "largest_canonical"));
}

}  // namespace
}  // namespace cellocut::testing
