#include "solvers/lp/crossover.h"

#include <algorithm>

#include "solvers/solvers.h"

namespace cellocut::solvers::lp {

namespace {

bool fits(const CutProblem& problem) {
  std::int64_t left = kCapacityLimit - 1;
  const auto take = [&left](std::int64_t amount) {
    left = amount > left ? -1 : left - amount;
    return left >= 0;
  };
  for (const CutEdge& edge : problem.edges) {
    if (!take(edge.capacity) || !take(edge.reverse_capacity)) return false;
  }
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    if (!take(problem.to_source[i]) || !take(problem.to_sink[i])) return false;
  }
  return true;
}

class Completion {
 public:
  Completion(const CutProblem& problem, const ResidualGraph& graph, IntegerFlow& flow,
             const SolveContext& context)
      : graph_(graph), flow_(flow), context_(context), solver_(make("bk")) {
    rest_.edges = problem.edges;
    rest_.to_source.resize(graph.node_count());
    rest_.to_sink.resize(graph.node_count());
  }

  // Whether a move was left out because it would have held more than any problem may: surplus and
  // lack of a flow that is far from balanced are as large as they like.
  [[nodiscard]] bool too_large() const { return too_large_; }

  // Moves as much as possible from sources to sinks, `supply` and `demand` of every node.
  template <class Supply, class Demand>
  std::int64_t move(const Supply& supply, const Demand& demand) {
    bool supplies = false;
    bool demands = false;
    for (std::uint32_t i = 0; i < graph_.node_count(); ++i) {
      rest_.to_source[i] = std::max<std::int64_t>(supply(i), 0);
      rest_.to_sink[i] = std::max<std::int64_t>(demand(i), 0);
      supplies = supplies || rest_.to_source[i] > 0;
      demands = demands || rest_.to_sink[i] > 0;
    }
    if (!supplies || !demands) return 0;
    for (std::size_t e = 0; e < rest_.edges.size(); ++e) {
      rest_.edges[e].capacity = flow_.residual[2 * e];
      rest_.edges[e].reverse_capacity = flow_.residual[2 * e + 1];
    }
    if (!fits(rest_)) {
      too_large_ = true;
      return 0;
    }
    const CutResult result = solver_->solve(rest_, SolveOptions{.observer = context_.observer()});
    for (std::size_t e = 0; e < rest_.edges.size(); ++e) {
      const std::int64_t amount = result.edge_flow[e];
      if (amount == 0 || rest_.edges[e].from == rest_.edges[e].to) continue;
      flow_.residual[2 * e] -= amount;
      flow_.residual[2 * e + 1] += amount;
      flow_.surplus[rest_.edges[e].from] -= amount;
      flow_.surplus[rest_.edges[e].to] += amount;
    }
    return result.value;
  }

 private:
  const ResidualGraph& graph_;
  IntegerFlow& flow_;
  const SolveContext& context_;
  std::unique_ptr<CutSolver> solver_;
  CutProblem rest_;
  bool too_large_ = false;
};

}  // namespace

Crossover complete_flow(const CutProblem& problem, const ResidualGraph& graph, IntegerFlow flow,
                        const SolveContext& context) {
  Crossover crossover;
  Completion completion(problem, graph, flow, context);
  const std::vector<std::int64_t>& surplus = flow.surplus;
  crossover.added_value = completion.move([&](std::uint32_t i) { return surplus[i]; },
                                          [&](std::uint32_t i) { return -surplus[i]; });
  crossover.returned = completion.move(
      [&](std::uint32_t i) { return surplus[i] - problem.to_source[i]; },
      [&](std::uint32_t i) { return surplus[i] >= 0 ? problem.to_source[i] - surplus[i] : 0; });
  crossover.returned += completion.move(
      [&](std::uint32_t i) { return surplus[i] <= 0 ? problem.to_sink[i] + surplus[i] : 0; },
      [&](std::uint32_t i) { return -surplus[i] - problem.to_sink[i]; });
  // Then all is left to the exact solver, from the beginning: the first move is then the problem.
  if (completion.too_large()) {
    return complete_flow(problem, graph, {graph.residual, graph.terminal}, context);
  }
  crossover.edge_flow.resize(problem.edges.size());
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    crossover.edge_flow[e] = graph.residual[2 * e] - flow.residual[2 * e];
  }
  return crossover;
}

}  // namespace cellocut::solvers::lp
