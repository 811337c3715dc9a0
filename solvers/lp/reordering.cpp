#include "solvers/lp/reordering.h"

#include "solvers/residual_graph.h"

namespace cellocut::solvers::lp {

namespace {

constexpr std::uint32_t kNone = 0xffff'ffffU;

}  // namespace

Reordering reorder(const CutProblem& problem) {
  const ResidualGraph graph(problem);
  const std::uint32_t nodes = graph.node_count();
  Reordering result;
  result.node.reserve(nodes);
  result.edge.reserve(problem.edges.size());
  std::vector<std::uint32_t> place(nodes, kNone);
  std::vector<std::uint8_t> listed(problem.edges.size(), 0);
  const auto visit = [&](std::uint32_t i) {
    place[i] = static_cast<std::uint32_t>(result.node.size());
    result.node.push_back(i);
  };
  for (std::uint32_t seed = 0; seed < nodes; ++seed) {
    if (place[seed] != kNone) continue;
    visit(seed);
    for (std::size_t k = place[seed]; k < result.node.size(); ++k) {
      const std::uint32_t i = result.node[k];
      for (std::uint32_t a = graph.row[i]; a < graph.row[i + 1]; ++a) {
        const Arc arc = graph.arcs[a];
        if (place[arc.head] == kNone) visit(arc.head);
        const std::uint32_t e = arc.id / 2;
        if (listed[e] == 0) {
          listed[e] = 1;
          result.edge.push_back(e);
        }
      }
    }
  }
  // Loops and edges without capacity have no arcs.
  for (std::uint32_t e = 0; e < problem.edges.size(); ++e) {
    if (listed[e] == 0) result.edge.push_back(e);
  }

  result.problem.constant = problem.constant;
  result.problem.to_source.reserve(nodes);
  result.problem.to_sink.reserve(nodes);
  for (const std::uint32_t i : result.node) {
    result.problem.to_source.push_back(problem.to_source[i]);
    result.problem.to_sink.push_back(problem.to_sink[i]);
  }
  result.problem.edges.reserve(problem.edges.size());
  for (const std::uint32_t e : result.edge) {
    CutEdge edge = problem.edges[e];
    edge.from = place[edge.from];
    edge.to = place[edge.to];
    result.problem.edges.push_back(edge);
  }
  return result;
}

}  // namespace cellocut::solvers::lp
