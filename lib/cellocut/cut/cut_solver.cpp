#include "cellocut/cut/cut_solver.h"

#include <algorithm>
#include <string>

#include "cellocut/base/stopwatch.h"
#include "cellocut/cut/reduction.h"

namespace cellocut {

namespace {

// The residual graph of a flow in compressed rows: arcs[row[i] .. row[i+1]) are the edges at node
// i.
struct Rows {
  std::vector<std::uint32_t> row;
  std::vector<std::uint32_t> edge;

  explicit Rows(const CutProblem& problem) : row(problem.node_count() + 1, 0) {
    for (const CutEdge& e : problem.edges) {
      ++row[e.from + 1];
      ++row[e.to + 1];
    }
    for (std::size_t i = 1; i < row.size(); ++i) row[i] += row[i - 1];
    edge.resize(row.back());
    std::vector<std::uint32_t> next(row.begin(), row.end() - 1);
    for (std::uint32_t e = 0; e < problem.edges.size(); ++e) {
      edge[next[problem.edges[e].from]++] = e;
      edge[next[problem.edges[e].to]++] = e;
    }
  }
};

// Marks every node from which (forward: to which) a residual path leads, starting from `stack`.
// `forward` follows residual arcs in their direction, otherwise against it.
void search_residual(const CutProblem& problem, const std::vector<std::int64_t>& flow,
                     const Rows& rows, bool forward, std::vector<std::uint32_t> stack,
                     CutLabels& marked) {
  while (!stack.empty()) {
    const std::uint32_t i = stack.back();
    stack.pop_back();
    for (std::uint32_t a = rows.row[i]; a < rows.row[i + 1]; ++a) {
      const std::uint32_t e = rows.edge[a];
      const CutEdge& edge = problem.edges[e];
      const bool leaves = edge.from == i;
      const std::uint32_t other = leaves ? edge.to : edge.from;
      if (marked[other] != 0) continue;
      // Residual capacity of the arc that the search walks: i -> other, or other -> i.
      const bool along = leaves == forward;
      const std::int64_t residual =
          along ? edge.capacity - flow[e] : edge.reverse_capacity + flow[e];
      if (residual > 0) {
        marked[other] = 1;
        stack.push_back(other);
      }
    }
  }
}

std::string flow_defect(const CutProblem& problem, const SolverOutput& output) {
  if (output.edge_flow.size() != problem.edges.size()) return "the flow has the wrong size";
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const std::int64_t flow = output.edge_flow[e];
    if (flow > problem.edges[e].capacity || flow < -problem.edges[e].reverse_capacity) {
      return "the flow exceeds the capacity of edge " + std::to_string(e);
    }
  }
  return {};
}

DualFlow to_dual_units(std::int64_t units) {
  return static_cast<DualFlow>(units) * (DualFlow{1} << kDualFlowBits);
}

std::string relaxed_values_defect(const CutProblem& problem, const std::vector<float>& relaxed) {
  if (relaxed.size() != problem.node_count()) return "the relaxed values have the wrong size";
  for (std::size_t i = 0; i < relaxed.size(); ++i) {
    // Written so that a NaN fails.
    if (!(relaxed[i] >= 0 && relaxed[i] <= 1)) {
      return "the relaxed value of node " + std::to_string(i) + " is not in [0, 1]";
    }
  }
  return {};
}

std::string relaxation_defect(const CutProblem& problem, const RelaxedOutput& output) {
  if (output.labels.size() != problem.node_count()) return "the labelling has the wrong size";
  for (std::size_t i = 0; i < output.labels.size(); ++i) {
    if (output.labels[i] > 1) return "node " + std::to_string(i) + " has no valid label";
  }
  if (output.dual_flow.size() != problem.edges.size()) return "the dual flow has the wrong size";
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    if (output.dual_flow[e] > to_dual_units(problem.edges[e].capacity) ||
        output.dual_flow[e] < -to_dual_units(problem.edges[e].reverse_capacity)) {
      return "the dual flow exceeds the capacity of edge " + std::to_string(e);
    }
  }
  return {};
}

