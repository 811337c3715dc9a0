#include "solvers/residual_graph.h"

#include <string>

#include "cellocut/base/errors.h"

namespace cellocut::solvers {

namespace {

// Solvers keep a few of the highest 32-bit values as marks.
constexpr std::uint64_t kIndexLimit = 0xffff'fff0U;

}  // namespace

void require_index_range(const CutProblem& problem, std::uint64_t limit) {
  if (problem.node_count() >= limit || 2 * problem.edges.size() >= limit) {
    throw LimitError("cut problem: " + std::to_string(problem.node_count()) + " nodes and " +
                     std::to_string(problem.edges.size()) +
                     " edges are more than this solver can index");
  }
}

ResidualGraph::ResidualGraph(const CutProblem& problem) {
  require_index_range(problem, kIndexLimit);
  const std::size_t nodes = problem.node_count();
  const auto edge_count = static_cast<std::uint32_t>(problem.edges.size());

  terminal.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i) terminal[i] = problem.to_source[i] - problem.to_sink[i];

  row.assign(nodes + 1, 0);
  residual.resize(2 * problem.edges.size());
  for (std::uint32_t e = 0; e < edge_count; ++e) {
    const CutEdge& edge = problem.edges[e];
    residual[2 * e] = edge.capacity;
    residual[2 * e + 1] = edge.reverse_capacity;
    if (!has_arcs(edge)) continue;
    ++row[edge.from];
    ++row[edge.to];
  }
  // row[i] becomes the end of row i, and filling backwards moves it to the beginning.
  for (std::size_t i = 1; i <= nodes; ++i) row[i] += row[i - 1];
  arcs.resize(row[nodes]);
  for (std::uint32_t e = edge_count; e-- > 0;) {
    const CutEdge& edge = problem.edges[e];
    if (!has_arcs(edge)) continue;
    arcs[--row[edge.from]] = {edge.to, 2 * e};
    arcs[--row[edge.to]] = {edge.from, 2 * e + 1};
  }
}

std::int64_t ResidualGraph::bytes() const {
  return static_cast<std::int64_t>(row.size() * sizeof(row[0]) + arcs.size() * sizeof(arcs[0]) +
                                   residual.size() * sizeof(residual[0]) +
                                   terminal.size() * sizeof(terminal[0]));
}

std::vector<std::int64_t> ResidualGraph::edge_flow(const CutProblem& problem) const {
  std::vector<std::int64_t> flow(problem.edges.size());
  for (std::size_t e = 0; e < flow.size(); ++e) {
    flow[e] = problem.edges[e].capacity - residual[2 * e];
  }
  return flow;
}

}  // namespace cellocut::solvers
