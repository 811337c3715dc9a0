// bk: augmenting paths on two search trees that are kept between augmentations.
//
// Definition. Two disjoint trees of residual arcs grow from the terminals: every node of the source
// tree S is reached from the source along tree arcs, every node of the sink tree T reaches the
// sink. The other nodes are free. Three steps alternate:
//   growth        an active node takes over free neighbours across residual arcs; where it meets
//   the other
//                 tree there is a path from source to sink;
//   augmentation  the bottleneck is pushed along that path; nodes whose tree arc is now saturated
//   become
//                 orphans;
//   adoption      an orphan looks for a new parent in its own tree whose root is still a terminal;
//   where
//                 there is none it becomes free and its children become orphans.
// When no active node is left no residual path joins S and T, and the flow is maximal.
//
// Invariants. (1) The arc between a node and its parent has residual capacity in the direction of
// the flow. (2) A node of S and a node of T joined by a residual arc: one of them is active. (3) A
// node of a tree with a free neighbour across a residual arc is active. (4) `stamp` says as of
// which augmentation the distance `depth` of a node to its terminal was seen to be right; stamps
// only grow towards the root between adoptions, so a walk to the root may stop at the first node
// that bears the current stamp, and a node may change to a nearer parent of at least its own stamp
// without closing a cycle.
//
// Complexity. O(n^2 m C) for a minimum cut of value C: worse than any push-relabel bound, and near
// linear on the shallow, regular instances of geometry and vision, for which it was made. For long
// thin graphs prefer push_relabel.
//
// Layout. 32 bytes per node; the parent is kept as node and arc id, so that walks to the root touch
// nodes alone and augmentations touch nodes and residuals alone (see residual_graph.h). The side
// and the depth share a word, depths of one tree compare as that word. Active nodes are an
// intrusive first-in-first-out list.
//
// References.
//   Y. Boykov, V. Kolmogorov: An experimental comparison of min-cut/max-flow algorithms for energy
//   minimization in vision. IEEE TPAMI 26(9), 2004.
//   V. Kolmogorov: Graph based algorithms for scene reconstruction from two or more views. PhD
//   thesis, Cornell University, 2004, section 2.4 (stamps and distances).
//
// Licence: GPL-3.0-or-later, this project's own code. Capabilities: exact for every valid problem,
// one thread, can be cancelled.
#include <algorithm>
#include <limits>
#include <memory>

#include "cellocut/base/errors.h"
#include "solvers/residual_graph.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

// Values of Node::parent that are not nodes. A node is in a tree iff its parent is not kFree.
constexpr std::uint32_t kTerminal = 0xffff'fffdU;
constexpr std::uint32_t kOrphan = 0xffff'fffeU;
constexpr std::uint32_t kFree = 0xffff'ffffU;
// Value of Node::next of a node that is not active.
constexpr std::uint32_t kInactive = 0xffff'ffffU;

constexpr std::uint32_t kUnreachable = 0xffff'ffffU;
constexpr std::uint32_t kDepthStep = 2;  // depth is counted in the bits above the side

enum Side : std::uint32_t { kSource = 0, kSink = 1 };

struct Node {
  std::int64_t terminal;     // as in ResidualGraph
  std::uint32_t first;       // of its row of arcs; the next node's `first` ends it
  std::uint32_t parent;      // node, kTerminal, kOrphan or kFree
  std::uint32_t parent_arc;  // id of the arc node -> parent
  std::uint32_t next;        // in the list of active nodes, itself where it is the last
  std::uint32_t stamp;
  std::uint32_t depth;  // kDepthStep * distance to the terminal + side

  [[nodiscard]] Side side() const { return static_cast<Side>(depth & 1U); }
};
static_assert(sizeof(Node) == 32);

class Search {
 public:
  Search(ResidualGraph& graph, const SolveContext& context);
  void run();

  std::int64_t augmentations = 0;
  std::int64_t grown = 0;
  std::int64_t orphans = 0;
  [[nodiscard]] std::int64_t bytes() const {
    return static_cast<std::int64_t>(nodes_.size() * sizeof(Node));
  }

 private:
  // The residual capacity that a tree of that side needs on the arc parent -> child, given the arc
  // child -> parent or neighbour; and on the arc node -> new child.
  template <Side side>
  [[nodiscard]] std::int64_t from_parent(std::uint32_t arc_to_parent) const {
    return residual_[side == kSource ? arc_to_parent ^ 1U : arc_to_parent];
  }
  template <Side side>
  [[nodiscard]] std::int64_t to_child(std::uint32_t arc_to_child) const {
    return residual_[side == kSource ? arc_to_child : arc_to_child ^ 1U];
  }

