// ibfs: incremental breadth-first search from both terminals, level by level, with excesses.
//
// Definition. All terminal arcs are saturated at the start: a node has an excess, or a deficit, the
// negative one. Two disjoint forests of residual arcs grow, S from nodes with excess and T from
// nodes with deficit, and both are kept breadth-first. A node has a label: its depth in S, minus
// its depth in T, or 0 if it is free; the roots that there are at the start have depth 1.
//   growth        scans all nodes of the deepest level of one forest; they take over free
//                 neighbours;
//   augmentation  across an arc from S to T, as much is pushed as the path from the root in S and
//                 the arc let through. In T it stays where it arrives, as excess;
//   settling      at the end of the level, what has arrived moves towards the roots of T level by
//                 level, the deepest first, so that every tree arc carries all that comes along it
//                 at once. Nodes whose tree arc is saturated, in S or T, and roots that have no
//                 excess (no deficit) left become orphans; what reaches an orphan of T waits there;
//   adoption      an orphan looks for another parent on the level of the old one; where there is
//                 none it is lost, and its children become orphans. When no orphan is left, a
//                 breadth-first search from the tree into the lost nodes gives each its new depth.
//                 Those that would be deeper than the limit become free, or, with what has arrived
//                 at them, roots of S at the deepest level of S. Adopted nodes with something left
//                 pass it on, and so forth until nothing moves. S adopts after each level, T when
//                 enough work has gone by: labels stay lower bounds of the distances meanwhile.
// When a forest has no node on its deepest level, all its nodes have been scanned: no residual arc
// leaves it, and once T has no orphans either the pseudoflow is maximal. Excess that is left goes
// back to the source, see packed_graph.h; that is part of the solve time.
//
// Invariants, between settlings. (1) A node that is no orphan is one deeper than its parent, and
// the arc between them has residual capacity in the direction of the flow. (2) A residual arc of S
// leads at most one level down; T likewise towards its roots. (3) Residual arcs out of S (into T)
// begin (end) at nodes that have yet to be scanned: those at the limit, and in the forest that
// grows those still in line. That is why a node without a parent in T may become a root of S at the
// limit: no node that has been scanned has a residual arc to it. (4) Depths of a node never
// decrease while it stays in a forest. (5) Only roots of S have excess, only roots of T a deficit;
// other nodes of T may have something to pass on.
//
// Choices of ours. The paper (2015) saturates the joining arc and leaves a deficit in S as well as
// an excess in T. On cuts of tetrahedra, where half of all nodes are sources of little each, that
// displaced most of the sources; drawing no more than S can give was faster. So was settling once a
// level instead of after each augmentation; adoption in T that waits for several levels helps most
// where distances grow everywhere. And the forest to grow is the one that
// has cost less work per unit of what its terminal had to give: roots with little supply run dry,
// and take whole subtrees with them.
//
// Complexity. O(n^2 m), independent of capacities, is proved in the papers for one adoption after
// each augmentation; for settling once a level no bound is claimed. Every adoption scans the lost
// nodes four times.
//
// Layout. 32 bytes per node, and 16 per arc (packed_graph.h): scans and adoption read rows and the
// nodes they lead to, nothing else. Orphans and nodes with something to pass on are intrusive lists
// by depth; no node is in two of them, since all is passed on before orphans are looked at.
//
// References.
//   A. V. Goldberg, S. Hed, H. Kaplan, R. E. Tarjan, R. F. Werneck: Maximum flows by incremental
//   breadth-first search. ESA 2011.
//   A. V. Goldberg, S. Hed, H. Kaplan, P. Kohli, R. E. Tarjan, R. F. Werneck: Faster and more
//   dynamic maximum flow by incremental breadth-first search. ESA 2015 (excesses, adoption in
//   passes).
//
// Licence: GPL-3.0-or-later, this project's own code. Capabilities: exact for every valid problem
// with fewer than 2^30 edges, returns a flow, one thread, can be cancelled.
#include <algorithm>
#include <cmath>
#include <memory>

#include "solvers/packed_graph.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

