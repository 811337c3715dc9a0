// push_relabel_highest: Goldberg-Tarjan preflows, highest label first, with global relabelling and
// gaps.
//
// Definition. A preflow obeys the capacities, and no node sends on more than it receives; what a
// node has too much is its excess. A labelling d is valid when d(i) <= d(j) + 1 for every residual
// arc i -> j and d = 0 at the sinks. An active node (with excess) pushes along residual arcs with
// d(i) = d(j) + 1, and where it has none, it is relabelled to the least d(j) + 1 over its residual
// arcs.
//
// Terminals are implicit. Every node has one signed balance:
//   balance > 0   excess,
//   balance < 0   minus what the node can still absorb; such a node is a sink, with label 0.
// Phase one starts with all source arcs saturated, balance = terminal (see residual_graph.h), and
// moves as much excess as possible into the sinks; nodes from which no sink can be reached are set
// aside. What is left is a maximum preflow. Phase two makes it a flow: excess goes back to where it
// came from. Now a node absorbs what it drew from the source, so excess is first cancelled where it
// stands, and the rest is moved by the same routine; in the residual graph every excess has a way
// back to the source. Nodes that could still absorb for the real sink take no part, they cannot be
// reached.
//
// Which terminal is the source. The problem is mirrored where fewer nodes are joined to the sink
// than to the source: work follows the number of nodes that start with excess. On cuts of
// tetrahedra, where most nodes of a body border its shell, that is four times faster.
//
// Invariants. (1) The labelling is valid, so d(i) is a lower bound on the number of arcs from i to
// a sink. (2) A node with d(i) = n cannot reach a sink ("set aside"). (3) Every node with d < n is
// in the level list of its label, every active one also in that label's stack. (4) No active node
// has a label above `highest_`.
//
// Heuristics. Exact labels by breadth-first search against residual arcs from all sinks, at the
// start of each phase and whenever relabelling has cost as much as such a search. Gap: where a
// level runs empty, all nodes above it are set aside.
//
// Complexity. O(n^2 sqrt(m)) for highest label selection (Cheriyan and Maheshwari 1989), each
// phase.
//
// References.
//   A. V. Goldberg, R. E. Tarjan: A new approach to the maximum-flow problem. Journal of the ACM
//   35(4), 1988. B. V. Cherkassky, A. V. Goldberg: On implementing the push-relabel method for the
//   maximum flow problem. Algorithmica 19, 1997 (highest label, global relabelling, gap). J.
//   Cheriyan, S. N. Maheshwari: Analysis of preflow push algorithms for maximum network flow. SIAM
//   Journal on Computing 18(6), 1989.
//
// Licence: GPL-3.0-or-later, this project's own code. Capabilities: exact for every valid problem,
// returns a flow, one thread, can be cancelled.
#include <algorithm>
#include <limits>
#include <memory>

#include "solvers/residual_graph.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

constexpr std::uint32_t kNone = 0xffff'ffffU;

struct Node {
  std::int64_t balance;
  std::uint32_t first;    // of its row of arcs; the next node's `first` ends it
  std::uint32_t current;  // arc at which the search for an admissible one goes on
  std::uint32_t label;
  std::uint32_t next_active;  // in the stack of active nodes of this label
  std::uint32_t next_level;   // in the doubly linked list of all nodes of this label
  std::uint32_t previous_level;
};

class Preflow {
 public:
  Preflow(ResidualGraph& graph, const SolveContext& context);
  // Moves as much excess as possible into nodes of negative balance.
  void run();
  // Between the phases: from "absorbs for the sink" to "absorbs what it drew from the source".
  void turn_to_source(const std::vector<std::int64_t>& terminal);

  std::int64_t pushes = 0;
  std::int64_t relabels = 0;
  std::int64_t global_relabels = 0;
  std::int64_t gaps = 0;
  [[nodiscard]] std::int64_t bytes() const {
    return static_cast<std::int64_t>(nodes_.size() * sizeof(Node) +
                                     (active_.size() + level_.size() + queue_.size()) *
                                         sizeof(std::uint32_t));
  }

