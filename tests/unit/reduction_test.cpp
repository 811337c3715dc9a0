// Reductions of minimum cut problems: what each rule removes, worked out by hand, and that a flow
// of what is left, lifted, is a maximum flow of the whole.
#include "cellocut/cut/reduction.h"

#include <gtest/gtest.h>

#include "cellocut/cut/cut_solver.h"
#include "solvers/solvers.h"
#include "support/cut_families.h"
#include "support/cut_problems.h"

namespace cellocut {
namespace {

// Hands a flow to the contract, which checks capacities, balances and that it is maximum.
class GivenFlow final : public CutSolver {
 public:
  explicit GivenFlow(std::vector<std::int64_t> flow) : flow_(std::move(flow)) {}
  [[nodiscard]] const SolverInfo& info() const override { return info_; }

 private:
  SolverOutput do_solve(const CutProblem& /*problem*/, SolveContext& context) override {
    context.built();
    SolverOutput output;
    output.edge_flow = flow_;
    return output;
  }
  SolverInfo info_{.name = "given", .summary = {}, .licence = {}, .reference = {}};
  std::vector<std::int64_t> flow_;
};

void expect_lifts(const CutProblem& problem, const ReductionRules& rules) {
  const Reduction reduction(problem, rules);
  EXPECT_NO_THROW(reduction.problem().validate());
  const CutResult left = solvers::make("bk")->solve(reduction.problem());
  ASSERT_EQ(left.status, CutStatus::optimal);
  const CutResult lifted = GivenFlow(reduction.lift(left.edge_flow)).solve(problem);
  const CutResult direct = solvers::make("bk")->solve(problem);
  EXPECT_EQ(lifted.status, CutStatus::optimal) << lifted.message;
  EXPECT_EQ(lifted.value, direct.value);
  EXPECT_EQ(lifted.smallest_source_side, direct.smallest_source_side);
  EXPECT_EQ(lifted.largest_source_side, direct.largest_source_side);
}

struct NamedRules {
  const char* name;
  ReductionRules rules;
};
const NamedRules kRules[] = {{"all", {true, true, true}},
                             {"none", {false, false, false}},
                             {"unreachable", {true, false, false}},
                             {"dominated", {false, true, false}},
                             {"heavy_edges", {false, false, true}}};

TEST(Reduction, LiftsKnownProblems) {
  for (const testing::NamedProblem& known : testing::known_problems()) {
    for (const auto& [name, rules] : kRules) {
      SCOPED_TRACE(known.name + " " + name);
      expect_lifts(known.problem, rules);
    }
  }
}

TEST(Reduction, LiftsRandomProblems) {
  for (const testing::RandomShape shape : testing::random_shapes()) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      for (const auto& [name, rules] : kRules) {
        SCOPED_TRACE(std::string(testing::to_string(shape)) + " " + std::to_string(seed) + name);
        expect_lifts(testing::random_problem(shape, seed), rules);
      }
    }
  }
}

TEST(Reduction, LiftsFamilies) {
  for (const testing::FamilyMember& member : testing::cut_families(1000, 1)) {
    SCOPED_TRACE(member.name);
    expect_lifts(member.problem, {});
  }
}

TEST(Reduction, RefusesNothingAndKeepsNothingOfAnEmptyProblem) {
  const Reduction reduction(CutProblem{});
  EXPECT_EQ(reduction.problem().node_count(), 0U);
  EXPECT_TRUE(reduction.lift({}).empty());
}

