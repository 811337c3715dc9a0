// What every minimum-cut solver owes its callers, checked on each one that is built: known answers,
// both canonical minimum cuts, agreement with an outside witness bit for bit, refusal and
// cancellation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>
#include <tuple>

#include "cellocut/base/errors.h"
#include "solvers/solvers.h"
#include "support/cut_problems.h"

namespace cellocut {
namespace {

using testing::ExpectedCut;
using testing::NamedProblem;
using testing::RandomShape;

std::vector<std::string> built_solvers() {
  std::vector<std::string> names;
  for (const auto& variant : solvers::registered()) {
    if (variant.make != nullptr) names.push_back(variant.name);
  }
  return names;
}

// The outside witness where it is built, otherwise another of our own: never the solver under test,
// so that agreement says something.
std::string witness_for(const std::string& solver) {
  const std::vector<std::string> built = built_solvers();
  for (const char* wanted : {"lemon_preflow", "bk", "push_relabel", "ibfs"}) {
    if (wanted != solver && std::count(built.begin(), built.end(), wanted) != 0) return wanted;
  }
  return {};
}

void expect_cut(const CutResult& result, const ExpectedCut& expected) {
  EXPECT_EQ(result.status, CutStatus::optimal) << result.message;
  EXPECT_EQ(result.message, "");
  EXPECT_EQ(result.value, expected.value);
  EXPECT_EQ(result.lower_bound, expected.value);
  EXPECT_EQ(result.smallest_source_side, expected.smallest);
  EXPECT_EQ(result.largest_source_side, expected.largest);
  EXPECT_TRUE(result.canonical);
}

// Independent of cut_solver.cpp: what makes edge_flow a feasible flow.
void expect_feasible(const CutProblem& problem, const CutResult& result) {
  ASSERT_EQ(result.edge_flow.size(), problem.edges.size());
  std::vector<std::int64_t> inflow(problem.node_count(), 0);
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const CutEdge& edge = problem.edges[e];
    const std::int64_t flow = result.edge_flow[e];
    EXPECT_LE(flow, edge.capacity);
    EXPECT_GE(flow, -edge.reverse_capacity);
    inflow[edge.to] += flow;
    inflow[edge.from] -= flow;
  }
  for (std::size_t i = 0; i < inflow.size(); ++i) {
    EXPECT_LE(inflow[i], problem.to_sink[i]);
    EXPECT_LE(-inflow[i], problem.to_source[i]);
  }
}

bool within_limit(const CutSolver& solver, const CutProblem& problem) {
  return testing::capacity_sum(problem) < solver.info().capacity_limit;
}

// ---- one solver, one known problem ----

class KnownProblem : public ::testing::TestWithParam<std::tuple<std::string, std::size_t>> {};

TEST_P(KnownProblem, HasTheKnownAnswer) {
  const NamedProblem& known = testing::known_problems()[std::get<1>(GetParam())];
  const auto solver = solvers::make(std::get<0>(GetParam()));
  if (!within_limit(*solver, known.problem)) {
    EXPECT_THROW((void)solver->solve(known.problem), LimitError);
    return;
  }
  const CutResult result = solver->solve(known.problem);
  expect_cut(result, known.expected);
  expect_feasible(known.problem, result);
}

INSTANTIATE_TEST_SUITE_P(Solvers, KnownProblem,
                         ::testing::Combine(::testing::ValuesIn(built_solvers()),
                                            ::testing::Range(std::size_t{0},
                                                             testing::known_problems().size())),
                         [](const auto& instance) {
                           return std::get<0>(instance.param) + "_" +
                                  testing::known_problems()[std::get<1>(instance.param)].name;
                         });

// ---- one solver, one shape of random problems ----

class RandomProblems : public ::testing::TestWithParam<std::tuple<std::string, RandomShape>> {};

TEST_P(RandomProblems, AgreeWithTheWitness) {
  constexpr std::uint64_t kSeeds = 40;
  const auto& [name, shape] = GetParam();
  const auto solver = solvers::make(name);
  ASSERT_NE(witness_for(name), "");
  const auto witness = solvers::make(witness_for(name));
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const CutProblem problem = testing::random_problem(shape, seed);
    if (!within_limit(*solver, problem)) {
      EXPECT_THROW((void)solver->solve(problem), LimitError);
      continue;
    }
    const CutResult result = solver->solve(problem);
    const CutResult reference = witness->solve(problem);
    expect_cut(result,
               {reference.value, reference.smallest_source_side, reference.largest_source_side});
    expect_feasible(problem, result);
    if (HasFailure()) break;
  }
}

