// ibfs: incremental breadth-first search from both terminals, level by level.
//
// Definition. As in bk, two disjoint trees of residual arcs grow from the terminals, S from the
// source and T from the sink, and every arc that joins them is used to push flow; here both are
// kept breadth-first. A node has a label: its depth in S, minus its depth in T, or 0 if it is free.
//   growth        scans all nodes of the deepest level of one tree; they take over free neighbours;
//   augmentation  across an arc to the other tree, as much is pushed from root to root as the two
//                 tree paths and the arc let through; nodes whose tree arc is saturated, and roots
//                 that have run dry, become orphans;
//   adoption      an orphan looks for another parent on the level of the old one; where there is
//                 none it is lost, and its children become orphans. When no orphan is left, a
//                 breadth-first search from the tree into the lost nodes gives each its new depth,
//                 and those that would be deeper than the limit become free.
// A level is scanned to its end before a tree is chosen again. When a tree has no node on its
// deepest level, all its nodes have been scanned: no residual arc leaves it, the flow is maximal.
//
// Invariants, between adoptions. (1) A node is one deeper than its parent, and the arc between them
// has residual capacity in the direction of the flow. (2) A residual arc of S leads at most one
// level down, so depths are distances from the source within S; T likewise towards the sink.
// (3) Residual arcs out of S (into T) begin (end) at nodes that have yet to be scanned: those at
// the limit, and in the tree that grows those still in line. (4) Depths of a node never decrease
// while it stays in a tree. (5) Flow is conserved in every node: what is pushed comes from a root
// and arrives at one, so nothing has to be returned at the end. The variant of 2015, which
// saturates the joining arc and lets the excess find its way, is not used here.
//
// Two choices of ours. Adoption is put off: a path that meets an orphan is left alone and its end
// scanned again later, so that one adoption serves many augmentations. And the tree to grow is the
// one that has cost less work per unit of what its terminal had to give: roots of a tree with
// little supply run dry, and take whole subtrees with them.
//
// Complexity. O(n^2 m), independent of capacities, is proved in the paper for one adoption after
// each augmentation; for adoption put off as here no bound is claimed.
//
// Layout. 32 bytes per node and 16 per arc, an arc with its residual capacity in the row of its
// tail and a bit that tells whether the opposite one has any: scans and adoption read rows and the
// nodes they lead to, nothing else. Orphans are intrusive lists by depth.
//
// References.
//   A. V. Goldberg, S. Hed, H. Kaplan, R. E. Tarjan, R. F. Werneck: Maximum flows by incremental
//   breadth-first search. ESA 2011.
//   A. V. Goldberg, S. Hed, H. Kaplan, P. Kohli, R. E. Tarjan, R. F. Werneck: Faster and more
//   dynamic maximum flow by incremental breadth-first search. ESA 2015 (adoption in passes).
//
// Licence: GPL-3.0-or-later, this project's own code. Capabilities: exact for every valid problem
// with fewer than 2^30 edges, one thread, can be cancelled.
#include <algorithm>
#include <cmath>
#include <memory>

#include "solvers/residual_graph.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

// Values of Node::parent that are not arcs.
constexpr std::uint32_t kRoot = 0xffff'fffdU;
constexpr std::uint32_t kOrphan = 0xffff'fffeU;
constexpr std::uint32_t kNone = 0xffff'ffffU;  // of a free node; also the end of a list

constexpr std::uint32_t kSisterBits = 0x7fff'ffffU;  // arc indices fit, see FlowArc

// Barred nodes after which orphans are adopted before the end of the level.
constexpr std::size_t kPatience = 16;

// What the loss of a node costs, in scans of a node.
constexpr std::int64_t kLossWork = 4;

enum Side : std::uint8_t { kSource = 0, kSink = 1 };

constexpr Side opposite(Side side) { return side == kSource ? kSink : kSource; }

struct Node {
  std::int64_t terminal;  // as in ResidualGraph
  std::uint32_t first;    // of its row of arcs; the next node's `first` ends it
  std::uint32_t parent;   // the arc node -> parent, or kRoot, kOrphan, kNone
  std::uint32_t current;  // no arc of the row before it leads to a parent one level up
  std::int32_t label;     // depth in the source tree, minus the depth in the sink tree, 0 if free
  std::uint32_t next;     // in the list of orphans of the same depth
};
static_assert(sizeof(Node) == 32);

