// push_relabel: Goldberg-Tarjan preflows, first in first out in waves, with global relabelling.
//
// Definition. A preflow obeys the capacities, and no node sends on more than it receives; what a
// node has too much is its excess. A labelling d is valid when d(i) <= d(j) + 1 for every residual
// arc i -> j and d = 0 at the sinks. An active node (with excess) pushes along residual arcs with
// d(i) = d(j) + 1, and where it has none, it is relabelled to the least d(j) + 1 over its residual
// arcs.
//
// A start (SolveOptions) is a pseudoflow: what its edges bring a node too much is excess from the
// beginning, and what they take too much is a deficit, which takes up excess like a sink does. In
// the end no residual path leads from an excess to a deficit, and that is all that phase two needs.
//
// Terminals are implicit. Every node has one signed balance:
//   balance > 0   excess,
//   balance < 0   minus what the node can still absorb; such a node is a sink, with label 0.
// Phase one starts with all source arcs saturated, balance = terminal (see packed_graph.h), and
// moves as much excess as possible into the sinks; nodes from which no sink can be reached are set
// aside. What is left is a maximum preflow. Phase two makes it a flow: excess goes back to where it
// came from, in one sweep along the acyclic part of the flow (packed_graph.h). Both are timed.
//
// Which terminal is the source. The problem is mirrored where the sink's arcs carry less in all
// than the source's: what starts as excess and cannot be absorbed is work for nothing.
//
// Order. Active nodes are worked off in waves, those that become active meanwhile wait for the
// next; a global relabelling sorts the wave by label, the greatest first, so that excess of many
// nodes runs together on its way down. Highest label first moves the excess that is left behind a
// saturated cut about in a small part of it at a time (push_relabel_highest.cpp does that,
// README.md has both measured).
//
// Invariants. (1) The labelling is valid, so d(i) is a lower bound on the number of arcs from i to
// a sink. (2) A node with d(i) = n cannot reach a sink ("set aside"). (3) Every active node with
// d < n is in the wave in hand or in the next.
//
// Heuristics. Exact labels by breadth-first search against residual arcs from all sinks, at the
// start and, between waves, whenever relabelling has cost about a quarter of such a search. That
// is six times as often as Cherkassky and Goldberg advise, and finds cut-off regions so early that
// lists of levels, to find gaps among the labels, no longer pay for themselves.
//
// Complexity. O(n^3) for first in first out (Goldberg and Tarjan 1988). Layout: 24 bytes per node,
// 16 per arc.
//
// References.
//   A. V. Goldberg, R. E. Tarjan: A new approach to the maximum-flow problem. Journal of the ACM
//   35(4), 1988. B. V. Cherkassky, A. V. Goldberg: On implementing the push-relabel method for the
//   maximum flow problem. Algorithmica 19, 1997 (global relabelling, two phases).
//
// Licence: GPL-3.0-or-later, this project's own code. Capabilities: exact for every valid problem
// with fewer than 2^30 edges, returns a flow, one thread, can be cancelled.
#include <algorithm>
#include <memory>

#include "solvers/packed_graph.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

struct Node {
  std::int64_t balance;
  std::uint32_t first;    // of its row of arcs; the next node's `first` ends it
  std::uint32_t current;  // arc at which the search for an admissible one goes on
  std::uint32_t label;
};

class Preflow {
 public:
  Preflow(PackedGraph& graph, const std::vector<std::int64_t>& balance,
          const SolveContext& context);
  // Moves as much excess as possible into nodes of negative balance.
  void run();
  [[nodiscard]] std::vector<std::int64_t> excess() const;

  std::int64_t pushes = 0;
  std::int64_t relabels = 0;
  std::int64_t global_relabels = 0;
  [[nodiscard]] std::int64_t bytes() const {
    return static_cast<std::int64_t>(nodes_.size() * sizeof(Node) +
                                     (queue_.size() + wave_.capacity() + next_.capacity()) *
                                         sizeof(std::uint32_t));
  }

 private:
  void global_relabel();
  void discharge(std::uint32_t i);
  void relabel(std::uint32_t i);

  std::uint32_t count_;
  std::vector<Node> nodes_;           // and one behind the last, for its `first`
  std::vector<std::uint32_t> wave_;   // active nodes, in the order in which they are worked off
  std::vector<std::uint32_t> next_;   // those that became active since, or still are
  std::vector<std::uint32_t> queue_;  // of the breadth-first search
  PackedGraph& graph_;
  const PackedArc* arcs_;
  const SolveContext& context_;
  std::int64_t work_ = 0;  // since the last global relabelling
};

Preflow::Preflow(PackedGraph& graph, const std::vector<std::int64_t>& balance,
                 const SolveContext& context)
    : count_(graph.node_count()),
      nodes_(std::size_t{count_} + 1),
      queue_(count_),
      graph_(graph),
      arcs_(graph.arcs.data()),
      context_(context) {
  for (std::uint32_t i = 0; i < count_; ++i) {
    nodes_[i] = {balance[i], graph.row[i], graph.row[i], 0};
  }
  nodes_[count_] = {0, graph.row[count_], graph.row[count_], 0};
}

