// Solvers that are wrong on purpose: the public solve() has to tell, whatever they return.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cellocut/cut/cut_solver.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;

// Returns the flow that it is given.
class Fixed final : public CutSolver {
 public:
  explicit Fixed(std::vector<std::int64_t> flow) : flow_(std::move(flow)) {}
  [[nodiscard]] const SolverInfo& info() const override { return info_; }

 private:
  SolverOutput do_solve(const CutProblem& /*problem*/, SolveContext& context) override {
    context.built();
    return {flow_, {}, 0};
  }
  std::vector<std::int64_t> flow_;
  SolverInfo info_;
};

// Source -> 0 -> 1 -> 2 -> sink; the maximum is 4, limited by the edge 1 -> 2.
CutProblem chain() { return {{9, 0, 0}, {0, 0, 6}, {{0, 1, 8, 2}, {1, 2, 4, 3}}, 5}; }

CutResult solve_with(std::vector<std::int64_t> flow) {
  return Fixed(std::move(flow)).solve(chain());
}

TEST(SolverDefect, AMaximumFlowPasses) {
  const CutResult result = solve_with({4, 4});
  EXPECT_EQ(result.status, CutStatus::optimal) << result.message;
  EXPECT_EQ(result.value, 9);
  EXPECT_EQ(result.lower_bound, 9);
  EXPECT_EQ(result.smallest_source_side, (CutLabels{1, 1, 0}));
  EXPECT_EQ(result.largest_source_side, (CutLabels{1, 1, 0}));
}

struct Defect {
  const char* name;
  std::vector<std::int64_t> flow;
  const char* message;
};

class SolverDefectFound : public ::testing::TestWithParam<Defect> {};

TEST_P(SolverDefectFound, IsReportedAsInvalid) {
  const CutResult result = solve_with(GetParam().flow);
  EXPECT_EQ(result.status, CutStatus::invalid);
  EXPECT_STREQ(to_string(result.status), "invalid");
  EXPECT_THAT(result.message, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Flows, SolverDefectFound,
    ::testing::Values(Defect{"none", {}, "size"}, Defect{"too_many", {4, 4, 0}, "size"},
                      Defect{"above_capacity", {5, 5}, "capacity of edge 1"},
                      Defect{"above_reverse_capacity", {-3, 0}, "capacity of edge 0"},
                      Defect{"preflow_with_excess", {8, 4}, "balance at node 1"},
                      Defect{"flow_from_nowhere", {0, 4}, "balance at node 1"},
                      Defect{"drawn_from_the_sink", {0, -3}, "balance at node 1"},
                      Defect{"zero_flow", {0, 0}, "not maximal"},
                      Defect{"one_unit_short", {3, 3}, "not maximal"}),
    [](const auto& instance) { return instance.param.name; });

TEST(SolverDefect, ATerminalIsOverdrawn) {
  // Ten units leave node 0, but only nine can come from the source.
  const CutProblem problem{{9, 0}, {0, 20}, {{0, 1, 12, 0}}, 0};
  const CutResult result = Fixed({10}).solve(problem);
  EXPECT_EQ(result.status, CutStatus::invalid);
  EXPECT_THAT(result.message, HasSubstr("balance at node 0"));
}

TEST(SolverDefect, TheSinkIsOverfilled) {
  const CutProblem problem{{20, 0}, {0, 9}, {{0, 1, 12, 0}}, 0};
  const CutResult result = Fixed({10}).solve(problem);
  EXPECT_EQ(result.status, CutStatus::invalid);
  EXPECT_THAT(result.message, HasSubstr("balance at node 1"));
}

}  // namespace
}  // namespace cellocut
