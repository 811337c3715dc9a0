// The arcs of a problem as encode_dimacs writes them; encode_solution follows the same order.
// Internal to the problem files.
#pragma once

#include <cstddef>
#include <cstdint>

#include "cellocut/cut/problem_file.h"

namespace cellocut::cut_io {

// What an arc of the file stands for.
enum class ArcRole { constant, from_source, to_sink, forward, reverse };

// Throws UsageError where `nodes` cannot be the terminals of the problem, LimitError where the ids
// would not fit.
void require_terminals(const CutProblem& problem, const DimacsNodes& nodes);

// Calls visit(from, to, capacity, role, index) for every arc, with ids as in the file; `index` is
// that of the node or the edge.
template <class Visit>
void visit_arcs(const CutProblem& problem, const DimacsNodes& nodes, const Visit& visit) {
  if (problem.constant > 0) {
    visit(nodes.source, nodes.sink, problem.constant, ArcRole::constant, std::size_t{0});
  }
  for (std::uint32_t i = 0; i < problem.node_count(); ++i) {
    if (problem.to_source[i] > 0) {
      visit(nodes.source, nodes.id(i), problem.to_source[i], ArcRole::from_source, std::size_t{i});
    }
    if (problem.to_sink[i] > 0) {
      visit(nodes.id(i), nodes.sink, problem.to_sink[i], ArcRole::to_sink, std::size_t{i});
    }
  }
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const CutEdge& edge = problem.edges[e];
    if (edge.from == edge.to) continue;
    const std::uint32_t from = nodes.id(edge.from);
    const std::uint32_t to = nodes.id(edge.to);
    visit(from, to, edge.capacity, ArcRole::forward, e);
    if (edge.reverse_capacity > 0) visit(to, from, edge.reverse_capacity, ArcRole::reverse, e);
  }
}

}  // namespace cellocut::cut_io
