// LEMON reads what we write and we read what LEMON writes, with the same maximum flow.
// LEMON copies node records before it fills them in; with the sanitizers g++ warns of it here.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include <gtest/gtest.h>
#include <lemon/dimacs.h>
#include <lemon/preflow.h>
#include <lemon/smart_graph.h>

#include <random>
#include <sstream>

#include "problem_comparison.h"
#include "support/cut_problems.h"

namespace cellocut {
namespace {

using Digraph = lemon::SmartDigraph;
using Capacities = Digraph::ArcMap<std::int64_t>;

std::int64_t lemon_value(const Digraph& graph, const Capacities& capacities, Digraph::Node source,
                         Digraph::Node sink) {
  lemon::Preflow<Digraph, Capacities> preflow(graph, capacities, source, sink);
  preflow.run();
  return preflow.flowValue();
}

std::int64_t lemon_value_of_file(const std::string& text) {
  std::istringstream stream(text);
  Digraph graph;
  Capacities capacities(graph);
  Digraph::Node source;
  Digraph::Node sink;
  lemon::readDimacsMax(stream, graph, capacities, source, sink);
  return lemon_value(graph, capacities, source, sink);
}

TEST(LemonDimacs, ReadsWhatWeWrite) {
  for (const testing::NamedProblem& known : testing::known_problems()) {
    EXPECT_EQ(lemon_value_of_file(encode_dimacs(known.problem)), known.expected.value)
        << known.name;
  }
  for (const testing::RandomShape shape : testing::random_shapes()) {
    for (std::uint64_t seed = 10; seed < 13; ++seed) {
      const CutProblem problem = testing::random_problem(shape, seed);
      const auto ids = static_cast<std::uint32_t>(problem.node_count() + 2);
      EXPECT_EQ(lemon_value_of_file(encode_dimacs(problem, {ids, 1})),
                testing::solved(problem).value)
          << to_string(shape) << ' ' << seed;
    }
  }
}

struct LemonProblem {
  Digraph graph;
  Capacities capacities{graph};
  Digraph::Node source;
  Digraph::Node sink;
};

// Arcs of all kinds: parallel, opposite, loops, into the source, out of the sink.
void make_random(LemonProblem& problem, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const int nodes = 2 + static_cast<int>(random() % 30);
  for (int i = 0; i < nodes; ++i) problem.graph.addNode();
  const auto any = [&] {
    return Digraph::nodeFromId(static_cast<int>(random() % static_cast<std::uint64_t>(nodes)));
  };
  problem.source = any();
  do {
    problem.sink = any();
  } while (problem.sink == problem.source);
  for (int a = 0; a < 5 * nodes; ++a) {
    const Digraph::Node from = any();
    problem.capacities[problem.graph.addArc(from, any())] =
        static_cast<std::int64_t>(random() % 50);
  }
}

// LEMON writes plain digraphs only ("p mat", arcs without capacity); what a max-flow file has
// beyond that is added to its lines, which come in the order of its iterators.
std::string written_by_lemon(const LemonProblem& problem) {
  std::stringstream plain;
  lemon::writeDimacsMat(plain, problem.graph, "a digraph");
  int number = 1;
  std::string text;
  std::string terminals;
  for (Digraph::NodeIt i(problem.graph); i != lemon::INVALID; ++i, ++number) {
    if (i == problem.source) terminals += "n " + std::to_string(number) + " s\n";
    if (i == problem.sink) terminals += "n " + std::to_string(number) + " t\n";
  }
  Digraph::ArcIt arc(problem.graph);
  for (std::string line; std::getline(plain, line);) {
    if (line.starts_with("p mat")) {
      text += line.replace(2, 3, "max") + '\n' + terminals;
    } else if (line.starts_with("a ")) {
      text += line + ' ' + std::to_string(problem.capacities[arc]) + '\n';
      ++arc;
    } else {
      text += line + '\n';
    }
  }
  return text;
}

TEST(LemonDimacs, WritesWhatWeRead) {
  int with_flow = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    LemonProblem problem;
    make_random(problem, seed);
    const std::int64_t value =
        lemon_value(problem.graph, problem.capacities, problem.source, problem.sink);
    const std::string text = written_by_lemon(problem);
    EXPECT_EQ(testing::solved(parse_dimacs(text).problem).value, value) << text;
    EXPECT_EQ(lemon_value_of_file(text), value);
    if (value > 0) ++with_flow;
  }
  EXPECT_GT(with_flow, 20);
}

// LEMON's flow, arc by arc on the file as it is, passes our check.
TEST(LemonDimacs, ItsFlowsPassTheCheck) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    LemonProblem problem;
    make_random(problem, seed);
    lemon::Preflow<Digraph, Capacities> preflow(problem.graph, problem.capacities, problem.source,
                                                problem.sink);
    preflow.run();
    FlowSolution solution;
    solution.value = preflow.flowValue();
    Digraph::NodeMap<std::uint32_t> id(problem.graph);
    std::uint32_t number = 1;
    for (Digraph::NodeIt i(problem.graph); i != lemon::INVALID; ++i) id[i] = number++;
    for (Digraph::ArcIt arc(problem.graph); arc != lemon::INVALID; ++arc) {
      solution.flows.push_back(
          {id[problem.graph.source(arc)], id[problem.graph.target(arc)], preflow.flow(arc)});
    }
    const DimacsProblem read = parse_dimacs(written_by_lemon(problem));
    EXPECT_EQ(check_solution(read, solution), "") << "seed " << seed;
    ++solution.value;
    EXPECT_NE(check_solution(read, solution), "") << "seed " << seed;
  }
}

}  // namespace
}  // namespace cellocut
