#include "cellocut/path/wide_cut.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

// Of a node: what its terminal arcs carry, and can still carry.
struct Terminal {
  Wide source_left;
  Wide sink_left;
  Wide from_source;
};

// As much as possible goes through the node, from the source and to the sink.
// Precondition: -to_sink <= out <= to_source.
Terminal terminal_at(Wide to_source, Wide to_sink, Wide out) {
  const Wide from_source = std::min(to_source, to_sink + out);
  return {to_source - from_source, to_sink - (from_source - out), from_source};
}

// A maximum flow and both canonical cuts, as checked by CutSolver::solve.
// `start`: about its flows times 2^shift, or empty.
CutResult maximum_flow(CutSolver& solver, const CutProblem& problem, Observer& observer,
                       std::span<const double> start, int shift) {
  std::vector<std::int64_t> begin(start.size());
  for (std::size_t e = 0; e < start.size(); ++e) {
    // (No capacity is as large.)
    begin[e] = static_cast<std::int64_t>(std::clamp(std::ldexp(start[e], -shift), -0x1p62, 0x1p62));
  }
  SolveOptions options{.observer = &observer};
  if (!start.empty()) options.start = &begin;
  CutResult cut = solver.solve(problem, options);
  if (cut.status != CutStatus::optimal || !cut.canonical) {
    throw CertificateError("solver '" + solver.info().name + "' returned no maximum flow: " +
                           (cut.message.empty() ? "it is not exact" : cut.message));
  }
  return cut;
}

class WideSearch {
 public:
  WideSearch(const WideProblem& problem, CutSolver& solver, Observer& observer,
             std::span<const double> start)
      : problem_(problem), solver_(solver), observer_(observer), start_(start) {
    result_.edge_flow.assign(problem.edges.size(), 0);
    terminals_.resize(problem.node_count());
  }

  WideCut run();

 private:
  void find_terminals();
  // The fewest lowest bits without which the residual capacities, each at most `bound`, fit.
  [[nodiscard]] int least_shift(Wide bound) const;
  // Adds a maximum flow of the residual problem without the lowest `shift` bits. Returns a bound on
  // what is left to send.
  Wide add_digit(Wide bound, int shift);
  void finish();
  void search(bool from_source, CutLabels& marked) const;
  [[nodiscard]] Wide cost(const CutLabels& source_side) const;

  const WideProblem& problem_;
  CutSolver& solver_;
  Observer& observer_;
  std::span<const double> start_;  // of the first digit
  WideCut result_;
  std::vector<Terminal> terminals_;
};

void WideSearch::find_terminals() {
  std::vector<Wide> out(problem_.node_count(), 0);
  for (std::size_t e = 0; e < problem_.edges.size(); ++e) {
    const Wide flow = result_.edge_flow[e];
    if (flow > problem_.edges[e].capacity || -flow > problem_.edges[e].capacity) {
      throw CertificateError("solver '" + solver_.info().name + "': an edge carries too much");
    }
    out[problem_.edges[e].from] += result_.edge_flow[e];
    out[problem_.edges[e].to] -= result_.edge_flow[e];
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i] > problem_.to_source[i] || -out[i] > problem_.to_sink[i]) {
      throw CertificateError("solver '" + solver_.info().name + "': the flow does not balance");
    }
    terminals_[i] = terminal_at(problem_.to_source[i], problem_.to_sink[i], out[i]);
  }
}

int WideSearch::least_shift(Wide bound) const {
  Wide sum = 0;
  for (const Terminal& t : terminals_) {
    sum += std::min(t.source_left, bound) + std::min(t.sink_left, bound);
  }
  for (std::size_t e = 0; e < problem_.edges.size(); ++e) {
    const Wide capacity = problem_.edges[e].capacity;
    const Wide flow = result_.edge_flow[e];
    sum += std::min(capacity - flow, bound) + std::min(capacity + flow, bound);
  }
  int shift = 0;
  // The solver judges the sum of what is left when each capacity is rounded down.
  while ((sum >> shift) >= Wide{solver_.info().capacity_limit}) ++shift;
  return shift;
}

Wide WideSearch::add_digit(Wide bound, int shift) {
  const auto clipped = [bound](Wide residual) { return std::min(residual, bound); };
  const auto part = [&](Wide residual) {
    return static_cast<std::int64_t>(clipped(residual) >> shift);
  };
  CutProblem scaled;
  scaled.to_source.reserve(terminals_.size());
  scaled.to_sink.reserve(terminals_.size());
  for (const Terminal& t : terminals_) {
    scaled.to_source.push_back(part(t.source_left));
    scaled.to_sink.push_back(part(t.sink_left));
  }
  scaled.edges.reserve(problem_.edges.size());
  for (std::size_t e = 0; e < problem_.edges.size(); ++e) {
    const WideProblem::Edge& edge = problem_.edges[e];
    scaled.edges.push_back({edge.from, edge.to, part(edge.capacity - result_.edge_flow[e]),
                            part(edge.capacity + result_.edge_flow[e])});
  }
  const CutResult cut = maximum_flow(solver_, scaled, observer_, start_, shift);
  start_ = {};
  ++result_.digits;
  // What the minimum cut has in the bits that were left out.
  const CutLabels& side = cut.smallest_source_side;
  const Wide unit = Wide{1} << shift;
  const auto remainder = [&](Wide residual) { return clipped(residual) % unit; };
  Wide left = 0;
  for (std::size_t i = 0; i < terminals_.size(); ++i) {
    left += remainder(side[i] != 0 ? terminals_[i].sink_left : terminals_[i].source_left);
  }
  for (std::size_t e = 0; e < problem_.edges.size(); ++e) {
    const WideProblem::Edge& edge = problem_.edges[e];
    const Wide flow = result_.edge_flow[e];
    if (side[edge.from] > side[edge.to]) left += remainder(edge.capacity - flow);
    if (side[edge.from] < side[edge.to]) left += remainder(edge.capacity + flow);
    result_.edge_flow[e] += unit * cut.edge_flow[e];
  }
  return left;
}

