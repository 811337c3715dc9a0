// The contracted cut problem against enumeration of all labellings, and the way back to the
// complex.
#include "cellocut/energy/cell_graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "cellocut/base/errors.h"
#include "cellocut/energy/certificate.h"
#include "solvers/solvers.h"
#include "support/tiny_complexes.h"

namespace cellocut::testing {
namespace {

constexpr ExteriorMode kModes[] = {ExteriorMode::unbounded, ExteriorMode::hull_cells};

// A labelled complex with its problem, and what a solver makes of it.
struct Example {
  TetComplex complex;
  CellLabels initial;
  ExteriorMode mode;
  Rational lambda;
  FacetList facets = list_facets(complex);
  FacetAreas areas = labelled_areas(complex, facets, initial, 2, 30);
  std::vector<Anchor> anchors = anchor_cells(complex, initial, mode);
  CellGraph graph = build_cell_graph(complex, facets, areas, anchors, lambda);
  CutResult cut = {};
  CellLabels smallest = {};
  CellLabels largest = {};

  void solve() {
    cut = solvers::make("bk")->solve(graph.problem);
    ASSERT_EQ(cut.status, CutStatus::optimal);
    smallest = expand_labels(graph, cut.smallest_source_side);
    largest = expand_labels(graph, cut.largest_source_side);
  }
  [[nodiscard]] bool certified() const {
    const auto flow = lift_flow(graph, facets, areas, anchors, lambda, cut.edge_flow);
    return check_certificate(
               {complex, initial, mode, lambda, 2, 30, flow, cut.value, smallest, largest})
        .valid;
  }
  [[nodiscard]] std::int64_t cost(const CellLabels& labels) const {
    return labelling_energy(facets, areas, lambda, labels);
  }
};

void expect_minimum_by_enumeration(const Example& example) {
  std::vector<std::size_t> free;
  CellLabels labels(example.anchors.size(), kExterior);
  for (std::size_t c = 0; c < labels.size(); ++c) {
    if (example.anchors[c] == Anchor::free) free.push_back(c);
    if (example.anchors[c] == Anchor::interior) labels[c] = kInterior;
  }
  ASSERT_LE(free.size(), 14U);
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  CellLabels smallest;
  CellLabels largest;
  for (std::uint32_t bits = 0; bits < (1U << free.size()); ++bits) {
    for (std::size_t i = 0; i < free.size(); ++i) labels[free[i]] = (bits >> i) & 1U;
    const std::int64_t cost = example.cost(labels);
    if (cost > least) continue;
    if (cost < least) smallest = largest = labels;
    least = cost;
    for (const std::size_t c : free) {
      smallest[c] = std::max(smallest[c], labels[c]);
      largest[c] = std::min(largest[c], labels[c]);
    }
  }
  EXPECT_EQ(example.cut.value, least);
  EXPECT_EQ(example.smallest, smallest);
  EXPECT_EQ(example.largest, largest);
  EXPECT_TRUE(example.certified());
}

TEST(CellGraph, GivesTheMinimumOfAllLabellings) {
  int ties = 0;
  for (const ExteriorMode mode : kModes) {
    for (const Rational& lambda : {Rational{20, 1}, {1, 1}, {1, 3}, {5, 2}}) {
      for (std::uint64_t seed = 0; seed < 8; ++seed) {
        SCOPED_TRACE(seed);
        TetComplex complex = cube_grid({2, 1, 1}, seed % 2 == 0 ? 0 : 0.08, seed);
        CellLabels initial = random_labels(complex, 0.1 * static_cast<double>(seed), seed);
        Example example{std::move(complex), std::move(initial), mode, lambda};
        example.solve();
        expect_minimum_by_enumeration(example);
        ties += example.smallest != example.largest ? 1 : 0;
      }
    }
  }
  EXPECT_GT(ties, 0);
}

TEST(CellGraph, EnclosedFreeCellsAreInteriorWithoutTheSolver) {
  for (const ExteriorMode mode : kModes) {
    TetComplex complex = cube_grid({3, 3, 3});
    CellLabels initial(complex.cells.size(), kInterior);
    for (const std::uint32_t c : cells_of_cube(complex, 1, 1, 1)) initial[c] = kExterior;
    for (const std::uint32_t c : cells_of_cube(complex, 0, 0, 0)) initial[c] = kExterior;
    Example example{std::move(complex), std::move(initial), mode, {20, 1}};
    // The two cubes meet in a vertex alone.
    EXPECT_EQ(example.graph.enclosed_cells, 6);
    for (const std::uint32_t c : cells_of_cube(example.complex, 1, 1, 1)) {
      EXPECT_EQ(example.graph.node_of_cell[c], -1);
      EXPECT_EQ(example.graph.decided[c], kInterior);
    }
    example.solve();
    expect_minimum_by_enumeration(example);
  }
}

TEST(CellGraph, WithoutAnchorsTheMinimumIsEmpty) {
  const TetComplex complex = cube_grid({2, 2, 1});
  const CellLabels initial = random_labels(complex, 0.5, 3);
  const FacetList facets = list_facets(complex);
  const FacetAreas areas = labelled_areas(complex, facets, initial, 2, 30);
  const CellGraph graph = build_cell_graph(
      complex, facets, areas, std::vector<Anchor>(initial.size(), Anchor::free), {20, 1});
  const CutResult cut = solvers::make("bk")->solve(graph.problem);
  EXPECT_EQ(cut.value, 0);
  EXPECT_EQ(expand_labels(graph, cut.largest_source_side), CellLabels(initial.size(), kExterior));
}

TEST(CellGraph, RefusesCapacitiesThatDoNotFit) {
  const TetComplex complex = regular_bipyramid();
  const CellLabels initial(2, kExterior);
  const FacetList facets = list_facets(complex);
  const FacetAreas areas = labelled_areas(complex, facets, initial, 1, 50);
  EXPECT_THROW(
      build_cell_graph(complex, facets, areas, std::vector<Anchor>(2, Anchor::free), {1 << 20, 1}),
      LimitError);
}

// What a wrong contraction does to one arc: the certificate passes only where nothing came of it.
TEST(CellGraph, AWrongContractionIsCaught) {
  for (const ExteriorMode mode : kModes) {
    TetComplex complex = cube_grid({3, 2, 2}, 0.08, 2);
    CellLabels initial = random_labels(complex, 0.3, 2);
    Example truth{std::move(complex), std::move(initial), mode, {1, 1}};
    truth.solve();
    ASSERT_TRUE(truth.certified());
    int caught = 0;
    int caught_with_the_same_value = 0;
    const auto attempt = [&](const auto& corrupt) {
      Example wrong = truth;
      corrupt(wrong.graph.problem);
      wrong.solve();
      const bool same = wrong.cut.value == truth.cut.value && wrong.smallest == truth.smallest &&
                        wrong.largest == truth.largest;
      if (!wrong.certified()) {
        ++caught;
        caught_with_the_same_value += same ? 1 : 0;
      } else {
        EXPECT_TRUE(same);
      }
    };
    const CutProblem& problem = truth.graph.problem;
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
      attempt([e](CutProblem& p) {
        p.edges[e].capacity *= 50;
        p.edges[e].reverse_capacity *= 50;
      });
    }
    for (std::size_t i = 0; i < problem.node_count(); ++i) {
      attempt([i](CutProblem& p) { p.to_source[i] = 50 * p.to_source[i] + 1; });
      attempt([i](CutProblem& p) { p.to_sink[i] = 50 * p.to_sink[i] + 1; });
    }
    EXPECT_GT(caught, 0);
    EXPECT_GT(caught_with_the_same_value, 0);
    const int before = caught;
    attempt([](CutProblem& p) { ++p.constant; });
    EXPECT_EQ(caught, before + 1);
  }
}

}  // namespace
}  // namespace cellocut::testing
