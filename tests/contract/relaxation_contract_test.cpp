// What a relaxation owes its callers beyond what every solver does: a labelling, a bound that is
// proved, a reason why it stopped, the same bits for any number of threads; and that the shared
// code finds out a relaxation that is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cellocut/base/errors.h"
#include "solvers/comparison.h"
#include "solvers/solvers.h"
#include "support/cut_problems.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;
using testing::NamedProblem;
using testing::RandomShape;

SolveOptions without_crossover() {
  SolveOptions options;
  options.relaxation.crossover = false;
  options.relaxation.iteration_limit = 4000;
  return options;
}

void expect_between(const CutLabels& labels, const CutResult& exact) {
  ASSERT_EQ(labels.size(), exact.smallest_source_side.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    EXPECT_GE(labels[i], exact.smallest_source_side[i]) << i;
    EXPECT_LE(labels[i], exact.largest_source_side[i]) << i;
  }
}

// Returns whether the value was proved.
bool expect_relaxation(const CutProblem& problem, const CutResult& result, const CutResult& exact) {
  EXPECT_NE(result.status, CutStatus::invalid) << result.message;
  EXPECT_FALSE(result.canonical);
  EXPECT_TRUE(result.edge_flow.empty());
  EXPECT_EQ(result.smallest_source_side, result.largest_source_side);
  EXPECT_EQ(result.value, cut_cost(problem, result.largest_source_side));
  EXPECT_EQ(result.relaxed.size(), problem.node_count());
  EXPECT_LE(result.lower_bound, exact.value);
  EXPECT_GE(result.value, exact.value);
  const bool proved = result.status == CutStatus::optimal;
  EXPECT_EQ(proved, result.stop == "proof") << result.stop;
  EXPECT_EQ(proved, result.value == result.lower_bound);
  if (proved) {
    EXPECT_EQ(result.value, exact.value);
    expect_between(result.largest_source_side, exact);
  }
  return proved;
}

TEST(Relaxation, ProvesTheKnownAnswersByItsBound) {
  for (const NamedProblem& known : testing::known_problems()) {
    SCOPED_TRACE(known.name);
    const CutResult result = solvers::make("lp")->solve(known.problem, without_crossover());
    const CutResult exact = solvers::make("bk")->solve(known.problem);
    const bool proved = expect_relaxation(known.problem, result, exact);
    // Cuts that differ by a unit in 2^60 are beyond the numbers of the iteration.
    EXPECT_TRUE(proved || testing::capacity_sum(known.problem) >= std::int64_t{1} << 53);
  }
}

class RelaxedShape : public ::testing::TestWithParam<RandomShape> {};

TEST_P(RelaxedShape, EnclosesTheExactValue) {
  constexpr std::uint64_t kSeeds = 20;
  std::uint64_t proved = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const CutProblem problem = testing::random_problem(GetParam(), seed);
    const CutResult exact = solvers::make("ibfs")->solve(problem);
    proved +=
        expect_relaxation(problem, solvers::make("lp")->solve(problem, without_crossover()), exact)
            ? 1
            : 0;
    if (HasFailure()) break;
  }
  RecordProperty("proved", static_cast<int>(proved));
  EXPECT_GE(2 * proved, kSeeds);
}