  void activate(std::uint32_t i);
  std::uint32_t pop_active();
  template <Side side>
  const Arc* grow(std::uint32_t i);
  void augment(std::uint32_t tail, std::uint32_t head, std::uint32_t arc);
  template <Side side>
  std::int64_t bottleneck(std::uint32_t i, std::int64_t amount) const;
  template <Side side>
  void push_to_root(std::uint32_t i, std::int64_t amount);
  void adopt_all();
  template <Side side>
  void adopt(std::uint32_t i);
  template <Side side>
  std::uint32_t root_distance(std::uint32_t i);

  std::vector<Node> nodes_;  // and one behind the last, for its `first`
  const Arc* arcs_;
  std::int64_t* residual_;
  const SolveContext& context_;
  std::uint32_t active_first_ = kInactive;
  std::uint32_t active_last_ = kInactive;
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> made_orphan_;  // by the last augmentation, adopted last in, first out
  std::vector<std::uint32_t> descendants_;  // orphans below the one in hand, first in, first out
};

Search::Search(ResidualGraph& graph, const SolveContext& context)
    : nodes_(std::size_t{graph.node_count()} + 1),
      arcs_(graph.arcs.data()),
      residual_(graph.residual.data()),
      context_(context) {
  const std::uint32_t count = graph.node_count();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::int64_t terminal = graph.terminal[i];
    nodes_[i] = {terminal, graph.row[i], kFree, 0, kInactive, 0, 0};
    if (terminal != 0) {
      nodes_[i].parent = kTerminal;
      nodes_[i].depth = kDepthStep + (terminal > 0 ? kSource : kSink);
      activate(i);
    }
  }
  nodes_[count] = {0, graph.row[count], kFree, 0, kInactive, 0, 0};
}

inline void Search::activate(std::uint32_t i) {
  if (nodes_[i].next != kInactive) return;
  nodes_[i].next = i;
  if (active_last_ == kInactive) {
    active_first_ = i;
  } else {
    nodes_[active_last_].next = i;
  }
  active_last_ = i;
}

// The next active node that is still in a tree, or kInactive.
inline std::uint32_t Search::pop_active() {
  while (active_first_ != kInactive) {
    const std::uint32_t i = active_first_;
    if (nodes_[i].next == i) {
      active_first_ = active_last_ = kInactive;
    } else {
      active_first_ = nodes_[i].next;
    }
    nodes_[i].next = kInactive;
    if (nodes_[i].parent != kFree) return i;
  }
  return kInactive;
}

// Takes over the free neighbours of i. Returns the first arc that meets the other tree, or null.
template <Side side>
const Arc* Search::grow(std::uint32_t i) {
  const Node& node = nodes_[i];
  const Arc* const end = arcs_ + nodes_[i + 1].first;
  for (const Arc* arc = arcs_ + node.first; arc != end; ++arc) {
    if (to_child<side>(arc->id) == 0) continue;
    Node& other = nodes_[arc->head];
    if (other.parent == kFree) {
      other.parent = i;
      other.parent_arc = arc->id ^ 1U;
      other.stamp = node.stamp;
      other.depth = node.depth + kDepthStep;
      activate(arc->head);
    } else if (other.side() != side) {
      return arc;
    } else if (other.stamp <= node.stamp && other.depth > node.depth + kDepthStep) {
      other.parent = i;
      other.parent_arc = arc->id ^ 1U;
      other.stamp = node.stamp;
      other.depth = node.depth + kDepthStep;
    }
  }
  return nullptr;
}

template <Side side>
std::int64_t Search::bottleneck(std::uint32_t i, std::int64_t amount) const {
  while (nodes_[i].parent != kTerminal) {
    amount = std::min(amount, from_parent<side>(nodes_[i].parent_arc));
    i = nodes_[i].parent;
  }
  return std::min(amount, side == kSource ? nodes_[i].terminal : -nodes_[i].terminal);
}

template <Side side>
void Search::push_to_root(std::uint32_t i, std::int64_t amount) {
  while (nodes_[i].parent != kTerminal) {
    Node& node = nodes_[i];
    const std::uint32_t used = side == kSource ? node.parent_arc ^ 1U : node.parent_arc;
    residual_[used] -= amount;
    residual_[used ^ 1U] += amount;
    const std::uint32_t above = node.parent;
    if (residual_[used] == 0) {
      node.parent = kOrphan;
      made_orphan_.push_back(i);
    }
    i = above;
  }
  nodes_[i].terminal -= side == kSource ? amount : -amount;
  if (nodes_[i].terminal == 0) {
    nodes_[i].parent = kOrphan;
    made_orphan_.push_back(i);
  }
}

// Pushes all that fits along the path source .. tail -> head .. sink.
void Search::augment(std::uint32_t tail, std::uint32_t head, std::uint32_t arc) {
  std::int64_t amount = bottleneck<kSource>(tail, residual_[arc]);
  amount = bottleneck<kSink>(head, amount);
  residual_[arc] -= amount;
  residual_[arc ^ 1U] += amount;
  push_to_root<kSource>(tail, amount);
  push_to_root<kSink>(head, amount);
  ++augmentations;
}