// Marks what the source reaches over residual arcs (or what reaches the sink).
void WideSearch::search(bool from_source, CutLabels& marked) const {
  const std::size_t nodes = problem_.node_count();
  std::vector<std::uint32_t> row(nodes + 1, 0);
  for (const WideProblem::Edge& e : problem_.edges) {
    ++row[e.from];
    ++row[e.to];
  }
  for (std::size_t i = 1; i <= nodes; ++i) row[i] += row[i - 1];
  std::vector<std::uint32_t> edge(row[nodes]);
  for (std::uint32_t e = 0; e < problem_.edges.size(); ++e) {
    edge[--row[problem_.edges[e].from]] = e;
    edge[--row[problem_.edges[e].to]] = e;
  }
  marked.assign(nodes, 0);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t i = 0; i < nodes; ++i) {
    if ((from_source ? terminals_[i].source_left : terminals_[i].sink_left) == 0) continue;
    marked[i] = 1;
    stack.push_back(i);
  }
  while (!stack.empty()) {
    const std::uint32_t i = stack.back();
    stack.pop_back();
    for (std::uint32_t a = row[i]; a < row[i + 1]; ++a) {
      const WideProblem::Edge& e = problem_.edges[edge[a]];
      const Wide flow = result_.edge_flow[edge[a]];
      const bool leaves = e.from == i;
      const std::uint32_t other = leaves ? e.to : e.from;
      if (marked[other] != 0) continue;
      const bool along = leaves == from_source;
      if (e.capacity - (along ? flow : -flow) == 0) continue;
      marked[other] = 1;
      stack.push_back(other);
    }
  }
}

Wide WideSearch::cost(const CutLabels& source_side) const {
  Wide sum = problem_.constant;
  for (std::size_t i = 0; i < source_side.size(); ++i) {
    sum += source_side[i] != 0 ? problem_.to_sink[i] : problem_.to_source[i];
  }
  for (const WideProblem::Edge& e : problem_.edges) {
    if (source_side[e.from] != source_side[e.to]) sum += e.capacity;
  }
  return sum;
}

void WideSearch::finish() {
  result_.value = problem_.constant;
  for (const Terminal& t : terminals_) result_.value += t.from_source;
  search(true, result_.smallest_source_side);
  search(false, result_.largest_source_side);
  for (std::uint8_t& side : result_.largest_source_side) side ^= 1U;
  if (cost(result_.smallest_source_side) != result_.value ||
      cost(result_.largest_source_side) != result_.value) {
    throw CertificateError("solver '" + solver_.info().name + "': the flow is not maximal");
  }
}

WideCut WideSearch::run() {
  constexpr int kMostBits = 124;
  constexpr Wide kUnbounded = Wide{1} << kMostBits;
  Wide bound = kUnbounded;
  int last = kMostBits;
  find_terminals();
  while (last > 0) {
    observer_.check();
    const int shift = least_shift(bound);
    if (shift >= last) throw LimitError("the capacities are too large; lower --area-bits");
    bound = add_digit(bound, shift);
    find_terminals();
    last = shift;
  }
  finish();
  return std::move(result_);
}

// The sum of all capacities, both directions of every edge.
Wide sum_of(const WideProblem& problem) {
  Wide sum = 0;
  for (const Wide capacity : problem.to_source) sum += capacity;
  for (const Wide capacity : problem.to_sink) sum += capacity;
  for (const WideProblem::Edge& edge : problem.edges) sum += 2 * edge.capacity;
  return sum;
}

// Where the solver takes the problem as it is, CutSolver::solve checks the flow and finds both
// cuts.
WideCut solve_narrow(const WideProblem& problem, CutSolver& solver, Observer& observer,
                     std::span<const double> start) {
  const auto narrow = [](Wide capacity) { return static_cast<std::int64_t>(capacity); };
  CutProblem same;
  same.to_source.reserve(problem.node_count());
  same.to_sink.reserve(problem.node_count());
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    same.to_source.push_back(narrow(problem.to_source[i]));
    same.to_sink.push_back(narrow(problem.to_sink[i]));
  }
  same.edges.reserve(problem.edges.size());
  for (const WideProblem::Edge& edge : problem.edges) {
    same.edges.push_back({edge.from, edge.to, narrow(edge.capacity), narrow(edge.capacity)});
  }
  CutResult cut = maximum_flow(solver, same, observer, start, 0);
  return {problem.constant + cut.value,
          {cut.edge_flow.begin(), cut.edge_flow.end()},
          std::move(cut.smallest_source_side),
          std::move(cut.largest_source_side),
          1};
}

}  // namespace

WideCut solve_wide(const WideProblem& problem, CutSolver& solver, Observer& observer,
                   std::span<const double> start) {
  observer.check();
  if (sum_of(problem) < Wide{solver.info().capacity_limit}) {
    return solve_narrow(problem, solver, observer, start);
  }
  return WideSearch(problem, solver, observer, start).run();
}

}  // namespace cellocut