// 0 - 1 can be fed and drained; 2 - 3 has sources alone, 4 - 5 sinks alone, 6 - 7 nothing, and 8
// has no edge.
TEST(Reduction, DropsWhatCannotReachBothTerminals) {
  CutProblem problem{{9, 0, 3, 3, 0, 0, 0, 0, 1}, {0, 9, 0, 0, 2, 2, 0, 0, 0}, {}, 0};
  for (const std::uint32_t i : {0U, 2U, 4U, 6U}) problem.edges.push_back({i, i + 1, 5, 5});
  const Reduction reduction(problem, {true, false, false});
  EXPECT_EQ(reduction.counts().unreachable, 6);
  EXPECT_EQ(reduction.counts().isolated, 1);
  EXPECT_EQ(reduction.problem().node_count(), 2U);
  EXPECT_EQ(reduction.problem().edges.size(), 1U);
}

// A source of 10 with arcs of 3 and 4 gives its two neighbours sources of 3 and 4.
TEST(Reduction, ADominatedNodeBecomesSourcesOfItsNeighbours) {
  const CutProblem problem{
      {10, 0, 0}, {0, 2, 1}, {{0, 1, 3, 8}, {2, 0, 8, 4}, {1, 2, 100, 100}}, 0};
  const Reduction reduction(problem, {false, true, false});
  EXPECT_EQ(reduction.counts().dominated, 1);
  EXPECT_EQ(reduction.problem().to_source, (std::vector<std::int64_t>{3 - 2, 4 - 1}));
  const CutResult left = solvers::make("bk")->solve(reduction.problem());
  EXPECT_EQ(reduction.lift(left.edge_flow), (std::vector<std::int64_t>{2, -1, 0}));
}

// Joining the leaves wakes their hub each time, which must not walk over all that have gone.
TEST(Reduction, TakesLeavesOffAHubInNoMoreThanAFewStepsEach) {
  constexpr std::uint32_t kLeaves = 1'000'000;
  CutProblem problem;
  problem.to_source.assign(kLeaves + 2, 0);
  problem.to_sink.assign(kLeaves + 2, 0);
  problem.to_source[kLeaves] = 5;
  problem.to_sink[kLeaves + 1] = 4;
  for (std::uint32_t i = 0; i < kLeaves; ++i) problem.edges.push_back({i, kLeaves, 1, 1});
  problem.edges.push_back({kLeaves, kLeaves + 1, 3, 3});
  const Reduction joined(problem, {.unreachable = false, .dominated = false, .heavy_edges = true});
  EXPECT_GE(joined.counts().heavy_edges, kLeaves);
  const Reduction all(problem);
  const std::vector<std::int64_t> flow =
      all.lift(solvers::make("bk")->solve(all.problem()).edge_flow);
  EXPECT_EQ(GivenFlow(flow).solve(problem).value, 3);
}

// Labels of a minimum cut of what is left, lifted, are those of a minimum cut of the whole.
TEST(Reduction, LiftsLabels) {
  for (const testing::RandomShape shape : testing::random_shapes()) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
      SCOPED_TRACE(std::string(testing::to_string(shape)) + " " + std::to_string(seed));
      const CutProblem problem = testing::random_problem(shape, seed);
      const Reduction reduction(problem);
      const CutLabels left = solvers::make("bk")->solve(reduction.problem()).smallest_source_side;
      const std::vector<float> lifted =
          reduction.lift_values(std::vector<float>(left.begin(), left.end()));
      EXPECT_EQ(cut_cost(problem, CutLabels(lifted.begin(), lifted.end())),
                solvers::make("bk")->solve(problem).value);
    }
  }
}

// A chain whose weakest link is the second: the ends of the others are joined.
TEST(Reduction, AChainKeepsItsWeakestEdge) {
  const CutProblem problem{
      {10, 0, 0, 0}, {0, 0, 0, 10}, {{0, 1, 9, 9}, {1, 2, 4, 4}, {2, 3, 8, 8}}, 0};
  const Reduction reduction(problem, {false, false, true});
  EXPECT_EQ(reduction.counts().heavy_edges, 2);
  ASSERT_EQ(reduction.problem().edges.size(), 1U);
  EXPECT_EQ(reduction.problem().edges[0].capacity, 4);
}

}  // namespace
}  // namespace cellocut
