#include "solvers/packed_graph.h"

#include <algorithm>

#include "solvers/residual_graph.h"

namespace cellocut::solvers {

namespace {

constexpr std::uint32_t kSisterBits = 0x7fff'ffffU;

// Takes excess back along the arcs it came by. With `sign` -1 the same for deficits.
class Return {
 public:
  // Precondition: every arc holds its net flow in place of its residual capacity.
  Return(PackedGraph& graph, const SolveContext& context) : graph_(graph), context_(context) {}
  void run(const std::vector<std::int64_t>& excess, std::int64_t sign);

 private:
  enum State : std::uint8_t { kNew, kOnPath, kDone };

  void search(std::uint32_t start);
  void cancel_cycle(std::uint32_t closing_node);
  void move_up(std::uint32_t i);
  // Flow of arc a that goes into its tail, in the orientation of the run.
  [[nodiscard]] std::int64_t inflow(std::uint32_t a) const {
    return -sign_ * graph_.arcs[a].residual;
  }
  void reduce(std::uint32_t a, std::int64_t amount) {
    graph_.arcs[a].residual += sign_ * amount;
    graph_.arcs[graph_.arcs[a].sister].residual -= sign_ * amount;
  }

  PackedGraph& graph_;
  const SolveContext& context_;
  std::int64_t sign_ = 1;
  std::int64_t steps_ = 0;
  std::vector<std::int64_t> excess_;    // still to be taken back
  std::vector<std::uint32_t> current_;  // arcs of the row before it need not be looked at again
  std::vector<std::uint8_t> state_;
  std::vector<std::uint32_t> path_;   // of the search, each node gets flow from the next
  std::vector<std::uint32_t> order_;  // every node behind all that its flow comes from
};

void Return::run(const std::vector<std::int64_t>& excess, std::int64_t sign) {
  const std::uint32_t count = graph_.node_count();
  const auto drawn = [&](std::uint32_t i) {
    return std::max<std::int64_t>(0, sign * graph_.terminal[i]);
  };
  sign_ = sign;
  excess_.assign(count, 0);
  std::vector<std::uint32_t> starts;
  for (std::uint32_t i = 0; i < count; ++i) {
    excess_[i] = std::max<std::int64_t>(0, sign * excess[i]);
    if (excess_[i] > drawn(i)) starts.push_back(i);
  }
  if (starts.empty()) return;
  current_.assign(graph_.row.begin(), graph_.row.end() - 1);
  state_.assign(count, kNew);
  order_.clear();
  for (const std::uint32_t i : starts) {
    if (state_[i] == kNew) search(i);
  }
  for (std::size_t k = order_.size(); k-- > 0;) {
    const std::uint32_t i = order_[k];
    excess_[i] -= std::min(excess_[i], drawn(i));
    if (excess_[i] > 0) move_up(i);
  }
}

// Depth first along arcs that carry flow in.
void Return::search(std::uint32_t start) {
  constexpr std::int64_t kPollInterval = 4096;
  path_.assign(1, start);
  state_[start] = kOnPath;
  while (!path_.empty()) {
    if (++steps_ % kPollInterval == 0) context_.check();
    const std::uint32_t i = path_.back();
    std::uint32_t& a = current_[i];
    const std::uint32_t end = graph_.row[i + 1];
    while (a < end && (inflow(a) <= 0 || state_[graph_.arcs[a].head] == kDone)) ++a;
    if (a == end) {
      state_[i] = kDone;
      order_.push_back(i);
      path_.pop_back();
      continue;
    }
    const std::uint32_t above = graph_.arcs[a].head;
    if (state_[above] == kOnPath) {
      cancel_cycle(above);
    } else {
      state_[above] = kOnPath;
      path_.push_back(above);
    }
  }
}

// The end of the path gets flow from `closing_node`, which is on the path. The path is cut behind
// the first node that gets no more from the next.
void Return::cancel_cycle(std::uint32_t closing_node) {
  std::size_t begin = path_.size();
  std::int64_t amount = kCapacityLimit;
  do {
    --begin;
    amount = std::min(amount, inflow(current_[path_[begin]]));
  } while (path_[begin] != closing_node);
  std::size_t keep = path_.size();
  for (std::size_t k = path_.size(); k-- > begin;) {
    const std::uint32_t a = current_[path_[k]];
    reduce(a, amount);
    if (inflow(a) == 0) keep = k + 1;
  }
  for (std::size_t k = keep; k < path_.size(); ++k) state_[path_[k]] = kNew;
  path_.resize(keep);
}

// What flows in and what the node drew itself is at least what flows out and its excess.
void Return::move_up(std::uint32_t i) {
  std::int64_t& left = excess_[i];
  for (std::uint32_t a = graph_.row[i]; left > 0 && a < graph_.row[i + 1]; ++a) {
    const std::int64_t amount = std::min(left, inflow(a));
    if (amount <= 0) continue;
    reduce(a, amount);
    left -= amount;
    excess_[graph_.arcs[a].head] += amount;
  }
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

void PackedGraph::send(const std::vector<std::int64_t>& edge_flow,
                       std::vector<std::int64_t>& balance) {
  for (std::size_t e = 0; e < edge_flow.size(); ++e) {
    if (arc_of_edge[e] == kNoArc) continue;
    const std::uint32_t along = arc_of_edge[e];
    const std::uint32_t against = arcs[along].sister;
    const std::int64_t amount =
        std::clamp(edge_flow[e], -arcs[against].residual, arcs[along].residual);
    balance[arcs[against].head] -= amount;
    balance[arcs[along].head] += amount;
    if (amount > 0) push(along, amount);
    if (amount < 0) push(against, -amount);
  }
}

std::int64_t PackedGraph::bytes() const {
  return static_cast<std::int64_t>(row.size() * sizeof(row[0]) + arcs.size() * sizeof(arcs[0]) +
                                   arc_of_edge.size() * sizeof(arc_of_edge[0]) +
                                   terminal.size() * sizeof(terminal[0]));
}

std::vector<std::int64_t> returned_flow(PackedGraph& graph, const CutProblem& problem,
                                        const std::vector<std::int64_t>& excess,
                                        const SolveContext& context) {
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    if (graph.arc_of_edge[e] == PackedGraph::kNoArc) continue;
    PackedArc& arc = graph.arcs[graph.arc_of_edge[e]];
    arc.residual = problem.edges[e].capacity - arc.residual;
    graph.arcs[arc.sister].residual = -arc.residual;
  }
  Return step(graph, context);
  step.run(excess, 1);
  step.run(excess, -1);
  std::vector<std::int64_t> edge_flow(problem.edges.size(), 0);
  for (std::size_t e = 0; e < edge_flow.size(); ++e) {
    const std::uint32_t a = graph.arc_of_edge[e];
    if (a != PackedGraph::kNoArc) edge_flow[e] = graph.arcs[a].residual;
  }
  return edge_flow;
}

}  // namespace cellocut::solvers