// Flows of all kinds: balanced or not, within the capacities or far beyond them, and one that is
// maximal already.
TEST_P(RandomProblems, HaveTheSameCutsFromAnyStart) {
  constexpr std::uint64_t kSeeds = 10;
  const auto& [name, shape] = GetParam();
  const auto solver = solvers::make(name);
  std::mt19937_64 random(9);
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const CutProblem problem = testing::random_problem(shape, seed);
    if (!within_limit(*solver, problem)) continue;
    const CutResult cold = solver->solve(problem);
    std::vector<std::int64_t> start = cold.edge_flow;
    for (int kind = 0; kind < 4; ++kind) {
      const CutResult warm = solver->solve(problem, {.start = &start});
      expect_cut(warm, {cold.value, cold.smallest_source_side, cold.largest_source_side});
      expect_feasible(problem, warm);
      for (std::size_t e = 0; e < start.size(); ++e) {
        const CutEdge& edge = problem.edges[e];
        const auto some = static_cast<std::int64_t>(random() >> 1U);
        if (kind == 0) start[e] = cold.edge_flow[e] / 2;
        if (kind == 1)
          start[e] = some % (edge.capacity + edge.reverse_capacity + 1) - edge.reverse_capacity;
        if (kind == 2)
          start[e] = random() % 2 == 0 ? some : std::numeric_limits<std::int64_t>::min();
      }
    }
    if (HasFailure()) break;
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, RandomProblems,
                         ::testing::Combine(::testing::ValuesIn(built_solvers()),
                                            ::testing::ValuesIn(testing::random_shapes())),
                         [](const auto& instance) {
                           return std::get<0>(instance.param) + "_" +
                                  testing::to_string(std::get<1>(instance.param));
                         });

// ---- one solver ----

class Solver : public ::testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<CutSolver> solver_ = solvers::make(GetParam());
};

TEST_P(Solver, AgreesWithExhaustiveSearch) {
  constexpr std::uint64_t kSeeds = 300;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const CutProblem problem = testing::random_problem(RandomShape::tiny, seed);
    expect_cut(solver_->solve(problem), testing::exhaustive_cut(problem));
    if (HasFailure()) break;
  }
}

TEST_P(Solver, SaysWhatItIs) {
  const SolverInfo& info = solver_->info();
  EXPECT_EQ(info.name, GetParam());
  EXPECT_NE(info.summary, "");
  EXPECT_NE(info.licence, "");
  EXPECT_NE(info.reference, "");
  EXPECT_EQ(info.exact, GetParam() != "lp");
  EXPECT_GT(info.capacity_limit, 0);
  EXPECT_LE(info.capacity_limit, kCapacityLimit);
}

TEST_P(Solver, CanBeUsedAgain) {
  const CutProblem first = testing::random_problem(RandomShape::sparse, 1);
  const CutProblem second = testing::random_problem(RandomShape::dense, 2);
  const CutResult once = solver_->solve(first);
  (void)solver_->solve(second);
  const CutResult again = solver_->solve(first);
  EXPECT_EQ(once.edge_flow, again.edge_flow);
  EXPECT_EQ(once.value, again.value);
}

TEST_P(Solver, RefusesAStartOfAnotherSize) {
  const CutProblem problem = testing::random_problem(RandomShape::sparse, 1);
  const std::vector<std::int64_t> start(problem.edges.size() + 1, 0);
  EXPECT_THROW((void)solver_->solve(problem, {.start = &start}), UsageError);
}

TEST_P(Solver, TimesBothPhases) {
  const CutResult result = solver_->solve(testing::random_problem(RandomShape::grid_3d, 1));
  EXPECT_GT(result.build_seconds, 0);
  EXPECT_GT(result.solve_seconds, 0);
  EXPECT_GT(result.verify_seconds, 0);
}

