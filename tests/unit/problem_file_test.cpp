// DIMACS problems, read and written.
#include "cellocut/cut/problem_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "problem_comparison.h"
#include "support/cut_problems.h"

namespace cellocut {
namespace {

using testing::expect_same_cuts;
using testing::expect_same_problem;
using testing::expect_same_terminals;
using testing::solved;

TEST(Dimacs, AKnownProblem) {
  // The example of the format's description; its maximum flow is 15.
  const DimacsProblem read = parse_dimacs(
      "c A comment.\n"
      "p max 6 8\n"
      "n 1 s\n"
      "n 6 t\n"
      "a 1 2 5\n"
      "a 1 3 15\n"
      "a 2 4 5\n"
      "a 2 5 5\n"
      "a 3 4 5\n"
      "a 3 5 5\n"
      "a 4 6 15\n"
      "a 5 6 5\n");
  EXPECT_EQ(read.nodes.source, 1u);
  EXPECT_EQ(read.nodes.sink, 6u);
  EXPECT_TRUE(read.left_out.empty());
  expect_same_problem(
      read.problem,
      {{5, 15, 0, 0}, {0, 0, 15, 5}, {{0, 2, 5, 0}, {0, 3, 5, 0}, {1, 2, 5, 0}, {1, 3, 5, 0}}, 0});
  EXPECT_EQ(solved(read.problem).value, 15);
}

TEST(Dimacs, EveryKindOfArc) {
  // Source 3, sink 1, so that nodes 2, 4 and 5 become 0, 1 and 2.
  const DimacsProblem read = parse_dimacs(
      "p max 5 16\n"
      "n 1 t\n"
      "n 3 s\n"
      "a 5 4 1\n"   // edge 0, backwards
      "a 2 4 10\n"  // edge 1
      "a 4 2 20\n"  // opposite
      "a 2 4 30\n"  // parallel
      "a 4 5 2\n"   // opposite of the first
      "a 4 4 99\n"  // loop
      "a 3 2 7\n"   // from the source, twice
      "a 3 2 8\n"
      "a 5 1 6\n"  // to the sink
      "a 2 1 5\n"  // both terminals at one node
      "a 3 1 4\n"  // source to sink, twice
      "a 3 1 3\n"
      "a 4 3 50\n"   // into the source
      "a 1 4 60\n"   // out of the sink
      "a 1 3 70\n"   // from the sink to the source
      "a 2 5 0\n");  // edge 2, without capacity
  EXPECT_EQ(read.nodes.source, 3u);
  EXPECT_EQ(read.nodes.sink, 1u);
  expect_same_problem(read.problem,
                      {{15, 0, 0}, {5, 0, 6}, {{2, 1, 1, 2}, {0, 1, 40, 20}, {0, 2, 0, 0}}, 4 + 3});
  EXPECT_EQ(read.left_out,
            (std::vector<DimacsArc>{{4, 4, 99}, {4, 3, 50}, {1, 4, 60}, {1, 3, 70}}));
  // By hand: 7 straight through, 5 at node 0, 2 along 0 -> 1 -> 2.
  EXPECT_EQ(solved(read.problem).value, 7 + 5 + 2);
}

TEST(Dimacs, LineEndsBlanksAndComments) {
  const std::string text =
      "c first\n\np max 4 3\nc between\nn 1 s\nn 4 t\na 1 2 9\nc a 1 2 100\na 2 3 8\na 3 4 7\n";
  const CutProblem expected{{9, 0}, {0, 7}, {{0, 1, 8, 0}}, 0};
  expect_same_problem(parse_dimacs(text).problem, expected);

  std::string windows;
  std::string blanks;
  for (const char c : text) {
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    blanks += c == ' '
                  ? std::string(" \t ")
                  : std::string(c == '\n' ? " \n  " : "") + (c == '\n' ? "" : std::string(1, c));
  }
  expect_same_problem(parse_dimacs(windows).problem, expected);
  expect_same_problem(parse_dimacs(blanks).problem, expected);
  expect_same_problem(parse_dimacs(text.substr(0, text.size() - 1)).problem, expected);
}

TEST(Dimacs, TheLargestCapacities) {
  // 2^61 and 2^61 - 1 sum to 2^62 - 1.
  const DimacsProblem read = parse_dimacs(
      "p max 3 2\nn 1 s\nn 3 t\na 1 2 2305843009213693952\na 2 3 2305843009213693951\n");
  EXPECT_EQ(solved(read.problem).value, (std::int64_t{1} << 61) - 1);
  // What is left out does not count.
  const DimacsProblem large = parse_dimacs(
      "p max 3 4\nn 1 s\nn 3 t\na 2 1 9223372036854775807\na 2 2 9223372036854775807\n"
      "a 1 2 2305843009213693952\na 2 3 2305843009213693951\n");
  expect_same_problem(large.problem, read.problem);
  ASSERT_EQ(large.left_out.size(), 2u);
  EXPECT_EQ(large.left_out[0].amount, std::numeric_limits<std::int64_t>::max());
}

TEST(Dimacs, TheSmallestFiles) {
  const CutProblem none = parse_dimacs("p max 2 0\nn 2 s\nn 1 t\n").problem;
  EXPECT_EQ(none.node_count(), 0u);
  EXPECT_EQ(none.constant, 0);
  const CutProblem isolated = parse_dimacs("p max 5 0\nn 2 s\nn 4 t\n").problem;
  EXPECT_EQ(isolated.node_count(), 3u);
  EXPECT_EQ(solved(isolated).value, 0);
}

TEST(Dimacs, WhatIsWritten) {
  const CutProblem problem{{7, 0, 0},
                           {3, 0, 9},
                           {{0, 1, 4, 2}, {2, 1, 0, 5}, {1, 1, 6, 6}, {0, 2, 0, 0}, {1, 2, 1, 0}},
                           1000};
  EXPECT_THAT(encode_dimacs(problem), ::testing::EndsWith("p max 5 10\n"
                                                          "n 1 s\n"
                                                          "n 2 t\n"
                                                          "a 1 2 1000\n"
                                                          "a 1 3 7\n"
                                                          "a 3 2 3\n"
                                                          "a 5 2 9\n"
                                                          "a 3 4 4\n"
                                                          "a 4 3 2\n"
                                                          "a 5 4 0\n"
                                                          "a 4 5 5\n"
                                                          "a 3 5 0\n"
                                                          "a 4 5 1\n"));
}

TEST(Dimacs, NodesAndIds) {
  for (std::uint32_t source = 1; source <= 5; ++source) {
    for (std::uint32_t sink = 1; sink <= 5; ++sink) {
      if (source == sink) continue;
      const DimacsNodes nodes{source, sink};
      std::vector<std::uint32_t> ids;
      for (std::uint32_t node = 0; node < 3; ++node) {
        ids.push_back(nodes.id(node));
        EXPECT_EQ(nodes.node(ids.back()), node);
      }
      std::vector<std::uint32_t> expected;
      for (std::uint32_t id = 1; id <= 5; ++id) {
        if (id != source && id != sink) expected.push_back(id);
      }
      EXPECT_EQ(ids, expected) << source << ' ' << sink;

      const CutProblem problem{{7, 0, 1}, {0, 2, 9}, {{0, 1, 4, 2}, {2, 0, 3, 0}}, 5};
      const DimacsProblem read = parse_dimacs(encode_dimacs(problem, nodes));
      EXPECT_EQ(read.nodes.source, source);
      EXPECT_EQ(read.nodes.sink, sink);
      expect_same_problem(read.problem, problem);
    }
  }
  const CutProblem problem{{7}, {3}, {}, 0};
  EXPECT_THROW((void)encode_dimacs(problem, {1, 1}), UsageError);
  EXPECT_THROW((void)encode_dimacs(problem, {0, 1}), UsageError);
  EXPECT_THROW((void)encode_dimacs(problem, {1, 4}), UsageError);
  EXPECT_NO_THROW((void)encode_dimacs(problem, {1, 3}));
}

void expect_round_trip(const CutProblem& problem) {
  const CutProblem read = parse_dimacs(encode_dimacs(problem)).problem;
  expect_same_terminals(read, problem);
  const auto pairs = testing::pair_capacities(problem);
  EXPECT_EQ(testing::pair_capacities(read), pairs);
  EXPECT_EQ(read.edges.size(), pairs.size() / 2) << "an edge per unordered pair";
  expect_same_cuts(read, problem);
  // Nothing is left to merge, so from here on it stays as it is.
  expect_same_problem(parse_dimacs(encode_dimacs(read)).problem, read);
}

TEST(Dimacs, RoundTripsOfKnownProblems) {
  for (const testing::NamedProblem& known : testing::known_problems()) {
    SCOPED_TRACE(known.name);
    expect_round_trip(known.problem);
  }
}

TEST(Dimacs, RoundTripsOfRandomProblems) {
  constexpr std::uint64_t kSeeds = 5;
  for (const testing::RandomShape shape : testing::random_shapes()) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      SCOPED_TRACE(std::string(to_string(shape)) + ' ' + std::to_string(seed));
      expect_round_trip(testing::random_problem(shape, seed));
    }
  }
}

