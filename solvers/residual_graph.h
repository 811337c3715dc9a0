// The residual graph that the solvers of this folder work on, in compressed rows.
//
// Notation. Edge e = (from, to) of the problem gives two arcs, `from` -> `to` with id 2e and `to`
// -> `from` with id 2e + 1; the sister of arc a is a ^ 1. residual[a] is the residual capacity of
// arc a, and the net flow of edge e is capacity[e] - residual[2e].
//   arcs[row[i] .. row[i + 1])  the arcs that leave node i, each with its head and its id.
// Residual capacities sit apart from the rows, both directions of an edge side by side: whichever
// direction a search needs, one cache line holds it, and reading the problem writes them in order.
//
// Terminals are not nodes. What passes straight through a node from source to sink,
// min(to_source, to_sink), is taken out first; what is left at node i is one signed number:
//   terminal[i] > 0   residual capacity source -> i,
//   terminal[i] < 0   minus the residual capacity i -> sink.
//
// Loops, and edges without capacity in both directions, have no arcs; their flow is zero.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_problem.h"

namespace cellocut::solvers {

struct Arc {
  std::uint32_t head;
  std::uint32_t id;
};

struct ResidualGraph {
  std::vector<std::uint32_t> row;  // node_count + 1
  std::vector<Arc> arcs;
  std::vector<std::int64_t> residual;  // two per edge of the problem
  std::vector<std::int64_t> terminal;  // one per node

  // Precondition: problem.validate() holds. Errors: LimitError where nodes or arcs do not fit
  // 32-bit indices. O(nodes + edges).
  explicit ResidualGraph(const CutProblem& problem);

  [[nodiscard]] std::uint32_t node_count() const {
    return static_cast<std::uint32_t>(terminal.size());
  }
  // Size of the arrays.
  [[nodiscard]] std::int64_t bytes() const;
  // Net flow per edge of the problem that this graph was made from.
  [[nodiscard]] std::vector<std::int64_t> edge_flow(const CutProblem& problem) const;
};

// Whether an edge can carry flow: it is no loop and has capacity in some direction.
constexpr bool has_arcs(const CutEdge& edge) {
  return edge.from != edge.to && (edge.capacity | edge.reverse_capacity) != 0;
}

// Throws LimitError where nodes or arcs do not fit indices below `limit`.
void require_index_range(const CutProblem& problem, std::uint64_t limit);

}  // namespace cellocut::solvers