TEST_P(Solver, RefusesExactlyFromItsCapacityLimitOn) {
  const std::int64_t limit = solver_->info().capacity_limit;
  // Two terminals and a constant that sum to one below the limit.
  CutProblem problem{{limit / 4}, {limit / 4 - 1}, {}, limit / 2};
  EXPECT_EQ(solver_->solve(problem).value, limit / 2 + limit / 4 - 1);
  problem.to_sink[0] += 1;
  if (limit < kCapacityLimit) {
    EXPECT_THROW((void)solver_->solve(problem), LimitError);
  } else {
    EXPECT_THROW((void)solver_->solve(problem), InputError);
  }
}

TEST_P(Solver, RejectsInvalidProblems) {
  const CutProblem sound{{3, 0}, {0, 3}, {{0, 1, 2, 1}}, 0};
  ASSERT_EQ(solver_->solve(sound).value, 2);
  const auto expect_rejected = [&](const char* what, auto&& spoil) {
    CutProblem problem = sound;
    spoil(problem);
    EXPECT_THROW((void)solver_->solve(problem), InputError) << what;
  };
  expect_rejected("sizes differ", [](CutProblem& p) { p.to_sink.pop_back(); });
  expect_rejected("negative constant", [](CutProblem& p) { p.constant = -1; });
  expect_rejected("negative source", [](CutProblem& p) { p.to_source[1] = -1; });
  expect_rejected("negative sink", [](CutProblem& p) { p.to_sink[0] = -1; });
  expect_rejected("negative capacity", [](CutProblem& p) { p.edges[0].capacity = -1; });
  expect_rejected("negative reverse", [](CutProblem& p) { p.edges[0].reverse_capacity = -1; });
  expect_rejected("from out of range", [](CutProblem& p) { p.edges[0].from = 2; });
  expect_rejected("to out of range", [](CutProblem& p) { p.edges[0].to = 0xffff'ffffU; });
  expect_rejected("sum overflows", [](CutProblem& p) { p.to_source[0] = kCapacityLimit - 6; });
  expect_rejected("sum overflows 64 bits", [](CutProblem& p) {
    p.to_source.assign(2, std::int64_t{1} << 62);
    p.to_sink.assign(2, std::int64_t{1} << 62);
  });
}

class Stopper final : public Observer {
 public:
  explicit Stopper(int polls) : polls_(polls) {}
  [[nodiscard]] bool cancelled() const override { return --polls_ < 0; }

 private:
  mutable int polls_;
};

TEST_P(Solver, StopsWhenTheObserverSaysSo) {
  Stopper at_once(0);
  SolveOptions options;
  options.observer = &at_once;
  const CutProblem problem = testing::sheet_problem(24, 1);
  EXPECT_THROW((void)solver_->solve(problem, options), Cancelled);
  // The second poll comes from within the search, or from its end where a library cannot be
  // stopped.
  Stopper later(1);
  options.observer = &later;
  EXPECT_THROW((void)solver_->solve(problem, options), Cancelled);
  // Nothing is left behind.
  EXPECT_EQ(solver_->solve(problem).status, CutStatus::optimal);
}

INSTANTIATE_TEST_SUITE_P(Solvers, Solver, ::testing::ValuesIn(built_solvers()),
                         [](const auto& instance) { return instance.param; });

// ---- the table ----

TEST(SolverTable, ListsEveryVariantOnceBuiltOrWithAReason) {
  std::set<std::string> names;
  for (const auto& variant : solvers::registered()) {
    EXPECT_TRUE(names.insert(variant.name).second) << variant.name;
    EXPECT_EQ(variant.make == nullptr, !variant.not_built.empty()) << variant.name;
  }
  for (const char* name :
       {"bk", "push_relabel", "ibfs", "lp", "libmaxflow", "lemon_preflow", "clp"}) {
    EXPECT_EQ(names.count(name), 1U) << name;
  }
  EXPECT_THAT(built_solvers(), ::testing::IsSupersetOf({"bk", "push_relabel", "ibfs", "lp"}));
}

TEST(SolverTable, RefusesUnknownNamesAndListsWhatIsBuilt) {
  try {
    (void)solvers::make("simplex");
    FAIL() << "an unknown solver was made";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("simplex"));
    for (const std::string& name : built_solvers()) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(name));
    }
  }
}

}  // namespace
}  // namespace cellocut
