// The fill path and the wide cuts that it is made of, against exhaustive search, for every exact
// solver of ours.
#include "cellocut/path/fill_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "solvers/solvers.h"

namespace cellocut {
namespace {

std::vector<std::string> exact_solvers() {
  std::vector<std::string> names;
  for (const auto& variant : solvers::registered()) {
    if (variant.make == nullptr) continue;
    const SolverInfo& info = variant.make()->info();
    if (info.exact && !info.outside) names.push_back(variant.name);
  }
  return names;
}

CutLabels labels_of(std::uint32_t bits, std::size_t nodes) {
  CutLabels labels(nodes);
  for (std::size_t i = 0; i < nodes; ++i) labels[i] = (bits >> i) & 1U;
  return labels;
}

class SolverCase : public ::testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<CutSolver> make() { return solvers::make(GetParam()); }
};
// ---- wide cuts ----

class WideCuts : public SolverCase {};
INSTANTIATE_TEST_SUITE_P(Exact, WideCuts, ::testing::ValuesIn(exact_solvers()),
                         [](const auto& instance) { return instance.param; });

// Capacities of up to `bits` bits.
WideProblem random_wide_problem(std::mt19937_64& random, int bits) {
  constexpr std::uint32_t kNodes = 9;
  const auto capacity = [&] {
    const Wide high = static_cast<std::int64_t>(random() >> 1);
    const Wide wide = high << 62 | static_cast<std::int64_t>(random() >> 2);
    return wide >> (125 - bits + static_cast<int>(random() % 8));
  };
  WideProblem problem;
  problem.constant = capacity();
  for (std::uint32_t i = 0; i < kNodes; ++i) {
    problem.to_source.push_back(random() % 3 == 0 ? capacity() : 0);
    problem.to_sink.push_back(random() % 3 == 0 ? capacity() : 0);
  }
  for (int e = 0; e < 16; ++e) {
    problem.edges.push_back({static_cast<std::uint32_t>(random() % kNodes),
                             static_cast<std::uint32_t>(random() % kNodes), capacity()});
  }
  return problem;
}

Wide cost_of(const WideProblem& problem, const CutLabels& side) {
  Wide cost = problem.constant;
  for (std::size_t i = 0; i < side.size(); ++i) {
    cost += side[i] != 0 ? problem.to_sink[i] : problem.to_source[i];
  }
  for (const WideProblem::Edge& edge : problem.edges) {
    if (side[edge.from] != side[edge.to]) cost += edge.capacity;
  }
  return cost;
}

TEST_P(WideCuts, AreThoseOfExhaustiveSearch) {
  std::mt19937_64 random(7);
  const auto solver = make();
  int most_digits = 0;
  for (const int bits : {20, 55, 57, 62, 64, 80, 100, 118}) {
    for (int trial = 0; trial < 20; ++trial) {
      const WideProblem problem = random_wide_problem(random, bits);
      const std::size_t nodes = problem.node_count();
      const WideCut cut = solve_wide(problem, *solver, silent_observer());
      most_digits = std::max(most_digits, cut.digits);
      Wide least = cost_of(problem, CutLabels(nodes, 0));
      CutLabels smallest(nodes, 1);
      CutLabels largest(nodes, 0);
      for (const bool find : {true, false}) {
        for (std::uint32_t bits_of = 0; bits_of < 1U << nodes; ++bits_of) {
          const CutLabels side = labels_of(bits_of, nodes);
          const Wide cost = cost_of(problem, side);
          if (find) least = std::min(least, cost);
          if (find || cost != least) continue;
          for (std::size_t i = 0; i < nodes; ++i) {
            smallest[i] &= side[i];
            largest[i] |= side[i];
          }
        }
      }
      std::vector<double> start(problem.edges.size());
      std::generate(start.begin(), start.end(), [&] {
        return std::ldexp(static_cast<double>(random() % 2001) - 1000, bits - 10);
      });
      const WideCut warm = solve_wide(problem, *solver, silent_observer(), start);
      EXPECT_TRUE(warm.value == cut.value);
      EXPECT_EQ(warm.smallest_source_side, cut.smallest_source_side);
      EXPECT_EQ(warm.largest_source_side, cut.largest_source_side);
      ASSERT_TRUE(cut.value == least) << bits << " bits, trial " << trial;
      EXPECT_EQ(cut.smallest_source_side, smallest);
      EXPECT_EQ(cut.largest_source_side, largest);
    }
  }
  EXPECT_GE(most_digits, 2);
}

// ---- paths ----

class FillPaths : public SolverCase {};
INSTANTIATE_TEST_SUITE_P(Exact, FillPaths, ::testing::ValuesIn(exact_solvers()),
                         [](const auto& instance) { return instance.param; });

// With support between nodes and at the sink cuts are not nested.
ParametricProblem random_problem(std::mt19937_64& random, std::int64_t largest_area, bool nested) {
  const auto nodes = static_cast<std::uint32_t>(2 + random() % 8);
  const auto area = [&] {
    return 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(largest_area));
  };
  const auto some = [&] { return nested || random() % 3 != 0 ? 0 : area(); };
  ParametricProblem problem;
  for (std::uint32_t i = 0; i < nodes; ++i) {
    const std::int64_t supported = random() % 2 == 0 ? 4 * area() : 0;
    problem.to_source.push_back({supported, random() % 8 == 0 ? area() : 0});
    problem.to_sink.push_back({some(), random() % 3 == 0 ? area() : 0});
  }
  for (std::uint32_t e = 0; e < 2 * nodes; ++e) {
    const auto from = static_cast<std::uint32_t>(random() % nodes);
    const auto to = static_cast<std::uint32_t>(random() % nodes);
    if (from != to) problem.edges.push_back({from, to, {some(), area()}});
  }
  problem.constant = {area(), area()};
  return problem;
}