TEST(Dimacs, EdgesComeInTheOrderOfFirstAppearance) {
  // All pairs of seven nodes, once downwards and once upwards, in a scrambled order.
  constexpr std::uint32_t kNodes = 7;
  std::vector<DimacsArc> arcs;
  for (std::uint32_t from = 1; from <= kNodes; ++from) {
    for (std::uint32_t to = 1; to <= kNodes; ++to) {
      if (from != to) arcs.push_back({from + 2, to + 2, 100 * from + to});
    }
  }
  std::vector<DimacsArc> scrambled;
  constexpr std::size_t kStep = 11;  // no divisor of 42
  for (std::size_t k = 0; k < arcs.size(); ++k) scrambled.push_back(arcs[k * kStep % arcs.size()]);
  std::string text = "p max 9 42\nn 1 s\nn 2 t\n";
  std::vector<CutEdge> expected;
  for (const DimacsArc& arc : scrambled) {
    text += "a " + std::to_string(arc.from) + ' ' + std::to_string(arc.to) + ' ' +
            std::to_string(arc.amount) + '\n';
    const std::uint32_t from = arc.from - 3;
    const std::uint32_t to = arc.to - 3;
    const auto opposite = std::find_if(expected.begin(), expected.end(), [&](const CutEdge& edge) {
      return edge.from == to && edge.to == from;
    });
    if (opposite == expected.end()) {
      expected.push_back({from, to, arc.amount, 0});
    } else {
      opposite->reverse_capacity = arc.amount;
    }
  }
  const CutProblem read = parse_dimacs(text).problem;
  ASSERT_EQ(read.edges.size(), 21u);
  expect_same_problem(read, {std::vector<std::int64_t>(kNodes, 0),
                             std::vector<std::int64_t>(kNodes, 0), expected, 0});
}

}  // namespace
}  // namespace cellocut