// Distance (in steps of depth, side included) of a node of a tree to its terminal, kUnreachable
// where the way up ends at an orphan. Stamps the nodes on the way.
template <Side side>
std::uint32_t Search::root_distance(std::uint32_t i) {
  std::uint32_t distance = 0;
  std::uint32_t j = i;
  while (nodes_[j].stamp != stamp_) {
    const std::uint32_t above = nodes_[j].parent;
    if (above == kOrphan) return kUnreachable;
    if (above == kTerminal) {
      nodes_[j].stamp = stamp_;
      nodes_[j].depth = kDepthStep + side;
      break;
    }
    distance += kDepthStep;
    j = above;
  }
  distance += nodes_[j].depth;
  std::uint32_t depth = distance;
  for (j = i; nodes_[j].stamp != stamp_; j = nodes_[j].parent) {
    nodes_[j].stamp = stamp_;
    nodes_[j].depth = depth;
    depth -= kDepthStep;
  }
  return distance;
}

template <Side side>
void Search::adopt(std::uint32_t i) {
  ++orphans;
  const Arc* const begin = arcs_ + nodes_[i].first;
  const Arc* const end = arcs_ + nodes_[i + 1].first;
  const Arc* best = nullptr;
  std::uint32_t nearest = kUnreachable;
  for (const Arc* arc = begin; arc != end; ++arc) {
    if (from_parent<side>(arc->id) == 0) continue;
    const Node& other = nodes_[arc->head];
    if (other.parent == kFree || other.side() != side) continue;
    const std::uint32_t distance = root_distance<side>(arc->head);
    if (distance < nearest) {
      nearest = distance;
      best = arc;
    }
  }
  Node& node = nodes_[i];
  if (best != nullptr) {
    node.parent = best->head;
    node.parent_arc = best->id;
    node.stamp = stamp_;
    node.depth = nearest + kDepthStep;
    return;
  }
  node.parent = kFree;
  for (const Arc* arc = begin; arc != end; ++arc) {
    Node& other = nodes_[arc->head];
    if (other.parent == kFree || other.side() != side) continue;
    if (from_parent<side>(arc->id) != 0) activate(arc->head);
    if (other.parent == i) {
      other.parent = kOrphan;
      descendants_.push_back(arc->head);
    }
  }
}

void Search::adopt_all() {
  const auto adopt_one = [this](std::uint32_t i) {
    if (nodes_[i].side() == kSource) {
      adopt<kSource>(i);
    } else {
      adopt<kSink>(i);
    }
  };
  while (!made_orphan_.empty()) {
    const std::uint32_t i = made_orphan_.back();
    made_orphan_.pop_back();
    adopt_one(i);
    for (std::size_t k = 0; k < descendants_.size(); ++k) adopt_one(descendants_[k]);
    descendants_.clear();
  }
}

void Search::run() {
  constexpr std::int64_t kPollInterval = 4096;
  std::uint32_t current = kInactive;
  for (std::int64_t step = 1;; ++step) {
    if (step % kPollInterval == 0) context_.check();
    // After an augmentation go on with the same node, if it kept its place in a tree.
    if (current == kInactive || nodes_[current].parent == kFree) {
      current = pop_active();
      if (current == kInactive) return;
      ++grown;
    }
    const bool from_source = nodes_[current].side() == kSource;
    const Arc* meeting = from_source ? grow<kSource>(current) : grow<kSink>(current);
    if (meeting == nullptr) {
      current = kInactive;
      continue;
    }
    if (stamp_ == std::numeric_limits<std::uint32_t>::max()) {
      throw LimitError("bk: more than 2^32 augmentations; use another solver");
    }
    ++stamp_;
    if (from_source) {
      augment(current, meeting->head, meeting->id);
    } else {
      augment(meeting->head, current, meeting->id ^ 1U);
    }
    // Adoption may activate nodes, but not the one in hand: it is scanned again anyway.
    nodes_[current].next = current;
    adopt_all();
    nodes_[current].next = kInactive;
  }
}

class BoykovKolmogorov final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "bk";
      i.summary = "augmenting paths on two search trees, stamps and distances";
      i.licence = "GPL-3.0-or-later";
      i.reference = "Boykov and Kolmogorov, IEEE TPAMI 26(9), 2004";
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    ResidualGraph graph(problem);
    Search search(graph, context);
    context.built();
    search.run();
    return {graph.edge_flow(problem),
            {{"augmentations", search.augmentations},
             {"nodes_grown", search.grown},
             {"orphans", search.orphans}},
            graph.bytes() + search.bytes()};
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_bk();
std::unique_ptr<CutSolver> make_bk() { return std::make_unique<BoykovKolmogorov>(); }

}  // namespace cellocut::solvers