struct FlowArc {
  std::uint32_t head;
  std::uint32_t sister : 31;
  std::uint32_t sister_open : 1;  // the sister has residual capacity
  std::int64_t residual;
};
static_assert(sizeof(FlowArc) == 16);

bool has_arcs(const CutEdge& edge) {
  return edge.from != edge.to && (edge.capacity | edge.reverse_capacity) != 0;
}

class Search {
 public:
  Search(const CutProblem& problem, const SolveContext& context);
  void run();
  [[nodiscard]] std::vector<std::int64_t> edge_flow(const CutProblem& problem) const;

  std::int64_t augmentations = 0;
  std::int64_t scanned = 0;
  std::int64_t orphans = 0;
  std::int64_t lost = 0;
  std::int64_t adoptions = 0;
  [[nodiscard]] std::int64_t bytes() const {
    return static_cast<std::int64_t>(nodes_.size() * sizeof(Node) + arcs_.size() * sizeof(FlowArc) +
                                     arc_of_edge_.size() * sizeof(std::uint32_t));
  }

 private:
  // One side of the search. All nodes of a tree have depth <= limit; those of depth < limit (of
  // depth < limit - 1 in the tree that grows) have been scanned.
  struct Tree {
    std::int32_t limit = 1;
    std::int32_t growing = 0;             // the depth whose nodes are being scanned, or 0
    std::vector<std::uint32_t> front;     // all nodes at the limit, and some that were
    std::vector<std::uint32_t> orphaned;  // per depth, first of the list of orphans
    double supply = 0;                    // sum of the capacities of the terminal's arcs
    std::int64_t work = 0;                // nodes scanned and orphans so far
    std::int32_t least = 0;               // no orphan is less deep,
    std::int32_t most = -1;               // or deeper
  };
  struct Offer {  // of a parent to a lost node
    std::uint32_t node;
    std::uint32_t arc;  // node -> parent
  };

  // Depth in the tree of that side, not positive outside.
  template <Side side>
  static std::int32_t depth(const Node& node) {
    return side == kSource ? node.label : -node.label;
  }
  // Residual capacity in the direction of the flow, from the near end of the arc to a child, or
  // from a parent to the near end.
  template <Side side>
  static bool leads_to_child(const FlowArc& arc) {
    return side == kSource ? arc.residual != 0 : arc.sister_open != 0;
  }
  template <Side side>
  static bool leads_to_parent(const FlowArc& arc) {
    return leads_to_child<opposite(side)>(arc);
  }

  void push(std::uint32_t a, std::int64_t amount);
  template <Side side>
  bool grow_level();
  template <Side side>
  bool scan(std::uint32_t i);
  template <Side side>
  std::int64_t bottleneck(std::uint32_t i, std::int64_t amount) const;
  template <Side side>
  void push_to_root(std::uint32_t i, std::int64_t amount);
  template <Side side>
  void set_depth(std::uint32_t i, std::int32_t depth);
  template <Side side>
  void make_orphan(std::uint32_t i);
  template <Side side>
  void adopt_all();
  template <Side side>
  bool keep_depth(std::uint32_t i);
  template <Side side>
  void lose(std::uint32_t i);
  template <Side side>
  void seek(std::uint32_t i);
  template <Side side>
  void settle_lost();

  std::vector<Node> nodes_;  // and one behind the last, for its `first`
  std::vector<FlowArc> arcs_;
  std::vector<std::uint32_t> arc_of_edge_;
  const SolveContext& context_;
  Tree trees_[2];
  std::vector<std::uint32_t> level_;        // nodes of the level that is being grown
  std::vector<std::uint32_t> again_;        // of these, to be scanned again after adoption
  std::vector<std::vector<Offer>> offers_;  // by the depth that the node would have
  std::int32_t least_offer_ = 0;
  std::int32_t most_offer_ = -1;
};

