// libmaxflow: Kolmogorov's own implementation of the Boykov-Kolmogorov algorithm, as an outside
// witness.
//
// Definition. An adapter: CutProblem -> maxflow::Graph -> net flow per edge from the residual
// capacities.
//
// Limits. Debian's library holds four instances, none with 64-bit integers; Graph<double, double,
// double> adds and compares integers exactly as long as every sum stays below 2^53, so problems
// whose capacities sum to more are refused. Node and arc numbers are `int`. The library can be
// neither cancelled nor asked about its memory while it searches. Its default at an error is
// exit(1), so a callback that throws is always given.
//
// Complexity. As bk, O(n^2 m C).
//
// Reference. Y. Boykov, V. Kolmogorov: An experimental comparison of min-cut/max-flow algorithms
// for energy minimization in vision. IEEE TPAMI 26(9), 2004. Version 3 of the author's code, as
// packaged.
//
// Licence: GPL-3.0-or-later (adapter and library). Capabilities: exact below 2^53, one thread.
#include <maxflow.h>

#include <limits>
#include <memory>

#include "cellocut/base/errors.h"
#include "solvers/residual_graph.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

using Graph = maxflow::Graph_DDD;

void report_library_error(const char* what) {
  throw LimitError(std::string("libmaxflow: ") + what);
}

class LibMaxflow final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "libmaxflow";
      i.summary = "Kolmogorov's library in double precision, exact below 2^53";
      i.licence = "GPL-3.0-or-later";
      i.reference = "Boykov and Kolmogorov, IEEE TPAMI 26(9), 2004; library version 3.0";
      i.outside = true;
      i.capacity_limit = std::int64_t{1} << std::numeric_limits<double>::digits;
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    require_index_range(problem, std::numeric_limits<int>::max());
    const int nodes = static_cast<int>(problem.node_count());
    const int edges = static_cast<int>(problem.edges.size());
    Graph graph(nodes, edges, &report_library_error);
    if (nodes > 0) graph.add_node(nodes);
    for (int i = 0; i < nodes; ++i) {
      graph.add_tweights(i, static_cast<double>(problem.to_source[static_cast<std::size_t>(i)]),
                         static_cast<double>(problem.to_sink[static_cast<std::size_t>(i)]));
    }
    for (const CutEdge& edge : problem.edges) {
      if (!has_arcs(edge)) continue;
      graph.add_edge(static_cast<int>(edge.from), static_cast<int>(edge.to),
                     static_cast<double>(edge.capacity),
                     static_cast<double>(edge.reverse_capacity));
    }
    context.built();
    graph.maxflow();

    SolverOutput output;
    output.edge_flow.assign(problem.edges.size(), 0);
    Graph::arc_id arc = graph.get_first_arc();
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
      if (!has_arcs(problem.edges[e])) continue;
      output.edge_flow[e] =
          problem.edges[e].capacity - static_cast<std::int64_t>(graph.get_rcap(arc));
      arc = graph.get_next_arc(graph.get_next_arc(arc));  // the next but one: skip the sister
    }
    context.check();
    return output;
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_libmaxflow();
std::unique_ptr<CutSolver> make_libmaxflow() { return std::make_unique<LibMaxflow>(); }

}  // namespace cellocut::solvers