// Recomputes what a relaxation without a flow claims, and fills in the result.
void judge_relaxation(const CutProblem& problem, RelaxedOutput& output, CutResult& result) {
  result.message = relaxation_defect(problem, output);
  if (!result.message.empty()) return;
  result.value = cut_cost(problem, output.labels);
  result.lower_bound = dual_bound(problem, output.dual_flow);
  if (output.value != result.value) {
    result.message = "the labelling costs " + std::to_string(result.value) + ", not " +
                     std::to_string(output.value) + " as claimed";
    return;
  }
  if (output.lower_bound != result.lower_bound) {
    result.message = "the dual flow proves " + std::to_string(result.lower_bound) + ", not " +
                     std::to_string(output.lower_bound) + " as claimed";
    return;
  }
  const bool proved = result.lower_bound == result.value;
  if ((output.stop == "proof") != proved) {
    result.message = proved
                         ? "the bound is a proof, but the solver says it stopped at: " + output.stop
                         : "the solver claims a proof, but the bound leaves a gap";
    return;
  }
  result.smallest_source_side = output.labels;
  result.largest_source_side = std::move(output.labels);
  result.status = proved ? CutStatus::optimal : CutStatus::gap;
}

}  // namespace

const char* to_string(CutStatus status) {
  switch (status) {
    case CutStatus::optimal:
      return "optimal";
    case CutStatus::gap:
      return "gap";
    case CutStatus::invalid:
      return "invalid";
  }
  return "unknown";
}

void RelaxationOptions::validate() const {
  // Written so that a NaN fails.
  if (!(relative_gap >= 0 && relative_gap < 1)) {
    throw UsageError("relative gap: give a number from 0 to below 1");
  }
  if (!(seconds_limit >= 0)) throw UsageError("time limit: give seconds, 0 for none");
  if (iteration_limit < 1) throw UsageError("iteration limit: give at least 1");
}

void SolveContext::built() { built_at_ = clock_.seconds(); }

TerminalFlow terminal_flow(std::int64_t to_source, std::int64_t to_sink, std::int64_t out) {
  const std::int64_t from_source = std::min(to_source, to_sink + out);
  return {from_source, from_source - out};
}

std::int64_t dual_bound(const CutProblem& problem, const std::vector<DualFlow>& dual_flow) {
  // Capacities sum to less than 2^62, so nothing here reaches 2^90.
  std::vector<DualFlow> out(problem.node_count(), 0);
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    out[problem.edges[e].from] += dual_flow[e];
    out[problem.edges[e].to] -= dual_flow[e];
  }
  DualFlow bound = to_dual_units(problem.constant);
  for (std::size_t i = 0; i < out.size(); ++i) {
    bound +=
        std::min(to_dual_units(problem.to_source[i]), to_dual_units(problem.to_sink[i]) + out[i]);
  }
  // Costs are integers, so the bound may be rounded up. Division rounds towards zero.
  const DualFlow unit = to_dual_units(1);
  const DualFlow floor = bound / unit - (bound % unit < 0 ? 1 : 0);
  return static_cast<std::int64_t>(floor + (bound % unit != 0 ? 1 : 0));
}

std::vector<std::int64_t> node_balances(const CutProblem& problem,
                                        const std::vector<std::int64_t>& edge_flow) {
  std::vector<std::int64_t> out(problem.node_count(), 0);
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    out[problem.edges[e].from] += edge_flow[e];
    out[problem.edges[e].to] -= edge_flow[e];
  }
  return out;
}

SolverOutput CutSolver::solve_reduced(const CutProblem& problem, SolveContext& context) {
  const Reduction reduction(problem);
  const double reduced = context.seconds();
  SolverOutput output = do_solve(reduction.problem(), context);
  // What the solver returns is judged as a whole, so a flow of the wrong size is left as it is.
  if (output.edge_flow.size() == reduction.problem().edges.size()) {
    output.edge_flow = reduction.lift(output.edge_flow);
  }
  if (output.relaxed && output.relaxed->relaxed.size() == reduction.problem().node_count()) {
    output.relaxed->relaxed = reduction.lift_values(output.relaxed->relaxed);
  }
  const ReductionCounts& counts = reduction.counts();
  output.counters.insert(output.counters.end(),
                         {{"reduced_unreachable", counts.unreachable},
                          {"reduced_dominated", counts.dominated},
                          {"reduced_heavy_edges", counts.heavy_edges},
                          {"reduced_isolated", counts.isolated},
                          {"reduction_microseconds", static_cast<std::int64_t>(1e6 * reduced)}});
  return output;
}