Search::Search(const CutProblem& problem, const SolveContext& context)
    : nodes_(problem.node_count() + 1, {0, 0, kNone, 0, 0, kNone}),
      arc_of_edge_(problem.edges.size(), kNone),
      context_(context) {
  for (const CutEdge& edge : problem.edges) {
    if (!has_arcs(edge)) continue;
    ++nodes_[edge.from].first;
    ++nodes_[edge.to].first;
  }
  const auto count = static_cast<std::uint32_t>(problem.node_count());
  // `first` becomes the end of the row, and filling backwards moves it to the beginning.
  std::uint32_t end = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    Node& node = nodes_[i];
    end += node.first;
    node.first = end;
    node.terminal = problem.to_source[i] - problem.to_sink[i];
    if (node.terminal == 0) continue;
    node.parent = kRoot;
    node.label = node.terminal > 0 ? 1 : -1;
    Tree& tree = trees_[node.terminal > 0 ? kSource : kSink];
    tree.front.push_back(i);
    tree.supply += std::abs(static_cast<double>(node.terminal));
  }
  nodes_[count].first = end;
  arcs_.resize(end);
  for (auto e = static_cast<std::uint32_t>(problem.edges.size()); e-- > 0;) {
    const CutEdge& edge = problem.edges[e];
    if (!has_arcs(edge)) continue;
    const std::uint32_t a = --nodes_[edge.from].first;
    const std::uint32_t s = --nodes_[edge.to].first;
    arcs_[a] = {edge.to, s & kSisterBits, edge.reverse_capacity != 0, edge.capacity};
    arcs_[s] = {edge.from, a & kSisterBits, edge.capacity != 0, edge.reverse_capacity};
    arc_of_edge_[e] = a;
  }
}

std::vector<std::int64_t> Search::edge_flow(const CutProblem& problem) const {
  std::vector<std::int64_t> flow(problem.edges.size(), 0);
  for (std::size_t e = 0; e < flow.size(); ++e) {
    if (arc_of_edge_[e] == kNone) continue;
    flow[e] = problem.edges[e].capacity - arcs_[arc_of_edge_[e]].residual;
  }
  return flow;
}

inline void Search::push(std::uint32_t a, std::int64_t amount) {
  FlowArc& arc = arcs_[a];
  FlowArc& sister = arcs_[arc.sister];
  arc.residual -= amount;
  sister.residual += amount;
  arc.sister_open = 1;
  sister.sister_open = arc.residual != 0;
}

// Nodes that get a depth from which they have not been scanned yet are put in line for it.
template <Side side>
inline void Search::set_depth(std::uint32_t i, std::int32_t depth) {
  Tree& tree = trees_[side];
  nodes_[i].label = side == kSource ? depth : -depth;
  if (depth == tree.limit) {
    tree.front.push_back(i);
  } else if (depth == tree.growing) {
    level_.push_back(i);
  }
}

template <Side side>
inline void Search::make_orphan(std::uint32_t i) {
  Tree& tree = trees_[side];
  const std::int32_t at = depth<side>(nodes_[i]);
  nodes_[i].parent = kOrphan;
  nodes_[i].next = tree.orphaned[at];
  tree.orphaned[at] = i;
  tree.least = std::min(tree.least, at);
  tree.most = std::max(tree.most, at);
}

// ---- augmentation ----

// What can be pushed between i and the terminal of its tree, at most `amount`; 0 where an orphan
// is in the way.
template <Side side>
std::int64_t Search::bottleneck(std::uint32_t i, std::int64_t amount) const {
  while (nodes_[i].parent < kRoot) {
    const FlowArc& up = arcs_[nodes_[i].parent];
    amount = std::min(amount, side == kSource ? arcs_[up.sister].residual : up.residual);
    i = up.head;
  }
  if (nodes_[i].parent == kOrphan) return 0;
  return std::min(amount, side == kSource ? nodes_[i].terminal : -nodes_[i].terminal);
}