// Values of Node::parent that are not arcs.
constexpr std::uint32_t kRoot = 0xffff'fffdU;
constexpr std::uint32_t kOrphan = 0xffff'fffeU;
constexpr std::uint32_t kNone = 0xffff'ffffU;  // of a free node; also the end of a list

// Orphans of T wait until one part in so many of all nodes has been worked on.
constexpr std::int64_t kEagerness = 4;

// What the loss of a node costs, in scans of a node.
constexpr std::int64_t kLossWork = 4;

enum Side : std::uint8_t { kSource = 0, kSink = 1 };

constexpr Side opposite(Side side) { return side == kSource ? kSink : kSource; }

struct Node {
  std::int64_t excess;   // negative: deficit
  std::uint32_t first;   // of its row of arcs; the next node's `first` ends it
  std::uint32_t parent;  // the arc node -> parent, or kRoot, kOrphan, kNone
  std::uint32_t offer;   // of a lost node, the arc to the nearest parent known, or kNone
  std::int32_t label;    // depth in the source tree, minus the depth in the sink tree, 0 if free
  std::uint32_t next;    // in the list of orphans, or of nodes that pass on, of the same depth
};
static_assert(sizeof(Node) == 32);

class Search {
 public:
  Search(PackedGraph& graph, const SolveContext& context);
  void run();
  [[nodiscard]] std::vector<std::int64_t> excess() const;

  std::int64_t joins = 0;
  std::int64_t scanned = 0;
  std::int64_t orphans = 0;
  std::int64_t lost = 0;
  std::int64_t displaced = 0;
  std::int64_t adoptions = 0;
  [[nodiscard]] std::int64_t bytes() const {
    return static_cast<std::int64_t>(nodes_.size() * sizeof(Node));
  }

 private:
  // One side of the search. All nodes of a tree have depth <= limit; those of depth < limit (of
  // depth < limit - 1 in the tree that grows) have been scanned.
  struct Tree {
    std::int32_t limit = 1;
    std::int32_t growing = 0;             // the depth whose nodes are being scanned, or 0
    std::vector<std::uint32_t> front;     // all nodes at the limit, and some that were
    std::vector<std::uint32_t> orphaned;  // per depth, first of the list of orphans
    std::int32_t least_orphan = 2;        // no orphan is less deep,
    std::int32_t most_orphan = 0;         // or deeper
    double supply = 0;                    // sum of the capacities of the terminal's arcs
    std::int64_t work = 0;                // nodes scanned and lost so far
  };

  // Depth in the tree of that side, not positive outside.
  template <Side side>
  static std::int32_t depth(const Node& node) {
    return side == kSource ? node.label : -node.label;
  }
  // Residual capacity in the direction of the flow, from the near end of the arc to a child, or
  // from a parent to the near end.
  template <Side side>
  static bool leads_to_child(const PackedArc& arc) {
    return side == kSource ? arc.residual != 0 : arc.sister_open != 0;
  }
  template <Side side>
  static bool leads_to_parent(const PackedArc& arc) {
    return leads_to_child<opposite(side)>(arc);
  }

  template <Side side>
  bool grow_level();
  template <Side side>
  bool scan(std::uint32_t i);
  [[nodiscard]] std::int64_t available(std::uint32_t i, std::int64_t amount) const;
  void draw(std::uint32_t i, std::int64_t amount);
  void receive(std::uint32_t i, std::int64_t amount);
  void pass_on();
  void settle(bool adopt);
  [[nodiscard]] std::int64_t work() const { return trees_[kSource].work + trees_[kSink].work; }
  template <Side side>
  void set_depth(std::uint32_t i, std::int32_t depth);
  template <Side side>
  void make_orphan(std::uint32_t i, std::int32_t at);
  void line_up(std::uint32_t i);
  template <Side side>
  void adopt_all();
  template <Side side>
  bool keep_depth(std::uint32_t i);
  template <Side side>
  void lose(std::uint32_t i);
  template <Side side>
  std::uint32_t nearest_parent(std::uint32_t i) const;
  template <Side side>
  void settle_lost();

