#include "solvers/packed_graph.h"

#include <algorithm>

#include "solvers/residual_graph.h"

namespace cellocut::solvers {

namespace {

constexpr std::uint32_t kSisterBits = 0x7fff'ffffU;

bool has_arcs(const CutEdge& edge) {
  return edge.from != edge.to && (edge.capacity | edge.reverse_capacity) != 0;
}

// Takes excess back along the arcs it came by. With `sign` -1 the same for deficits.
class Return {
 public:
  Return(const PackedGraph& graph, std::vector<std::int64_t>& flow, const SolveContext& context)
      : graph_(graph), flow_(flow), context_(context) {}
  void run(std::vector<std::int64_t>& excess, std::int64_t sign);

 private:
  void take_back(std::uint32_t start);
  // Flow of arc a that goes into its tail, in the orientation of the run.
  [[nodiscard]] std::int64_t inflow(std::uint32_t a) const { return -sign_ * flow_[a]; }
  void reduce(std::uint32_t a, std::int64_t amount) {
    flow_[a] += sign_ * amount;
    flow_[graph_.arcs[a].sister] -= sign_ * amount;
  }

  const PackedGraph& graph_;
  std::vector<std::int64_t>& flow_;  // per arc, that of its sister is the negative
  const SolveContext& context_;
  std::int64_t sign_ = 1;
  std::int64_t steps_ = 0;
  std::vector<std::int64_t> excess_;     // still to be taken back
  std::vector<std::int64_t> drawn_;      // what a node has from the terminal and can give back
  std::vector<std::uint32_t> current_;   // no arc of the row before it carries flow in
  std::vector<std::uint32_t> position_;  // in the walk, from 1; 0 outside
  std::vector<std::uint32_t> walk_;      // arcs, each from a node to where its flow comes from
};

void Return::run(std::vector<std::int64_t>& excess, std::int64_t sign) {
  const std::uint32_t count = graph_.node_count();
  sign_ = sign;
  std::vector<std::uint32_t> starts;
  excess_.assign(count, 0);
  drawn_.assign(count, 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    drawn_[i] = std::max<std::int64_t>(0, sign * graph_.terminal[i]);
    std::int64_t left = std::max<std::int64_t>(0, sign * excess[i]);
    const std::int64_t here = std::min(left, drawn_[i]);
    drawn_[i] -= here;
    left -= here;
    excess_[i] = left;
    if (left > 0) starts.push_back(i);
  }
  if (starts.empty()) return;
  current_.assign(graph_.row.begin(), graph_.row.end() - 1);
  position_.assign(count, 0);
  for (const std::uint32_t i : starts) {
    while (excess_[i] > 0) take_back(i);
  }
}

// One walk from `start` to a node that can give back. The walk starts anew after each push: where
// the flow branches the walks are short.
void Return::take_back(std::uint32_t start) {
  constexpr std::int64_t kPollInterval = 4096;
  walk_.clear();
  std::uint32_t i = start;
  position_[i] = 1;
  while (drawn_[i] == 0) {
    if (++steps_ % kPollInterval == 0) context_.check();
    std::uint32_t& a = current_[i];
    while (inflow(a) <= 0) ++a;
    const std::uint32_t above = graph_.arcs[a].head;
    walk_.push_back(a);
    if (position_[above] == 0) {
      i = above;
      position_[i] = static_cast<std::uint32_t>(walk_.size()) + 1;
      continue;
    }
    // A cycle, from the walk's arc number position - 1 to the last.
    const std::size_t begin = position_[above] - 1;
    std::int64_t amount = inflow(walk_[begin]);
    for (std::size_t k = begin; k < walk_.size(); ++k) amount = std::min(amount, inflow(walk_[k]));
    for (std::size_t k = begin; k < walk_.size(); ++k) {
      position_[graph_.arcs[walk_[k]].head] = 0;
      reduce(walk_[k], amount);
    }
    walk_.resize(begin);
    i = above;
    position_[i] = static_cast<std::uint32_t>(begin) + 1;
  }
  std::int64_t amount = std::min(excess_[start], drawn_[i]);
  for (const std::uint32_t a : walk_) amount = std::min(amount, inflow(a));
  for (const std::uint32_t a : walk_) {
    position_[graph_.arcs[a].head] = 0;
    reduce(a, amount);
  }
  position_[start] = 0;
  excess_[start] -= amount;
  drawn_[i] -= amount;
}

}  // namespace

PackedGraph::PackedGraph(const CutProblem& problem)
    : row(problem.node_count() + 1, 0),
      arc_of_edge(problem.edges.size(), kNoArc),
      terminal(problem.node_count()) {
  require_index_range(problem, std::uint64_t{kSisterBits});
  for (std::size_t i = 0; i < terminal.size(); ++i) {
    terminal[i] = problem.to_source[i] - problem.to_sink[i];
  }
  for (const CutEdge& edge : problem.edges) {
    if (!has_arcs(edge)) continue;
    ++row[edge.from];
    ++row[edge.to];
  }
  // row[i] becomes the end of row i, and filling backwards moves it to the beginning.
  for (std::size_t i = 1; i < row.size(); ++i) row[i] += row[i - 1];
  arcs.resize(row.back());
  for (std::size_t e = problem.edges.size(); e-- > 0;) {
    const CutEdge& edge = problem.edges[e];
    if (!has_arcs(edge)) continue;
    const std::uint32_t a = --row[edge.from];
    const std::uint32_t s = --row[edge.to];
    arcs[a] = {edge.to, s & kSisterBits, edge.reverse_capacity != 0, edge.capacity};
    arcs[s] = {edge.from, a & kSisterBits, edge.capacity != 0, edge.reverse_capacity};
    arc_of_edge[e] = a;
  }
}

std::int64_t PackedGraph::bytes() const {
  return static_cast<std::int64_t>(row.size() * sizeof(row[0]) + arcs.size() * sizeof(arcs[0]) +
                                   arc_of_edge.size() * sizeof(arc_of_edge[0]) +
                                   terminal.size() * sizeof(terminal[0]));
}

std::vector<std::int64_t> returned_flow(const PackedGraph& graph, const CutProblem& problem,
                                        std::vector<std::int64_t> excess,
                                        const SolveContext& context) {
  std::vector<std::int64_t> flow(graph.arcs.size());
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const std::uint32_t a = graph.arc_of_edge[e];
    if (a == PackedGraph::kNoArc) continue;
    flow[a] = problem.edges[e].capacity - graph.arcs[a].residual;
    flow[graph.arcs[a].sister] = -flow[a];
  }
  Return step(graph, flow, context);
  step.run(excess, 1);
  step.run(excess, -1);
  std::vector<std::int64_t> edge_flow(problem.edges.size(), 0);
  for (std::size_t e = 0; e < edge_flow.size(); ++e) {
    if (graph.arc_of_edge[e] != PackedGraph::kNoArc) edge_flow[e] = flow[graph.arc_of_edge[e]];
  }
  return edge_flow;
}

}  // namespace cellocut::solvers