 private:
  void global_relabel();
  void discharge(std::uint32_t i);
  void relabel(std::uint32_t i);
  void close_gap(std::uint32_t empty_level);
  void add_to_level(std::uint32_t i);
  void remove_from_level(std::uint32_t i);
  void add_active(std::uint32_t i) {
    Node& node = nodes_[i];
    node.next_active = active_[node.label];
    active_[node.label] = i;
    highest_ = std::max(highest_, node.label);
  }

  std::uint32_t count_;
  std::vector<Node> nodes_;            // and one behind the last, for its `first`
  std::vector<std::uint32_t> active_;  // per label, top of the stack of active nodes
  std::vector<std::uint32_t> level_;   // per label, first of the list of nodes
  std::vector<std::uint32_t> queue_;   // of the breadth-first search
  const Arc* arcs_;
  std::int64_t* residual_;
  const SolveContext& context_;
  std::uint32_t highest_ = 0;        // no active node above
  std::uint32_t highest_level_ = 0;  // no node in a level list above
  std::int64_t work_ = 0;            // since the last global relabelling
};

Preflow::Preflow(ResidualGraph& graph, const SolveContext& context)
    : count_(graph.node_count()),
      nodes_(std::size_t{count_} + 1),
      active_(std::size_t{count_} + 1),
      level_(std::size_t{count_} + 1),
      queue_(count_),
      arcs_(graph.arcs.data()),
      residual_(graph.residual.data()),
      context_(context) {
  for (std::uint32_t i = 0; i < count_; ++i) {
    nodes_[i] = {graph.terminal[i], graph.row[i], graph.row[i], 0, kNone, kNone, kNone};
  }
  nodes_[count_] = {0, graph.row[count_], graph.row[count_], 0, kNone, kNone, kNone};
}

inline void Preflow::add_to_level(std::uint32_t i) {
  Node& node = nodes_[i];
  node.next_level = level_[node.label];
  node.previous_level = kNone;
  if (node.next_level != kNone) nodes_[node.next_level].previous_level = i;
  level_[node.label] = i;
  highest_level_ = std::max(highest_level_, node.label);
}

inline void Preflow::remove_from_level(std::uint32_t i) {
  const Node& node = nodes_[i];
  if (node.previous_level == kNone) {
    level_[node.label] = node.next_level;
  } else {
    nodes_[node.previous_level].next_level = node.next_level;
  }
  if (node.next_level != kNone) nodes_[node.next_level].previous_level = node.previous_level;
}

// Labels become exact distances to the nodes of negative balance; the rest is set aside.
void Preflow::global_relabel() {
  ++global_relabels;
  work_ = 0;
  highest_ = 0;
  highest_level_ = 0;
  std::fill(active_.begin(), active_.end(), kNone);
  std::fill(level_.begin(), level_.end(), kNone);
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
    add_to_level(i);
    const Node& node = nodes_[i];
    if (node.balance > 0) add_active(i);
    for (std::uint32_t a = node.first; a < nodes_[i + 1].first; ++a) {
      Node& other = nodes_[arcs_[a].head];
      if (other.label == count_ && residual_[arcs_[a].id ^ 1U] > 0) {
        other.label = node.label + 1;
        queue_[queued++] = arcs_[a].head;
      }
    }
  }
}

// All nodes above the empty level are cut off from the sinks.
void Preflow::close_gap(std::uint32_t empty_level) {
  ++gaps;
  for (std::uint32_t d = empty_level + 1; d <= highest_level_; ++d) {
    for (std::uint32_t i = level_[d]; i != kNone; i = nodes_[i].next_level) {
      nodes_[i].label = count_;
    }
    level_[d] = kNone;
    active_[d] = kNone;
  }
  highest_level_ = empty_level;
  highest_ = std::min(highest_, empty_level);
}

// Precondition: i has no admissible arc and is in no stack of active nodes.
void Preflow::relabel(std::uint32_t i) {
  ++relabels;
  Node& node = nodes_[i];
  const std::uint32_t before = node.label;
  std::uint32_t least = count_;
  std::uint32_t where = node.first;
  const std::uint32_t end = nodes_[i + 1].first;
  for (std::uint32_t a = node.first; a < end; ++a) {
    if (residual_[arcs_[a].id] == 0) continue;
    const std::uint32_t label = nodes_[arcs_[a].head].label;
    if (label < least) {
      least = label;
      where = a;
    }
  }
  constexpr std::int64_t kRelabelCost = 12;
  work_ += kRelabelCost + end - node.first;
  remove_from_level(i);
  node.current = where;
  if (level_[before] == kNone) {
    node.label = count_;
    close_gap(before);
  } else if (least + 1 >= count_) {
    node.label = count_;
  } else {
    node.label = least + 1;
    add_to_level(i);
  }
}