  std::vector<Node> nodes_;  // and one behind the last, for its `first`
  PackedGraph& graph_;
  PackedArc* arcs_;
  const SolveContext& context_;
  Tree trees_[2];
  std::vector<std::uint32_t> level_;    // nodes of the level that is being grown
  std::vector<std::uint32_t> again_;    // of these, to be scanned again
  std::vector<std::uint32_t> passing_;  // per depth in T, first of the list of nodes that pass on
  std::int64_t adopted_at_ = 0;         // work() at the last adoption in T
  std::int32_t deepest_passing_ = 0;    // none is deeper
  std::vector<std::uint32_t> lost_;
  std::vector<std::uint32_t> found_;  // lost nodes that have a place on the level in hand,
  std::vector<std::uint32_t> below_;  // and on the next
};

Search::Search(PackedGraph& graph, const SolveContext& context)
    : nodes_(std::size_t{graph.node_count()} + 1),
      graph_(graph),
      arcs_(graph.arcs.data()),
      context_(context) {
  const std::uint32_t count = graph.node_count();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::int64_t terminal = graph.terminal[i];
    nodes_[i] = {terminal, graph.row[i], kNone, kNone, 0, kNone};
    if (terminal == 0) continue;
    nodes_[i].parent = kRoot;
    nodes_[i].label = terminal > 0 ? 1 : -1;
    Tree& tree = trees_[terminal > 0 ? kSource : kSink];
    tree.front.push_back(i);
    tree.supply += std::abs(static_cast<double>(terminal));
  }
  nodes_[count] = {0, graph.row[count], kNone, kNone, 0, kNone};
}

