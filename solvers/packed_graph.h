// A residual graph in compressed rows, for searches that look at whole rows.
//
// Arc a lies in the row of its tail, with its residual capacity and the index of its sister, the
// opposite arc of the same edge; `sister_open` says whether that one has residual capacity. So a
// scan reads the row and the nodes it leads to, in whichever direction the flow goes, and only a
// push touches two rows. (ResidualGraph keeps the capacities of both directions side by side
// instead: better where one arc of a row is looked at, as on a walk to the root of a tree.)
//
// Terminals are not nodes: terminal[i] = to_source[i] - to_sink[i]; what passes straight through a
// node is taken out, as in ResidualGraph. Loops, and edges without capacity in both directions,
// have no arcs; their flow is zero.
//
// Pseudoflows. A solver may saturate terminal arcs and leave what comes to too much or too little
// at a node as its excess. `returned_flow` makes a flow of a maximum pseudoflow, in which no
// residual path leads from an excess to a deficit: every excess is taken back along arcs that carry
// flow into the node, to a node that drew it from the source, and every deficit, by the same code
// with all signs turned, to one that gave it to the sink. A depth-first search along those arcs
// cancels the flow on every cycle that it closes; what remains is acyclic, and one sweep in its
// order moves everything (Cherkassky and Goldberg 1997). Linear but for the cycles.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_problem.h"
#include "cellocut/cut/cut_solver.h"

namespace cellocut::solvers {

struct PackedArc {
  std::uint32_t head;
  std::uint32_t sister : 31;
  std::uint32_t sister_open : 1;
  std::int64_t residual;
};
static_assert(sizeof(PackedArc) == 16);

struct PackedGraph {
  std::vector<std::uint32_t> row;  // node_count + 1: arcs[row[i] .. row[i + 1]) leave node i
  std::vector<PackedArc> arcs;
  std::vector<std::uint32_t> arc_of_edge;  // the arc `from` -> `to`, kNoArc where there is none
  std::vector<std::int64_t> terminal;      // one per node

  static constexpr std::uint32_t kNoArc = 0xffff'ffffU;

  // Precondition: problem.validate() holds. Errors: LimitError from 2^30 edges on.
  // O(nodes + edges).
  explicit PackedGraph(const CutProblem& problem);

  [[nodiscard]] std::uint32_t node_count() const {
    return static_cast<std::uint32_t>(terminal.size());
  }
  void push(std::uint32_t a, std::int64_t amount) {
    PackedArc& arc = arcs[a];
    PackedArc& sister = arcs[arc.sister];
    arc.residual -= amount;
    sister.residual += amount;
    arc.sister_open = 1;
    sister.sister_open = arc.residual != 0;
  }
  // Sends these net flows along the edges, as far as their capacities allow, and adds to `balance`
  // what that brings each node.
  void send(const std::vector<std::int64_t>& edge_flow, std::vector<std::int64_t>& balance);
  // Size of the arrays.
  [[nodiscard]] std::int64_t bytes() const;
};

// The maximum flow that a maximum pseudoflow contains, one net value per edge. `excess` is that of
// the pseudoflow in which every terminal arc is saturated. The problem is the one that the graph
// was made from; the flow takes the place of the residual capacities, and some 20 bytes per node
// come on top. O(nodes * edges), linear where the flow has no cycles.
std::vector<std::int64_t> returned_flow(PackedGraph& graph, const CutProblem& problem,
                                        const std::vector<std::int64_t>& excess,
                                        const SolveContext& context);

}  // namespace cellocut::solvers
