// Helpers of the tests of problem files.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cellocut/base/errors.h"
#include "cellocut/cut/problem_file.h"
#include "solvers/solvers.h"

namespace cellocut::testing {

inline CutResult solved(const CutProblem& problem) {
  return solvers::make("push_relabel")->solve(problem);
}

// What the reading of `text` throws as InputError; empty where it throws nothing.
inline std::string input_error(const std::function<void()>& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline void expect_same_terminals(const CutProblem& a, const CutProblem& b) {
  EXPECT_EQ(a.to_source, b.to_source);
  EXPECT_EQ(a.to_sink, b.to_sink);
  EXPECT_EQ(a.constant, b.constant);
}

inline void expect_same_problem(const CutProblem& a, const CutProblem& b) {
  expect_same_terminals(a, b);
  ASSERT_EQ(a.edges.size(), b.edges.size());
  for (std::size_t e = 0; e < a.edges.size(); ++e) {
    EXPECT_EQ(a.edges[e].from, b.edges[e].from) << "edge " << e;
    EXPECT_EQ(a.edges[e].to, b.edges[e].to) << "edge " << e;
    EXPECT_EQ(a.edges[e].capacity, b.edges[e].capacity) << "edge " << e;
    EXPECT_EQ(a.edges[e].reverse_capacity, b.edges[e].reverse_capacity) << "edge " << e;
  }
}

// Per ordered pair of different nodes that an edge joins, all capacity from the one to the other.
using PairCapacities = std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t>;

inline PairCapacities pair_capacities(const CutProblem& problem) {
  PairCapacities capacities;
  for (const CutEdge& edge : problem.edges) {
    if (edge.from == edge.to) continue;
    capacities[{edge.from, edge.to}] += edge.capacity;
    capacities[{edge.to, edge.from}] += edge.reverse_capacity;
  }
  return capacities;
}

// The same minimum cuts: value and both canonical labellings.
inline void expect_same_cuts(const CutProblem& a, const CutProblem& b) {
  const CutResult first = solved(a);
  const CutResult second = solved(b);
  EXPECT_EQ(first.value, second.value);
  EXPECT_EQ(first.smallest_source_side, second.smallest_source_side);
  EXPECT_EQ(first.largest_source_side, second.largest_source_side);
}

}  // namespace cellocut::testing
