// lemon_preflow: the push-relabel code of the LEMON library, as an outside witness.
//
// Definition. An adapter: CutProblem -> a digraph with explicit source and sink, one arc per
// direction that has capacity -> lemon::Preflow on 64-bit integers -> net flow per edge.
//
// Limits. Node and arc numbers are `int`. On graphs with very many terminals it is an order of
// magnitude slower than the solvers that treat terminals implicitly; it is here to agree, not to
// win. The library has no way to be cancelled, so the capacity map that it reads polls the observer
// and throws.
//
// Complexity. O(n^2 sqrt(m)).
//
// Reference. B. Dezso, A. Juttner, P. Kovacs: LEMON, an open source C++ graph template library.
// Electronic Notes in Theoretical Computer Science 264(5), 2011.
//
// Licence: BSL-1.0 (library), GPL-3.0-or-later (adapter). Capabilities: exact for every valid
// problem, one thread, can be cancelled.
// LEMON copies node records before it fills them in; with the sanitizers g++ warns of it here.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

#include <lemon/preflow.h>
#include <lemon/smart_graph.h>

#include <limits>
#include <memory>

#include "cellocut/base/errors.h"
#include "solvers/residual_graph.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

using Digraph = lemon::SmartDigraph;

// Capacities by arc number. Reading polls for cancellation now and then.
class PollingCapacities {
 public:
  using Key = Digraph::Arc;
  using Value = std::int64_t;

  PollingCapacities(std::vector<std::int64_t> capacities, const SolveContext& context)
      : capacities_(std::move(capacities)), context_(context) {}

  Value operator[](const Key& arc) const {
    constexpr std::uint32_t kPollInterval = 1U << 12U;
    if (++reads_ % kPollInterval == 0) context_.check();
    return capacities_[static_cast<std::size_t>(Digraph::id(arc))];
  }

 private:
  std::vector<std::int64_t> capacities_;
  const SolveContext& context_;
  mutable std::uint32_t reads_ = 0;
};

class LemonPreflow final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "lemon_preflow";
      i.summary = "LEMON's push-relabel on explicit terminals";
      i.licence = "GPL-3.0-or-later AND BSL-1.0";
      i.reference = "Dezso, Juttner and Kovacs, ENTCS 264(5), 2011";
      i.outside = true;
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    const std::size_t nodes = problem.node_count();
    // Two terminal arcs per node and two per edge.
    require_index_range(problem, std::numeric_limits<int>::max() / 4);

    Digraph graph;
    graph.reserveNode(static_cast<int>(nodes + 2));
    graph.reserveArc(static_cast<int>(2 * (nodes + problem.edges.size())));
    for (std::size_t i = 0; i < nodes; ++i) graph.addNode();
    const Digraph::Node source = graph.addNode();
    const Digraph::Node sink = graph.addNode();
    std::vector<std::int64_t> capacities;
    capacities.reserve(2 * (nodes + problem.edges.size()));
    const auto add = [&](Digraph::Node from, Digraph::Node to, std::int64_t capacity) {
      if (capacity == 0 || from == to) return;
      graph.addArc(from, to);
      capacities.push_back(capacity);
    };
    const auto node = [](std::uint32_t i) { return Digraph::nodeFromId(static_cast<int>(i)); };
    // Edges first, so that arc numbers tell which edge they belong to.
    for (const CutEdge& edge : problem.edges) {
      add(node(edge.from), node(edge.to), edge.capacity);
      add(node(edge.to), node(edge.from), edge.reverse_capacity);
    }
    for (std::uint32_t i = 0; i < nodes; ++i) {
      add(source, node(i), problem.to_source[i]);
      add(node(i), sink, problem.to_sink[i]);
    }
    const PollingCapacities capacity_map(std::move(capacities), context);
    lemon::Preflow<Digraph, PollingCapacities> preflow(graph, capacity_map, source, sink);
    context.built();
    preflow.run();
    context.check();

    SolverOutput output;
    output.edge_flow.assign(problem.edges.size(), 0);
    int next = 0;
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
      const CutEdge& edge = problem.edges[e];
      if (edge.from == edge.to) continue;
      if (edge.capacity != 0) output.edge_flow[e] += preflow.flow(Digraph::arcFromId(next++));
      if (edge.reverse_capacity != 0) {
        output.edge_flow[e] -= preflow.flow(Digraph::arcFromId(next++));
      }
    }
    return output;
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_lemon_preflow();
std::unique_ptr<CutSolver> make_lemon_preflow() { return std::make_unique<LemonPreflow>(); }

}  // namespace cellocut::solvers