struct Minimum {
  Wide cost = 0;
  CutLabels largest;
};

Minimum exhaustive_minimum(const ParametricProblem& problem, const Lambda& lambda) {
  const std::size_t nodes = problem.node_count();
  std::optional<Minimum> least;
  for (std::uint32_t bits = 0; bits < 1U << nodes; ++bits) {
    const CutLabels side = labels_of(bits, nodes);
    const Wide cost = cost_at(areas_of(problem, side), lambda);
    if (!least || cost < least->cost) least = Minimum{cost, CutLabels(nodes, 0)};
    if (cost != least->cost) continue;
    for (std::size_t i = 0; i < nodes; ++i) least->largest[i] |= side[i];
  }
  return *least;
}

// A fraction between two others.
Lambda between(const Lambda& a, const Lambda& b) { return {a.p + b.p, a.q + b.q}; }

// How many labellings the paths of random problems had.
std::size_t expect_envelopes(CutSolver& solver, bool nested) {
  std::mt19937_64 random(11);
  std::size_t labellings = 0;
  // The last areas need capacities beyond 64 bits.
  for (const std::int64_t largest_area : {3LL, 20LL, 1'000'000LL, 40'000'000'000'000LL}) {
    for (int trial = 0; trial < 60; ++trial) {
      const ParametricProblem problem = random_problem(random, largest_area, nested);
      const std::size_t nodes = problem.node_count();
      const Lambda first{1, 3};
      const Lambda last{50, 1};
      const FillPath path = find_fill_path(problem, first, last, solver, silent_observer());
      EXPECT_EQ(path.nested, problem.nested());
      EXPECT_EQ(path.areas.size(), path.breakpoints.size() + 1);
      labellings += path.areas.size();
      // One labelling is minimal at both ends of its interval, and the largest minimum within.
      // Costs are concave in lambda: so is the least of them, and nothing between is below.
      for (std::size_t k = 0; k < path.areas.size(); ++k) {
        const Lambda& from = k == 0 ? first : path.breakpoints[k - 1];
        const Lambda& to = k + 1 == path.areas.size() ? last : path.breakpoints[k];
        EXPECT_TRUE(from < to);
        CutLabels side(nodes);
        for (std::size_t i = 0; i < nodes; ++i) side[i] = holds(path, k, i) ? 1 : 0;
        EXPECT_EQ(areas_of(problem, side), path.areas[k]);
        for (const Lambda& lambda : {from, to}) {
          EXPECT_TRUE(cost_at(path.areas[k], lambda) == exhaustive_minimum(problem, lambda).cost);
        }
        EXPECT_EQ(side, exhaustive_minimum(problem, between(from, to)).largest);
        EXPECT_EQ(labelling_at(path, between(from, to)), k);
        EXPECT_EQ(labelling_at(path, to), k);
        if (k > 0) {
          EXPECT_GT(path.areas[k].supported, path.areas[k - 1].supported);
          EXPECT_LT(path.areas[k].unsupported, path.areas[k - 1].unsupported);
        }
      }
    }
  }
  return labellings;
}