// Labels become exact distances to the nodes of negative balance; the rest is set aside.
void Preflow::global_relabel() {
  ++global_relabels;
  work_ = 0;
  next_.clear();
  std::uint32_t queued = 0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    Node& node = nodes_[i];
    node.current = node.first;
    node.label = count_;
    if (node.balance < 0) {
      node.label = 0;
      queue_[queued++] = i;
    }
  }
  for (std::uint32_t k = 0; k < queued; ++k) {
    const std::uint32_t i = queue_[k];
    const Node& node = nodes_[i];
    if (node.balance > 0) next_.push_back(i);
    for (std::uint32_t a = node.first; a < nodes_[i + 1].first; ++a) {
      Node& other = nodes_[arcs_[a].head];
      if (other.label == count_ && arcs_[a].sister_open != 0) {
        other.label = node.label + 1;
        queue_[queued++] = arcs_[a].head;
      }
    }
  }
  std::reverse(next_.begin(), next_.end());
}

// Precondition: i has no admissible arc.
void Preflow::relabel(std::uint32_t i) {
  ++relabels;
  Node& node = nodes_[i];
  std::uint32_t least = count_;
  std::uint32_t where = node.first;
  const std::uint32_t end = nodes_[i + 1].first;
  for (std::uint32_t a = node.first; a < end; ++a) {
    if (arcs_[a].residual == 0) continue;
    const std::uint32_t label = nodes_[arcs_[a].head].label;
    if (label < least) {
      least = label;
      where = a;
    }
  }
  constexpr std::int64_t kRelabelCost = 12;
  work_ += kRelabelCost + end - node.first;
  node.current = where;
  node.label = std::min(least + 1, count_);
}

// Pushes until the excess of i is gone; where that takes a new label, i waits for the next wave.
void Preflow::discharge(std::uint32_t i) {
  Node& node = nodes_[i];
  const std::uint32_t end = nodes_[i + 1].first;
  for (; node.current < end; ++node.current) {
    const PackedArc& arc = arcs_[node.current];
    if (arc.residual == 0) continue;
    Node& other = nodes_[arc.head];
    if (other.label + 1 != node.label) continue;
    const std::int64_t amount = std::min(node.balance, arc.residual);
    graph_.push(node.current, amount);
    const bool was_active = other.balance > 0;
    other.balance += amount;
    node.balance -= amount;
    ++pushes;
    if (!was_active && other.balance > 0) next_.push_back(arc.head);
    if (node.balance == 0) return;
  }
  relabel(i);
  if (node.label < count_) next_.push_back(i);
}

void Preflow::run() {
  constexpr std::int64_t kPollInterval = 4096;
  const std::int64_t interval = 2 * std::int64_t{count_} + nodes_[count_].first / 4;
  global_relabel();
  std::int64_t step = 0;
  while (!next_.empty()) {
    wave_.swap(next_);
    next_.clear();
    for (const std::uint32_t i : wave_) {
      if (++step % kPollInterval == 0) context_.check();
      discharge(i);
    }
    if (work_ > interval) global_relabel();
  }
}

std::vector<std::int64_t> Preflow::excess() const {
  std::vector<std::int64_t> result(count_);
  for (std::uint32_t i = 0; i < count_; ++i) result[i] = nodes_[i].balance;
  return result;
}

// The same problem with source and sink exchanged and every arc turned round: its residual
// capacities are those of the opposite arcs, so doing it twice is doing nothing.
void mirror(PackedGraph& graph) {
  for (std::int64_t& terminal : graph.terminal) terminal = -terminal;
  for (std::uint32_t a = 0; a < graph.arcs.size(); ++a) {
    PackedArc& arc = graph.arcs[a];
    if (arc.sister < a) continue;
    PackedArc& sister = graph.arcs[arc.sister];
    std::swap(arc.residual, sister.residual);
    arc.sister_open = sister.residual != 0;
    sister.sister_open = arc.residual != 0;
  }
}

// Whether less can flow into the sink than out of the source, by the capacities of their arcs.
bool less_at_sink(const std::vector<std::int64_t>& balance) {
  std::int64_t more_at_source = 0;
  for (const std::int64_t amount : balance) more_at_source += amount;
  return more_at_source > 0;
}

class PushRelabel final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "push_relabel";
      i.summary = "preflows in waves, global relabelling; returns a flow";
      i.licence = "GPL-3.0-or-later";
      i.reference =
          "Goldberg and Tarjan, J. ACM 35(4), 1988; Cherkassky and Goldberg, Algorithmica 19, 1997";
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    PackedGraph graph(problem);
    std::vector<std::int64_t> balance = graph.terminal;
    if (context.start() != nullptr) graph.send(*context.start(), balance);
    const bool mirrored = less_at_sink(balance);
    if (mirrored) {
      mirror(graph);
      for (std::int64_t& amount : balance) amount = -amount;
    }
    Preflow preflow(graph, balance, context);
    context.built();
    if (graph.node_count() > 0) preflow.run();
    std::vector<std::int64_t> excess = preflow.excess();
    if (mirrored) {
      mirror(graph);
      for (std::int64_t& amount : excess) amount = -amount;
    }
    return {returned_flow(graph, problem, excess, context),
            {{"pushes", preflow.pushes},
             {"relabels", preflow.relabels},
             {"global_relabels", preflow.global_relabels},
             {"mirrored", mirrored ? 1 : 0}},
            graph.bytes() + preflow.bytes()};
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_push_relabel();
std::unique_ptr<CutSolver> make_push_relabel() { return std::make_unique<PushRelabel>(); }

}  // namespace cellocut::solvers