template <Side side>
void Search::push_to_root(std::uint32_t i, std::int64_t amount) {
  while (nodes_[i].parent != kRoot) {
    const std::uint32_t up = nodes_[i].parent;
    const std::uint32_t used = side == kSource ? std::uint32_t{arcs_[up].sister} : up;
    push(used, amount);
    if (arcs_[used].residual == 0) make_orphan<side>(i);
    i = arcs_[up].head;
  }
  nodes_[i].terminal -= side == kSource ? amount : -amount;
  if (nodes_[i].terminal == 0) make_orphan<side>(i);
}

// ---- adoption ----

// Looks for a parent on the same level as the old one.
template <Side side>
inline bool Search::keep_depth(std::uint32_t i) {
  ++orphans;
  Node& node = nodes_[i];
  const std::int32_t above = depth<side>(node) - 1;
  if (above == 0) return false;  // a root; it would match free nodes
  const std::uint32_t end = nodes_[i + 1].first;
  for (std::uint32_t a = node.current; a < end; ++a) {
    if (!leads_to_parent<side>(arcs_[a])) continue;
    if (depth<side>(nodes_[arcs_[a].head]) != above) continue;
    node.parent = node.current = a;
    return true;
  }
  return false;
}

// Puts the best parent that i has at present among the offers. Should that one be lost before the
// offer is taken up, another is sought then; it cannot be nearer.
template <Side side>
inline void Search::seek(std::uint32_t i) {
  const std::uint32_t end = nodes_[i + 1].first;
  std::int32_t nearest = trees_[side].limit;
  std::uint32_t where = kNone;
  for (std::uint32_t a = nodes_[i].first; a < end; ++a) {
    if (!leads_to_parent<side>(arcs_[a])) continue;
    const std::int32_t at = depth<side>(nodes_[arcs_[a].head]);
    if (at <= 0 || at >= nearest) continue;
    nearest = at;
    where = a;
  }
  if (where == kNone) return;
  offers_[nearest + 1].push_back({i, where});
  least_offer_ = std::min(least_offer_, nearest + 1);
  most_offer_ = std::max(most_offer_, nearest + 1);
}

// Takes i out of its tree; its children become orphans.
template <Side side>
inline void Search::lose(std::uint32_t i) {
  ++lost;
  trees_[side].work += kLossWork;
  Node& node = nodes_[i];
  const std::uint32_t end = nodes_[i + 1].first;
  for (std::uint32_t a = node.first; a < end; ++a) {
    const Node& other = nodes_[arcs_[a].head];
    if (other.parent == arcs_[a].sister && other.label != 0) make_orphan<side>(arcs_[a].head);
  }
  node.label = 0;
  node.parent = kNone;
  node.current = node.first;
  seek<side>(i);
}

// Breadth-first search from the tree into the nodes that were lost.
template <Side side>
void Search::settle_lost() {
  const std::int32_t limit = trees_[side].limit;
  for (; least_offer_ <= most_offer_; ++least_offer_) {
    std::vector<Offer>& offers = offers_[least_offer_];
    for (std::size_t k = 0; k < offers.size(); ++k) {
      const auto [i, a] = offers[k];
      Node& node = nodes_[i];
      if (node.label != 0) continue;
      if (depth<side>(nodes_[arcs_[a].head]) != least_offer_ - 1) {
        seek<side>(i);
        continue;
      }
      node.parent = a;
      set_depth<side>(i, least_offer_);
      if (least_offer_ == limit) continue;
      const std::uint32_t end = nodes_[i + 1].first;
      for (std::uint32_t b = node.first; b < end; ++b) {
        const FlowArc& arc = arcs_[b];
        if (nodes_[arc.head].label != 0 || !leads_to_child<side>(arc)) continue;
        offers_[least_offer_ + 1].push_back({arc.head, arc.sister});
        most_offer_ = std::max(most_offer_, least_offer_ + 1);
      }
    }
    offers.clear();
  }
  least_offer_ = limit + 1;
  most_offer_ = -1;
}

template <Side side>
void Search::adopt_all() {
  Tree& tree = trees_[side];
  if (tree.least > tree.most) return;
  ++adoptions;
  least_offer_ = tree.limit + 1;
  for (; tree.least <= tree.most; ++tree.least) {
    std::uint32_t i = tree.orphaned[tree.least];
    tree.orphaned[tree.least] = kNone;
    while (i != kNone) {
      const std::uint32_t next = nodes_[i].next;
      if (!keep_depth<side>(i)) lose<side>(i);
      i = next;
    }
  }
  tree.least = tree.limit + 1;
  tree.most = -1;
  settle_lost<side>();
}

