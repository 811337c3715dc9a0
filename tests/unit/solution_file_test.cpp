// DIMACS solutions: written, read, and checked whoever found them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "problem_comparison.h"
#include "support/cut_problems.h"

namespace cellocut {
namespace {

using testing::solved;

// 1 -> 2 -> 3 -> 4 with an arc back, a loop, one into the source, one out of the sink, and one
// straight from source to sink.
const std::string kProblem =
    "p max 4 9\n"
    "n 1 s\n"
    "n 4 t\n"
    "a 1 2 9\n"
    "a 2 3 5\n"
    "a 2 3 3\n"
    "a 3 2 4\n"
    "a 3 4 7\n"
    "a 1 4 2\n"
    "a 2 1 6\n"
    "a 4 3 8\n"
    "a 2 2 1\n";

std::string checked(const std::string& solution) {
  return check_solution(parse_dimacs(kProblem), parse_solution(solution));
}

TEST(Solution, WhatIsWritten) {
  const DimacsProblem problem = parse_dimacs(kProblem);
  EXPECT_THAT(encode_solution(problem, solved(problem.problem)),
              ::testing::EndsWith("\ns 9\nf 1 4 2\nf 1 2 7\nf 3 4 7\nf 2 3 7\nf 3 2 0\n"));
}

TEST(Solution, BothKindsOfFlowLinesAreRead) {
  const FlowSolution read = parse_solution("c x\r\ns 9\r\n\r\nf 1 4 2\r\na 2 3 7\r\n");
  EXPECT_EQ(read.value, 9);
  EXPECT_EQ(read.flows, (std::vector<DimacsArc>{{1, 4, 2}, {2, 3, 7}}));
  EXPECT_EQ(parse_solution("s 0").flows.size(), 0u);
}

TEST(Solution, FeasibleFlowsPass) {
  EXPECT_EQ(checked("s 9\nf 1 2 7\nf 2 3 7\nf 3 4 7\nf 1 4 2\n"), "");
  EXPECT_EQ(checked("s 9\na 1 2 7\na 2 3 5\na 2 3 2\na 3 4 7\na 1 4 2\n"), "") << "arc by arc";
  EXPECT_EQ(checked("s 0\n"), "") << "no flow at all";
  EXPECT_EQ(checked("s 3\nf 1 2 3\nf 2 3 3\nf 3 4 3\n"), "") << "not maximum";
  EXPECT_EQ(checked("s 0\nf 2 3 4\nf 3 2 4\n"), "") << "a cycle";
  EXPECT_EQ(checked("s 3\nf 1 2 9\nf 2 1 6\nf 2 3 3\nf 3 4 3\n"), "") << "through the source";
  EXPECT_EQ(checked("s 1\nf 1 4 1\nf 3 4 7\nf 4 3 7\n"), "") << "through the sink";
  EXPECT_EQ(checked("s 1\nf 1 4 1\nf 2 2 1\nf 2 4 0\n"), "") << "a loop, and no flow on no arc";
}

TEST(Solution, DefectsAreNamed) {
  EXPECT_EQ(checked("s 10\nf 1 2 8\nf 2 3 8\nf 3 4 8\nf 1 4 2\n"),
            "flow 8 from 3 to 4 exceeds the capacity 7");
  EXPECT_EQ(checked("s 5\nf 1 2 9\nf 2 3 5\nf 2 3 4\n"),
            "flow 9 from 2 to 3 exceeds the capacity 8");
  EXPECT_EQ(checked("s 0\nf 2 3 5\nf 3 2 5\n"), "flow 5 from 3 to 2 exceeds the capacity 4");
  EXPECT_EQ(checked("s 2\nf 1 2 9\nf 2 1 7\n"), "flow 7 from 2 to 1 exceeds the capacity 6");
  EXPECT_EQ(checked("s 0\nf 2 2 2\n"), "flow 2 from 2 to 2 exceeds the capacity 1");
  EXPECT_EQ(checked("s 3\nf 1 4 3\n"), "flow 3 from 1 to 4 exceeds the capacity 2");
  EXPECT_EQ(checked("s 1\nf 2 4 1\n"), "flow 1 from 2 to 4, where no arc has capacity");
  EXPECT_EQ(checked("s 1\nf 4 1 1\n"), "flow 1 from 4 to 1, where no arc has capacity");
  EXPECT_EQ(checked("s 7\nf 1 2 7\nf 2 3 6\nf 3 4 7\n"), "at node 2 more flows in than out, by 1");
  EXPECT_EQ(checked("s 7\nf 1 2 6\nf 2 3 6\nf 3 4 7\n"), "at node 3 more flows out than in, by 1");
  EXPECT_EQ(checked("s 8\nf 1 2 7\nf 2 3 7\nf 3 4 7\n"),
            "the value is given as 8, but 7 flows out of the source");
  EXPECT_EQ(checked("s 1\n"), "the value is given as 1, but 0 flows out of the source");
  EXPECT_EQ(checked("s 1\nf 1 5 1\n"), "flow from 1 to 5, but the nodes are 1 to 4");
  // Together beyond 64 bits.
  EXPECT_EQ(checked("s 0\nf 2 3 9223372036854775807\nf 2 3 9223372036854775807\n"),
            "flow 18446744073709551614 from 2 to 3 exceeds the capacity 8");
  EXPECT_EQ(check_solution(parse_dimacs(kProblem), {0, {{2, 3, -1}}}), "negative flow from 2 to 3");
}

TEST(Solution, AFlowOfAnotherProblemIsAMistake) {
  const DimacsProblem problem = parse_dimacs(kProblem);
  CutResult result = solved(problem.problem);
  result.edge_flow.push_back(0);
  EXPECT_THROW((void)encode_solution(problem, result), UsageError);
}

void expect_solution(const DimacsProblem& problem) {
  const CutResult result = solved(problem.problem);
  ASSERT_EQ(result.status, CutStatus::optimal);
  const FlowSolution solution = parse_solution(encode_solution(problem, result));
  EXPECT_EQ(solution.value, result.value);
  EXPECT_EQ(check_solution(problem, solution), "");
  // As somebody else sees it who has nothing but our files.
  const DimacsProblem read = parse_dimacs(encode_dimacs(problem.problem, problem.nodes));
  EXPECT_EQ(check_solution(read, solution), "");
  // And one line of it changed: a unit less on one arc.
  for (std::size_t k = 0; k < solution.flows.size(); ++k) {
    if (solution.flows[k].amount == 0) continue;
    FlowSolution damaged = solution;
    --damaged.flows[k].amount;
    EXPECT_NE(check_solution(problem, damaged), "");
    break;
  }
}

TEST(Solution, OfKnownProblems) {
  for (const testing::NamedProblem& known : testing::known_problems()) {
    SCOPED_TRACE(known.name);
    expect_solution({known.problem, {}, {}});
  }
}

TEST(Solution, OfRandomProblems) {
  for (const testing::RandomShape shape : testing::random_shapes()) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      SCOPED_TRACE(std::string(to_string(shape)) + ' ' + std::to_string(seed));
      const CutProblem problem = testing::random_problem(shape, seed);
      const auto ids = static_cast<std::uint32_t>(problem.node_count() + 2);
      expect_solution({problem, {ids - 1, 1}, {}});
    }
  }
}

}  // namespace
}  // namespace cellocut