TEST_P(FillPaths, AreTheEnvelopeOfAllLabellings) {
  EXPECT_GT(expect_envelopes(*make(), true), 400U);
}

TEST_P(FillPaths, AreTheEnvelopeWhereCutsAreNotNested) {
  EXPECT_GT(expect_envelopes(*make(), false), 400U);
}

TEST_P(FillPaths, OfAProblemWithoutNodesHasOneLabelling) {
  ParametricProblem problem;
  problem.constant = {5, 7};
  const FillPath path = find_fill_path(problem, {1, 1}, {9, 1}, *make(), silent_observer());
  ASSERT_EQ(path.areas.size(), 1U);
  EXPECT_EQ(path.areas[0], problem.constant);
}

// A chain in which each node is worth keeping up to its own lambda: 2, 3, 4, 5.
TEST_P(FillPaths, OfAKnownChain) {
  ParametricProblem problem;
  problem.to_source = {{2, 0}, {3, 0}, {4, 0}, {5, 0}};
  problem.to_sink = {{0, 1}, {0, 1}, {0, 1}, {0, 1}};
  const FillPath path = find_fill_path(problem, {1, 1}, {10, 1}, *make(), silent_observer());
  ASSERT_EQ(path.breakpoints.size(), 4U);
  for (std::int64_t k = 0; k < 4; ++k) {
    EXPECT_TRUE(path.breakpoints[static_cast<std::size_t>(k)] == (Lambda{k + 2, 1}));
  }
  EXPECT_EQ(path.level, (std::vector<std::uint32_t>{1, 2, 3, 4}));
}

// Two nodes that change sides at the same lambda make one breakpoint; with a range that ends there,
// none.
TEST_P(FillPaths, TiesMakeOneBreakpointAndNoneAtTheEnds) {
  ParametricProblem problem;
  problem.to_source = {{6, 0}, {9, 0}};
  problem.to_sink = {{0, 2}, {0, 3}};
  const FillPath path = find_fill_path(problem, {1, 1}, {10, 1}, *make(), silent_observer());
  ASSERT_EQ(path.breakpoints.size(), 1U);
  EXPECT_TRUE(path.breakpoints[0] == (Lambda{3, 1}));
  const FillPath left = find_fill_path(problem, {1, 1}, {3, 1}, *make(), silent_observer());
  ASSERT_EQ(left.areas.size(), 1U);
  EXPECT_EQ(left.areas[0], (InterfaceAreas{0, 5}));
  const FillPath right = find_fill_path(problem, {3, 1}, {4, 1}, *make(), silent_observer());
  ASSERT_EQ(right.areas.size(), 1U);
  EXPECT_EQ(right.areas[0], (InterfaceAreas{15, 0}));
}

}  // namespace
}  // namespace cellocut