// Pushes until the excess of i is gone or i is set aside.
void Preflow::discharge(std::uint32_t i) {
  Node& node = nodes_[i];
  const std::uint32_t end = nodes_[i + 1].first;
  while (node.label < count_) {
    for (; node.current < end; ++node.current) {
      const Arc arc = arcs_[node.current];
      if (residual_[arc.id] == 0) continue;
      Node& other = nodes_[arc.head];
      if (other.label + 1 != node.label) continue;
      const std::int64_t amount = std::min(node.balance, residual_[arc.id]);
      residual_[arc.id] -= amount;
      residual_[arc.id ^ 1U] += amount;
      const bool was_active = other.balance > 0;
      other.balance += amount;
      node.balance -= amount;
      ++pushes;
      if (!was_active && other.balance > 0) add_active(arc.head);
      if (node.balance == 0) return;
    }
    relabel(i);
  }
}

void Preflow::run() {
  constexpr std::int64_t kPollInterval = 4096;
  // Twice as rare as in Cherkassky and Goldberg: a tenth faster on cuts of tetrahedra.
  const std::int64_t interval = 12 * std::int64_t{count_} + nodes_[count_].first;
  global_relabel();
  for (std::int64_t step = 1;; ++step) {
    if (step % kPollInterval == 0) context_.check();
    while (highest_ > 0 && active_[highest_] == kNone) --highest_;
    const std::uint32_t i = active_[highest_];
    if (i == kNone) return;
    active_[highest_] = nodes_[i].next_active;
    discharge(i);
    if (work_ > interval) global_relabel();
  }
}

void Preflow::turn_to_source(const std::vector<std::int64_t>& terminal) {
  for (std::uint32_t i = 0; i < count_; ++i) {
    std::int64_t& balance = nodes_[i].balance;
    balance = std::max<std::int64_t>(balance, 0) - std::max<std::int64_t>(terminal[i], 0);
  }
}

// The same problem with source and sink exchanged and every arc turned round: its residual
// capacities are those of the opposite arcs, so doing it twice is doing nothing.
void mirror(ResidualGraph& graph) {
  for (std::int64_t& terminal : graph.terminal) terminal = -terminal;
  for (std::size_t a = 0; a < graph.residual.size(); a += 2) {
    std::swap(graph.residual[a], graph.residual[a + 1]);
  }
}

// Whether fewer nodes are joined to the sink than to the source. Every node that starts with excess
// has to be worked off, and a cut that leaves most of a body on one side joins most of its nodes to
// that terminal: the other one is the better source.
bool fewer_at_sink(const ResidualGraph& graph) {
  std::int64_t more_at_source = 0;
  for (const std::int64_t terminal : graph.terminal) {
    more_at_source += (terminal > 0 ? 1 : 0) - (terminal < 0 ? 1 : 0);
  }
  return more_at_source > 0;
}

class PushRelabel final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "push_relabel_highest";
      i.summary = "highest label first, global relabelling, gaps; returns a flow";
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
    ResidualGraph graph(problem);
    const bool mirrored = fewer_at_sink(graph);
    if (mirrored) mirror(graph);
    Preflow preflow(graph, context);
    context.built();
    if (graph.node_count() > 0) {
      preflow.run();
      preflow.turn_to_source(graph.terminal);
      preflow.run();
    }
    if (mirrored) mirror(graph);
    return {graph.edge_flow(problem),
            {{"pushes", preflow.pushes},
             {"relabels", preflow.relabels},
             {"global_relabels", preflow.global_relabels},
             {"gaps", preflow.gaps},
             {"mirrored", mirrored ? 1 : 0}},
            graph.bytes() + preflow.bytes()};
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_push_relabel_highest();
std::unique_ptr<CutSolver> make_push_relabel_highest() { return std::make_unique<PushRelabel>(); }

}  // namespace cellocut::solvers
