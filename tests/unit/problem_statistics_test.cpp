#include "cellocut/cut/problem_statistics.h"

#include <gtest/gtest.h>

#include <numeric>

#include "support/cut_problems.h"

namespace cellocut {
namespace {

CutProblem without_terminals(std::size_t nodes) {
  return {std::vector<std::int64_t>(nodes, 0), std::vector<std::int64_t>(nodes, 0), {}, 0};
}

TEST(ProblemStatistics, OfNothing) {
  const ProblemStatistics statistics = problem_statistics({});
  EXPECT_EQ(statistics.nodes, 0u);
  EXPECT_EQ(statistics.components, 0u);
  EXPECT_EQ(statistics.source_share, 0);
  EXPECT_EQ(statistics.degree.mean, 0);
}

TEST(ProblemStatistics, EveryCount) {
  // Nodes 0 1 2 in a path, 3 joined to 2 only by an edge without capacity, 4 has a loop.
  const CutProblem problem{{8, 0, 3, 0, 0},
                           {0, 0, 1, 2, 0},
                           {{0, 1, 1, 0}, {1, 2, 4, 7}, {2, 3, 0, 0}, {4, 4, 5, 5}},
                           9};
  const ProblemStatistics statistics = problem_statistics(problem);
  EXPECT_EQ(statistics.nodes, 5u);
  EXPECT_EQ(statistics.edges, 4u);
  EXPECT_EQ(statistics.loops, 1u);
  EXPECT_EQ(statistics.arcs, 3u);
  EXPECT_EQ(statistics.zero_capacities, 3u);
  EXPECT_EQ(statistics.source_nodes, 2u);
  EXPECT_EQ(statistics.sink_nodes, 2u);
  EXPECT_EQ(statistics.both_nodes, 1u);
  EXPECT_DOUBLE_EQ(statistics.source_share, 0.4);
  EXPECT_DOUBLE_EQ(statistics.sink_share, 0.4);
  EXPECT_DOUBLE_EQ(statistics.both_share, 0.2);
  EXPECT_EQ(statistics.degree.minimum, 0u);
  EXPECT_EQ(statistics.degree.median, 1u);
  EXPECT_EQ(statistics.degree.maximum, 2u);
  EXPECT_DOUBLE_EQ(statistics.degree.mean, 1.2);
  EXPECT_EQ(statistics.components, 3u);
  EXPECT_EQ(statistics.largest_component, 3u);
  EXPECT_EQ(statistics.diameter_lower_bound, 2u);
  CapacityHistogram edges{};
  edges[0] = 1;  // 1
  edges[2] = 2;  // 4 and 7
  EXPECT_EQ(statistics.edge_capacities, edges);
  CapacityHistogram terminals{};
  terminals[0] = 1;  // 1
  terminals[1] = 2;  // 2 and 3
  terminals[3] = 1;  // 8
  EXPECT_EQ(statistics.terminal_capacities, terminals);
}

TEST(ProblemStatistics, TheLargestCapacityHasABin) {
  const ProblemStatistics statistics = problem_statistics({{kCapacityLimit - 1}, {0}, {}, 0});
  EXPECT_EQ(statistics.terminal_capacities.back(), 1u);
}

TEST(ProblemStatistics, DiametersOfTreesAreExact) {
  constexpr std::uint32_t kNodes = 100;
  CutProblem path = without_terminals(kNodes);
  CutProblem star = without_terminals(kNodes);
  for (std::uint32_t i = 0; i + 1 < kNodes; ++i) {
    // Through the path in steps of 37, so that its ends are not its first and last node.
    path.edges.push_back({i * 37 % kNodes, (i + 1) * 37 % kNodes, 0, 1});
    star.edges.push_back({kNodes - 1, i, 1, 1});
  }
  EXPECT_EQ(problem_statistics(path, 1).diameter_lower_bound, kNodes - 1);
  EXPECT_EQ(problem_statistics(star, 1).diameter_lower_bound, 2u);
  EXPECT_EQ(problem_statistics(star).degree.maximum, kNodes - 1);
  EXPECT_EQ(problem_statistics(star).degree.median, 1u);
}

TEST(ProblemStatistics, TheFirstSweepIsInTheLargestComponent) {
  // A short path first, then a longer one.
  CutProblem problem = without_terminals(10);
  for (std::uint32_t i = 0; i < 9; ++i) {
    if (i != 2) problem.edges.push_back({i, i + 1, 1, 1});
  }
  const ProblemStatistics statistics = problem_statistics(problem, 1);
  EXPECT_EQ(statistics.components, 2u);
  EXPECT_EQ(statistics.largest_component, 7u);
  EXPECT_EQ(statistics.diameter_lower_bound, 6u);
  EXPECT_EQ(problem_statistics(problem, 0).diameter_lower_bound, 0u);
}

// Largest shortest distance in the edges that have capacity, by Floyd and Warshall.
std::uint64_t diameter(const CutProblem& problem) {
  constexpr std::uint64_t kFar = 1U << 30U;
  const std::size_t nodes = problem.node_count();
  std::vector<std::vector<std::uint64_t>> distance(nodes, std::vector<std::uint64_t>(nodes, kFar));
  for (std::size_t i = 0; i < nodes; ++i) distance[i][i] = 0;
  for (const CutEdge& edge : problem.edges) {
    if (edge.from == edge.to || edge.capacity + edge.reverse_capacity == 0) continue;
    distance[edge.from][edge.to] = distance[edge.to][edge.from] = 1;
  }
  std::uint64_t longest = 0;
  for (std::size_t k = 0; k < nodes; ++k) {
    for (std::size_t i = 0; i < nodes; ++i) {
      for (std::size_t j = 0; j < nodes; ++j) {
        distance[i][j] = std::min(distance[i][j], distance[i][k] + distance[k][j]);
      }
    }
  }
  for (const auto& row : distance) {
    for (const std::uint64_t d : row) {
      if (d < kFar) longest = std::max(longest, d);
    }
  }
  return longest;
}

TEST(ProblemStatistics, RandomProblems) {
  for (const testing::RandomShape shape :
       {testing::RandomShape::tiny, testing::RandomShape::dense, testing::RandomShape::huge,
        testing::RandomShape::many_ties}) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE(std::string(to_string(shape)) + ' ' + std::to_string(seed));
      const CutProblem problem = testing::random_problem(shape, seed);
      const ProblemStatistics statistics = problem_statistics(problem);
      EXPECT_EQ(statistics.arcs + statistics.zero_capacities,
                2 * (statistics.edges - statistics.loops));
      EXPECT_EQ(std::accumulate(statistics.edge_capacities.begin(),
                                statistics.edge_capacities.end(), std::uint64_t{0}),
                statistics.arcs);
      EXPECT_EQ(std::accumulate(statistics.terminal_capacities.begin(),
                                statistics.terminal_capacities.end(), std::uint64_t{0}),
                statistics.source_nodes + statistics.sink_nodes);
      const std::uint64_t exact = diameter(problem);
      EXPECT_LE(statistics.diameter_lower_bound, exact);
      EXPECT_GE(2 * statistics.diameter_lower_bound, statistics.components == 1 ? exact : 0)
          << "a sweep finds at least half of it";
      EXPECT_EQ(problem_statistics(problem, 4, 7).diameter_lower_bound,
                problem_statistics(problem, 4, 7).diameter_lower_bound);
    }
  }
}

}  // namespace
}  // namespace cellocut