// ---- growth ----

// Takes over the free neighbours of i and pushes what it can across arcs to the other tree.
// Returns false where orphans barred the way, and i has to be scanned again.
template <Side side>
inline bool Search::scan(std::uint32_t i) {
  const std::int32_t top = trees_[side].growing;
  const std::uint32_t end = nodes_[i + 1].first;
  bool done = true;
  for (std::uint32_t a = nodes_[i].first; a < end; ++a) {
    const FlowArc& arc = arcs_[a];
    if (!leads_to_child<side>(arc)) continue;
    const std::uint32_t j = arc.head;
    const std::int32_t at = depth<side>(nodes_[j]);
    if (at > 0) continue;
    if (at == 0) {
      nodes_[j].parent = arc.sister;
      nodes_[j].current = nodes_[j].first;
      set_depth<side>(j, top + 1);
      continue;
    }
    const std::uint32_t used = side == kSource ? a : std::uint32_t{arc.sister};
    std::int64_t amount = bottleneck<side>(i, arcs_[used].residual);
    if (amount == 0) return false;
    amount = bottleneck<opposite(side)>(j, amount);
    if (amount != 0) {
      ++augmentations;
      push(used, amount);
      push_to_root<side>(i, amount);
      push_to_root<opposite(side)>(j, amount);
    }
    done = done && arcs_[used].residual == 0;
  }
  return done;
}

template <Side side>
bool Search::grow_level() {
  constexpr std::int64_t kPollInterval = 4096;
  Tree& tree = trees_[side];
  level_.clear();
  level_.swap(tree.front);
  if (level_.empty()) return false;
  tree.growing = tree.limit++;
  tree.orphaned.resize(std::size_t(tree.limit) + 1, kNone);
  offers_.resize(std::max(offers_.size(), std::size_t(tree.limit) + 1));
  tree.least = tree.limit + 1;
  for (std::size_t k = 0;; ++k) {
    if (k == level_.size() || again_.size() >= kPatience) {
      adopt_all<side>();
      adopt_all<opposite(side)>();
      level_.insert(level_.end(), again_.begin(), again_.end());
      again_.clear();
      if (k == level_.size()) break;
    }
    const std::uint32_t i = level_[k];
    if (depth<side>(nodes_[i]) != tree.growing) continue;
    ++tree.work;
    if (++scanned % kPollInterval == 0) context_.check();
    if (!scan<side>(i)) again_.push_back(i);
  }
  tree.growing = 0;
  return true;
}

void Search::run() {
  for (Tree& tree : trees_) {
    tree.orphaned.resize(2, kNone);
    tree.least = 2;
  }
  bool more = true;
  while (more) {
    const auto cost = [this](Side side) {
      const Tree& tree = trees_[side];
      return static_cast<double>(tree.work + static_cast<std::int64_t>(tree.front.size())) /
             std::max(1.0, tree.supply);
    };
    const bool source = cost(kSource) <= cost(kSink);
    more = source ? grow_level<kSource>() : grow_level<kSink>();
  }
}

class IncrementalSearch final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "ibfs";
      i.summary = "incremental breadth-first search from both terminals, level by level";
      i.licence = "GPL-3.0-or-later";
      i.reference = "Goldberg et al., ESA 2011; Goldberg et al., ESA 2015";
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    require_index_range(problem, std::uint64_t{kSisterBits});
    Search search(problem, context);
    context.built();
    search.run();
    return {search.edge_flow(problem),
            {{"augmentations", search.augmentations},
             {"nodes_scanned", search.scanned},
             {"orphans", search.orphans},
             {"lost", search.lost},
             {"adoptions", search.adoptions}},
            search.bytes()};
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_ibfs();
std::unique_ptr<CutSolver> make_ibfs() { return std::make_unique<IncrementalSearch>(); }

}  // namespace cellocut::solvers