CutResult CutSolver::solve(const CutProblem& problem, const SolveOptions& options) {
  problem.validate();
  if (info().capacity_limit < kCapacityLimit) {
    std::int64_t sum = problem.constant;
    for (std::size_t i = 0; i < problem.node_count(); ++i) {
      sum += problem.to_source[i] + problem.to_sink[i];
    }
    for (const CutEdge& edge : problem.edges) sum += edge.capacity + edge.reverse_capacity;
    if (sum >= info().capacity_limit) {
      throw LimitError("solver '" + info().name + "' is exact only for capacity sums below " +
                       std::to_string(info().capacity_limit) + ", this problem has " +
                       std::to_string(sum) + "; lower --area-bits");
    }
  }

  options.relaxation.validate();
  if (options.start != nullptr && options.start->size() != problem.edges.size()) {
    throw UsageError("start: give one flow for each edge");
  }
  CutResult result;
  SolveContext context(options);
  Stopwatch stopwatch;
  const bool flow_expected = info().exact || options.relaxation.crossover;
  SolverOutput output = options.reduce && flow_expected ? solve_reduced(problem, context)
                                                        : do_solve(problem, context);
  const double total = stopwatch.seconds();
  result.build_seconds = std::max(0.0, context.built_at());
  result.solve_seconds = total - result.build_seconds;
  result.counters = std::move(output.counters);
  result.bytes = output.bytes;

  stopwatch.restart();
  if (output.relaxed) {
    result.message = relaxed_values_defect(problem, output.relaxed->relaxed);
    if (!result.message.empty()) return result;
    result.relaxed = std::move(output.relaxed->relaxed);
    result.stop = output.relaxed->stop;
    // A flow of an exact solver may not be left out by handing over a relaxation.
    if (!info().exact && output.edge_flow.empty() && !options.relaxation.crossover) {
      judge_relaxation(problem, *output.relaxed, result);
      result.verify_seconds = stopwatch.seconds();
      return result;
    }
  }
  result.message = flow_defect(problem, output);
  result.edge_flow = std::move(output.edge_flow);
  if (!result.message.empty()) return result;

  const std::vector<std::int64_t> out = node_balances(problem, result.edge_flow);
  const std::size_t nodes = problem.node_count();
  CutLabels from_source(nodes, 0);
  CutLabels reaches_sink(nodes, 0);
  std::vector<std::uint32_t> source_seeds;
  std::vector<std::uint32_t> sink_seeds;
  std::int64_t flow_value = 0;
  for (std::uint32_t i = 0; i < nodes; ++i) {
    if (out[i] > problem.to_source[i] || -out[i] > problem.to_sink[i]) {
      result.message = "the flow does not balance at node " + std::to_string(i);
      return result;
    }
    const TerminalFlow flow = terminal_flow(problem.to_source[i], problem.to_sink[i], out[i]);
    flow_value += flow.from_source;
    if (flow.from_source < problem.to_source[i]) {
      from_source[i] = 1;
      source_seeds.push_back(i);
    }
    if (flow.to_sink < problem.to_sink[i]) {
      reaches_sink[i] = 1;
      sink_seeds.push_back(i);
    }
  }
  const Rows rows(problem);
  search_residual(problem, result.edge_flow, rows, true, std::move(source_seeds), from_source);
  search_residual(problem, result.edge_flow, rows, false, std::move(sink_seeds), reaches_sink);
  for (std::uint8_t& label : reaches_sink) label ^= 1U;
  result.smallest_source_side = std::move(from_source);
  result.largest_source_side = std::move(reaches_sink);
  result.lower_bound = problem.constant + flow_value;
  result.value = cut_cost(problem, result.largest_source_side);
  if (result.value != result.lower_bound ||
      cut_cost(problem, result.smallest_source_side) != result.lower_bound) {
    result.message = "the flow is feasible but not maximal";
    return result;
  }
  result.status = CutStatus::optimal;
  result.canonical = true;
  result.verify_seconds = stopwatch.seconds();
  return result;
}

}  // namespace cellocut