TEST_P(RelaxedShape, CrossesOverToAMaximumFlowFromWhereverItStops) {
  const CutProblem problem = testing::random_problem(GetParam(), 3);
  const CutResult exact = solvers::make("ibfs")->solve(problem);
  for (const std::int64_t iterations : {1, 32, 256}) {
    SolveOptions options;
    options.relaxation.iteration_limit = iterations;
    const CutResult result = solvers::make("lp")->solve(problem, options);
    EXPECT_EQ(result.status, CutStatus::optimal) << result.message;
    EXPECT_TRUE(result.canonical);
    EXPECT_EQ(result.value, exact.value);
    EXPECT_EQ(result.smallest_source_side, exact.smallest_source_side);
    EXPECT_EQ(result.largest_source_side, exact.largest_source_side);
    const auto added = std::find_if(result.counters.begin(), result.counters.end(),
                                    [](const auto& c) { return c.first == "crossover_added"; });
    ASSERT_NE(added, result.counters.end());
    if (result.stop == "proof") {
      EXPECT_EQ(added->second, 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, RelaxedShape, ::testing::ValuesIn(testing::random_shapes()),
                         [](const auto& instance) { return testing::to_string(instance.param); });

// All capacities together are one below the limit, so nothing that is posed on the way may hold
// more.
TEST(Relaxation, CrossesOverAtTheLimitOfCapacities) {
  CutProblem problem;
  problem.to_source = {0, 188325101316185847};
  problem.to_sink = {0, 0};
  problem.edges = {{1, 0, kCapacityLimit - 1 - problem.to_source[1], 0}};
  const CutResult result = solvers::make("lp")->solve(problem);
  EXPECT_EQ(result.status, CutStatus::optimal) << result.message;
  EXPECT_EQ(result.value, 0);
}

TEST(Relaxation, IsTheSameBitForBitWithOneTwoAndEightThreads) {
  const CutProblem problem = testing::sheet_problem(24, 5);
  SolveOptions options = without_crossover();
  for (const std::int64_t iterations : {100, 1000}) {
    options.relaxation.iteration_limit = iterations;
    std::vector<CutResult> results;
    for (const std::size_t threads : {1, 2, 8}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      results.push_back(solvers::make("lp")->solve(problem, options));
    }
    for (const CutResult& result : results) {
      EXPECT_EQ(result.value, results[0].value);
      EXPECT_EQ(result.lower_bound, results[0].lower_bound);
      EXPECT_EQ(result.relaxed, results[0].relaxed);
      EXPECT_EQ(result.counters, results[0].counters);
      EXPECT_EQ(result.largest_source_side, results[0].largest_source_side);
    }
  }
}

// ---- why it stops ----

TEST(RelaxationStop, AtTheIterationLimit) {
  SolveOptions options = without_crossover();
  options.relaxation.iteration_limit = 3;
  const CutResult result = solvers::make("lp")->solve(testing::sheet_problem(16, 1), options);
  EXPECT_EQ(result.stop, "iteration limit");
  EXPECT_EQ(result.status, CutStatus::gap);
  EXPECT_STREQ(to_string(result.status), "gap");
  EXPECT_LT(result.lower_bound, result.value);
}

TEST(RelaxationStop, AtTheTimeLimit) {
  SolveOptions options = without_crossover();
  options.relaxation.seconds_limit = 1e-9;
  const CutResult result = solvers::make("lp")->solve(testing::sheet_problem(16, 1), options);
  EXPECT_EQ(result.stop, "time limit");
  EXPECT_EQ(result.status, CutStatus::gap);
}

TEST(RelaxationStop, AtTheGap) {
  SolveOptions options = without_crossover();
  options.relaxation.relative_gap = 0.9;
  const CutResult result = solvers::make("lp")->solve(testing::noisy_ball_problem(12, 1), options);
  ASSERT_TRUE(result.stop == "gap" || result.stop == "proof") << result.stop;
  EXPECT_LE(static_cast<double>(result.value - result.lower_bound),
            0.9 * static_cast<double>(result.value));
}

TEST(RelaxationStop, RefusesLimitsThatMakeNoSense) {
  const CutProblem problem{{3}, {2}, {}, 0};
  const auto expect_refused = [&](auto&& spoil) {
    SolveOptions options;
    spoil(options.relaxation);
    EXPECT_THROW((void)solvers::make("lp")->solve(problem, options), UsageError);
  };
  expect_refused([](RelaxationOptions& o) { o.relative_gap = -1; });
  expect_refused([](RelaxationOptions& o) { o.relative_gap = std::nan(""); });
  expect_refused([](RelaxationOptions& o) { o.seconds_limit = -1; });
  expect_refused([](RelaxationOptions& o) { o.iteration_limit = 0; });
}

// ---- relaxations that are wrong on purpose ----

class Fixed final : public CutSolver {
 public:
  explicit Fixed(RelaxedOutput output, bool exact = false) : output_(std::move(output)) {
    info_.exact = exact;
    info_.name = "fixed";
  }
  [[nodiscard]] const SolverInfo& info() const override { return info_; }

 private:
  SolverOutput do_solve(const CutProblem& /*problem*/, SolveContext& context) override {
    context.built();
    SolverOutput output;
    output.relaxed = output_;
    return output;
  }
  RelaxedOutput output_;
  SolverInfo info_;
};

constexpr DualFlow kUnit = DualFlow{1} << kDualFlowBits;

// Source -> 0 -> 1 -> sink with a share of 2^62 on every arc; the minimum is the edge.
struct Case {
  CutProblem problem;
  RelaxedOutput output;
};

Case sound_case(std::int64_t size) {
  Case c;
  c.problem = {{3 * size, 0}, {0, 3 * size}, {{0, 1, 2 * size, size}}, 7};
  c.output.labels = {1, 0};
  c.output.dual_flow = {2 * size * kUnit};
  c.output.value = 2 * size + 7;
  c.output.lower_bound = 2 * size + 7;
  c.output.relaxed = {1, 0};
  c.output.stop = "proof";
  return c;
}

class WrongRelaxation : public ::testing::TestWithParam<std::int64_t> {
 protected:
  template <class Spoil>
  void expect_invalid(const char* message, const Spoil& spoil) {
    Case c = sound_case(GetParam());
    spoil(c.output);
    const CutResult result = Fixed(c.output).solve(c.problem, without_crossover());
    EXPECT_EQ(result.status, CutStatus::invalid) << message;
    EXPECT_THAT(result.message, HasSubstr(message));
  }
};

TEST_P(WrongRelaxation, ASoundOnePasses) {
  const Case c = sound_case(GetParam());
  const CutResult result = Fixed(c.output).solve(c.problem, without_crossover());
  EXPECT_EQ(result.status, CutStatus::optimal) << result.message;
  EXPECT_EQ(result.value, 2 * GetParam() + 7);
}

TEST_P(WrongRelaxation, IsInvalid) {
  expect_invalid("claimed", [](RelaxedOutput& o) { o.value -= 1; });
  expect_invalid("claimed", [](RelaxedOutput& o) { o.lower_bound += 1; });
  expect_invalid("claimed", [](RelaxedOutput& o) { o.labels = {0, 0}; });
  expect_invalid("claimed", [](RelaxedOutput& o) { o.dual_flow[0] -= kUnit; });
  expect_invalid("capacity of edge 0", [](RelaxedOutput& o) { o.dual_flow[0] += 1; });
  expect_invalid("capacity of edge 0", [](RelaxedOutput& o) { o.dual_flow[0] *= -1; });
  expect_invalid("capacity of edge 0", [](RelaxedOutput& o) { o.dual_flow[0] *= kUnit; });
  expect_invalid("valid label", [](RelaxedOutput& o) { o.labels[1] = 2; });
  expect_invalid("labelling has the wrong size", [](RelaxedOutput& o) { o.labels.clear(); });
  expect_invalid("dual flow has the wrong size", [](RelaxedOutput& o) { o.dual_flow.clear(); });
  expect_invalid("relaxed values have", [](RelaxedOutput& o) { o.relaxed.pop_back(); });
  expect_invalid("relaxed value of node 0", [](RelaxedOutput& o) { o.relaxed[0] = 1.5F; });
  expect_invalid("relaxed value of node 1",
                 [](RelaxedOutput& o) { o.relaxed[1] = std::numeric_limits<float>::quiet_NaN(); });
  expect_invalid("stopped at", [](RelaxedOutput& o) { o.stop = "gap"; });
  // A gap that is called a proof.
  expect_invalid("claims a proof", [](RelaxedOutput& o) {
    o.dual_flow[0] -= kUnit;
    o.lower_bound -= 1;
  });
}

TEST_P(WrongRelaxation, ABoundIsRoundedUpAndNoFurther) {
  Case c = sound_case(GetParam());
  // One step of 2^-24 below the unit still proves it, a whole unit below does not.
  c.output.dual_flow[0] -= kUnit - 1;
  EXPECT_EQ(Fixed(c.output).solve(c.problem, without_crossover()).status, CutStatus::optimal);
  c.output.dual_flow[0] -= 1;
  c.output.lower_bound -= 1;
  c.output.stop = "time limit";
  const CutResult result = Fixed(c.output).solve(c.problem, without_crossover());
  EXPECT_EQ(result.status, CutStatus::gap) << result.message;
  EXPECT_EQ(result.stop, "time limit");
}

// The sum of all capacities is 9 times the size plus 7.
INSTANTIATE_TEST_SUITE_P(Sizes, WrongRelaxation,
                         ::testing::Values(std::int64_t{5}, std::int64_t{1} << 40,
                                           (kCapacityLimit - 8) / 9),
                         [](const auto& instance) {
                           return "size_" + std::to_string(instance.param);
                         });

TEST(WrongRelaxationOutput, AnExactSolverMayNotLeaveOutItsFlow) {
  const Case c = sound_case(5);
  EXPECT_EQ(Fixed(c.output, true).solve(c.problem, without_crossover()).status, CutStatus::invalid);
  // Nor may a relaxation that was asked for one.
  EXPECT_EQ(Fixed(c.output).solve(c.problem).status, CutStatus::invalid);
}

// ---- against the others ----

class Disagreement : public ::testing::Test {
 protected:
  void SetUp() override {
    problem_ = testing::known_problems().front().problem;
    for (const NamedProblem& known : testing::known_problems()) {
      if (known.name == "tie_inside_a_chain") problem_ = known.problem;
    }
    solvers::ComparisonOptions options;
    options.solvers = {"bk", "lp"};
    options.relaxation = without_crossover().relaxation;
    runs_ = solvers::compare_solvers(problem_, options);
    ASSERT_EQ(solvers::find_disagreement(runs_), "");
    ASSERT_EQ(runs_[1].result.status, CutStatus::optimal);
  }
  CutProblem problem_;
  std::vector<solvers::SolverRun> runs_;
  CutResult& relaxed() { return runs_[1].result; }
};

TEST_F(Disagreement, AProofOfAnotherValueIsFound) {
  relaxed().value += 1;
  relaxed().lower_bound += 1;
  EXPECT_THAT(solvers::find_disagreement(runs_), HasSubstr("'lp'"));
  relaxed().lower_bound = relaxed().value -= 2;
  EXPECT_THAT(solvers::find_disagreement(runs_), HasSubstr("'lp'"));
}

TEST_F(Disagreement, ALabellingOutsideTheCanonicalOnesIsFound) {
  relaxed().smallest_source_side = relaxed().largest_source_side = {0, 0, 0, 1};
  EXPECT_THAT(solvers::find_disagreement(runs_), HasSubstr("canonical"));
}

TEST_F(Disagreement, AGapMustEncloseTheValue) {
  relaxed().status = CutStatus::gap;
  relaxed().lower_bound -= 1;
  EXPECT_EQ(solvers::find_disagreement(runs_), "");
  relaxed().value += 5;
  EXPECT_EQ(solvers::find_disagreement(runs_), "");
  relaxed().lower_bound += 2;
  EXPECT_THAT(solvers::find_disagreement(runs_), HasSubstr("lower bound"));
  relaxed().lower_bound -= 2;
  relaxed().value -= 7;
  EXPECT_THAT(solvers::find_disagreement(runs_), HasSubstr("'lp'"));
}

}  // namespace
}  // namespace cellocut