std::vector<std::int64_t> Search::excess() const {
  std::vector<std::int64_t> result(nodes_.size() - 1);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = nodes_[i].excess;
  return result;
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
inline void Search::make_orphan(std::uint32_t i, std::int32_t at) {
  Tree& tree = trees_[side];
  nodes_[i].parent = kOrphan;
  nodes_[i].next = tree.orphaned[at];
  tree.orphaned[at] = i;
  tree.least_orphan = std::min(tree.least_orphan, at);
  tree.most_orphan = std::max(tree.most_orphan, at);
}

// Puts a node of T in line to pass on what has arrived at it.
inline void Search::line_up(std::uint32_t i) {
  const std::int32_t at = depth<kSink>(nodes_[i]);
  nodes_[i].next = passing_[at];
  passing_[at] = i;
  deepest_passing_ = std::max(deepest_passing_, at);
}

// ---- augmentation ----

// What a node of S can get from its root, at most `amount`; 0 where an orphan is in the way.
std::int64_t Search::available(std::uint32_t i, std::int64_t amount) const {
  while (nodes_[i].parent < kRoot) {
    const PackedArc& up = arcs_[nodes_[i].parent];
    amount = std::min(amount, arcs_[up.sister].residual);
    i = up.head;
  }
  return nodes_[i].parent == kOrphan ? 0 : std::min(amount, nodes_[i].excess);
}

// Precondition: `amount` is available.
void Search::draw(std::uint32_t i, std::int64_t amount) {
  while (nodes_[i].parent != kRoot) {
    const PackedArc& up = arcs_[nodes_[i].parent];
    const std::uint32_t used = up.sister;
    const std::uint32_t above = up.head;
    graph_.push(used, amount);
    if (arcs_[used].residual == 0) make_orphan<kSource>(i, depth<kSource>(nodes_[i]));
    i = above;
  }
  nodes_[i].excess -= amount;
  if (nodes_[i].excess == 0) make_orphan<kSource>(i, depth<kSource>(nodes_[i]));
}

// Something arrives at a node of T.
inline void Search::receive(std::uint32_t i, std::int64_t amount) {
  Node& node = nodes_[i];
  const std::int64_t before = node.excess;
  node.excess += amount;
  if (node.parent == kRoot) {
    if (node.excess >= 0) make_orphan<kSink>(i, depth<kSink>(node));
  } else if (node.parent != kOrphan && before == 0) {
    line_up(i);
  }
}

// Everything moves towards the roots of T as far as it can.
void Search::pass_on() {
  for (; deepest_passing_ > 0; --deepest_passing_) {
    std::uint32_t i = passing_[deepest_passing_];
    passing_[deepest_passing_] = kNone;
    while (i != kNone) {
      Node& node = nodes_[i];
      const std::uint32_t next = node.next;
      const std::uint32_t up = node.parent;
      const std::int64_t amount = std::min(node.excess, arcs_[up].residual);
      graph_.push(up, amount);
      node.excess -= amount;
      if (arcs_[up].residual == 0) make_orphan<kSink>(i, deepest_passing_);
      receive(arcs_[up].head, amount);
      i = next;
    }
  }
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
  for (std::uint32_t a = node.first; a < end; ++a) {
    if (!leads_to_parent<side>(arcs_[a])) continue;
    if (depth<side>(nodes_[arcs_[a].head]) != above) continue;
    node.parent = a;
    if (side == kSink && node.excess != 0) line_up(i);
    return true;
  }
  return false;
}

// The arc to the least deep neighbour that could be the parent of i, or kNone where i would be
// deeper than the limit.
template <Side side>
inline std::uint32_t Search::nearest_parent(std::uint32_t i) const {
  std::int32_t nearest = trees_[side].limit;
  std::uint32_t where = kNone;
  const std::uint32_t end = nodes_[i + 1].first;
  for (std::uint32_t a = nodes_[i].first; a < end; ++a) {
    const std::int32_t at = depth<side>(nodes_[arcs_[a].head]);
    if (at <= 0 || at >= nearest || !leads_to_parent<side>(arcs_[a])) continue;
    nearest = at;
    where = a;
  }
  return where;
}

// Takes i out of its tree; its children become orphans.
template <Side side>
inline void Search::lose(std::uint32_t i) {
  ++lost;
  Node& node = nodes_[i];
  std::int32_t nearest = trees_[side].limit;
  node.offer = kNone;
  const std::uint32_t end = nodes_[i + 1].first;
  for (std::uint32_t a = node.first; a < end; ++a) {
    const PackedArc& arc = arcs_[a];
    const Node& other = nodes_[arc.head];
    const std::int32_t at = depth<side>(other);
    if (at <= 0) continue;
    if (other.parent == arc.sister) make_orphan<side>(arc.head, at);
    if (at < nearest && leads_to_parent<side>(arc)) {
      nearest = at;
      node.offer = a;
    }
  }
  node.label = 0;
  node.parent = kNone;
  lost_.push_back(i);
}

template <Side side>
void Search::settle_lost() {
  Tree& tree = trees_[side];
  tree.work += kLossWork * static_cast<std::int64_t>(lost_.size());
  std::int32_t least = tree.limit + 1;
  std::int32_t most = 0;
  for (const std::uint32_t i : lost_) {
    Node& node = nodes_[i];
    if (node.offer == kNone) continue;
    if (depth<side>(nodes_[arcs_[node.offer].head]) == 0) {
      node.offer = nearest_parent<side>(i);
      if (node.offer == kNone) continue;
    }
    const std::int32_t at = depth<side>(nodes_[arcs_[node.offer].head]) + 1;
    node.next = tree.orphaned[at];
    tree.orphaned[at] = i;
    least = std::min(least, at);
    most = std::max(most, at);
  }
  below_.clear();
  for (; least <= most || !below_.empty(); ++least) {
    found_.swap(below_);
    below_.clear();
    for (std::uint32_t i = tree.orphaned[least]; i != kNone; i = nodes_[i].next) {
      Node& node = nodes_[i];
      if (node.label != 0) continue;
      node.parent = node.offer;
      set_depth<side>(i, least);
      found_.push_back(i);
    }
    tree.orphaned[least] = kNone;
    if (least == tree.limit) break;
    for (const std::uint32_t i : found_) {
      const std::uint32_t end = nodes_[i + 1].first;
      for (std::uint32_t a = nodes_[i].first; a < end; ++a) {
        const PackedArc& arc = arcs_[a];
        Node& other = nodes_[arc.head];
        if (other.label != 0 || !leads_to_child<side>(arc)) continue;
        other.parent = arc.sister;
        set_depth<side>(arc.head, least + 1);
        below_.push_back(arc.head);
      }
    }
  }
  for (const std::uint32_t i : lost_) {
    if (side == kSource || nodes_[i].excess == 0) continue;
    if (nodes_[i].label != 0) {
      line_up(i);
    } else {
      ++displaced;
      nodes_[i].parent = kRoot;
      set_depth<kSource>(i, trees_[kSource].limit);
    }
  }
  lost_.clear();
}

template <Side side>
void Search::adopt_all() {
  Tree& tree = trees_[side];
  if (tree.most_orphan == 0) return;
  ++adoptions;
  for (; tree.least_orphan <= tree.most_orphan; ++tree.least_orphan) {
    std::uint32_t& list = tree.orphaned[tree.least_orphan];
    while (list != kNone) {
      const std::uint32_t i = list;
      list = nodes_[i].next;
      if (!keep_depth<side>(i)) lose<side>(i);
    }
  }
  tree.least_orphan = tree.limit + 1;
  tree.most_orphan = 0;
  settle_lost<side>();
}

// Orphans of T, and what waits at them, are left alone unless `adopt`.
void Search::settle(bool adopt) {
  pass_on();
  while (adopt && trees_[kSink].most_orphan > 0) {
    adopt_all<kSink>();
    adopted_at_ = work();
    pass_on();
  }
  adopt_all<kSource>();
}

// ---- growth ----

// Takes over the free neighbours of i and pushes what it can across arcs to the other forest.
// Returns false where i has to be scanned again: some arc to the other forest is still open.
template <Side side>
inline bool Search::scan(std::uint32_t i) {
  const std::int32_t top = trees_[side].growing;
  const std::uint32_t end = nodes_[i + 1].first;
  bool done = true;
  for (std::uint32_t a = nodes_[i].first; a < end; ++a) {
    const PackedArc& arc = arcs_[a];
    if (!leads_to_child<side>(arc)) continue;
    const std::uint32_t j = arc.head;
    const std::int32_t at = depth<side>(nodes_[j]);
    if (at > 0) continue;
    if (at == 0) {
      nodes_[j].parent = arc.sister;
      set_depth<side>(j, top + 1);
      continue;
    }
    const std::uint32_t used = side == kSource ? a : std::uint32_t{arc.sister};
    const std::uint32_t giver = side == kSource ? i : j;
    const std::int64_t amount = available(giver, arcs_[used].residual);
    if (amount != 0) {
      ++joins;
      graph_.push(used, amount);
      draw(giver, amount);
      receive(side == kSource ? j : i, amount);
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
  if (side == kSink) passing_.resize(tree.orphaned.size(), kNone);
  if (tree.most_orphan == 0) tree.least_orphan = tree.limit + 1;
  for (std::size_t k = 0;; ++k) {
    if (k == level_.size()) {
      settle(work() > adopted_at_ + static_cast<std::int64_t>(nodes_.size()) / kEagerness);
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
  for (Tree& tree : trees_) tree.orphaned.resize(2, kNone);
  passing_.resize(2, kNone);
  bool more = true;
  while (more) {
    const auto cost = [this](Side side) {
      const Tree& tree = trees_[side];
      return static_cast<double>(tree.work + static_cast<std::int64_t>(tree.front.size())) /
             std::max(1.0, tree.supply);
    };
    const bool source = cost(kSource) <= cost(kSink);
    more = source ? grow_level<kSource>() : grow_level<kSink>();
    if (!more && trees_[kSink].most_orphan > 0) {
      settle(true);
      more = true;
    }
  }
}

class IncrementalSearch final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "ibfs";
      i.summary = "incremental breadth-first search from both terminals, with excesses";
      i.licence = "GPL-3.0-or-later";
      i.reference = "Goldberg et al., ESA 2011; Goldberg et al., ESA 2015";
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    PackedGraph graph(problem);
    Search search(graph, context);
    context.built();
    search.run();
    return {returned_flow(graph, problem, search.excess(), context),
            {{"joins", search.joins},
             {"nodes_scanned", search.scanned},
             {"orphans", search.orphans},
             {"lost", search.lost},
             {"displaced", search.displaced},
             {"adoptions", search.adoptions}},
            graph.bytes() + search.bytes()};
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_ibfs();
std::unique_ptr<CutSolver> make_ibfs() { return std::make_unique<IncrementalSearch>(); }

}  // namespace cellocut::solvers
