// The search of bk (definition, invariants and layout at the head of bk.cpp), over all nodes or
// over a range of them.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_solver.h"
#include "solvers/residual_graph.h"

namespace cellocut::solvers {

class BkSearch {
 public:
  // Over all nodes of the graph.
  BkSearch(ResidualGraph& graph, const SolveContext& context);
  // Over the nodes [begin, end) of another search, as if the arcs to other nodes were not there.
  // Searches over disjoint ranges may run at the same time.
  BkSearch(BkSearch& whole, std::uint32_t begin, std::uint32_t end);

  // The searches of two halves of the range, [begin, middle) and [middle, end), have run.
  void take_over(const BkSearch& first, const BkSearch& second, std::uint32_t middle);
  // Puts the nodes that have a terminal in line.
  void begin_at_terminals();
  void run();

  std::int64_t augmentations = 0;
  std::int64_t grown = 0;
  std::int64_t orphans = 0;
  [[nodiscard]] std::int64_t bytes() const {
    return static_cast<std::int64_t>(storage_.size() * sizeof(Node));
  }

 private:
  // Values of Node::parent that are not nodes. A node is in a tree iff its parent is not kFree.
  static constexpr std::uint32_t kTerminal = 0xffff'fffdU;
  static constexpr std::uint32_t kOrphan = 0xffff'fffeU;
  static constexpr std::uint32_t kFree = 0xffff'ffffU;
  // Value of Node::next of a node that is not active.
  static constexpr std::uint32_t kInactive = 0xffff'ffffU;

  static constexpr std::uint32_t kUnreachable = 0xffff'ffffU;
  static constexpr std::uint32_t kDepthStep = 2;  // depth is counted in the bits above the side

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

  [[nodiscard]] bool outside(std::uint32_t i) const { return i - begin_ >= size_; }

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

  std::vector<Node> storage_;  // of the search over the whole graph
  Node* nodes_;                // and one behind the last, for its `first`
  std::uint32_t begin_;
  std::uint32_t size_;
  const Arc* arcs_;
  std::int64_t* residual_;
  const SolveContext& context_;
  std::uint32_t active_first_ = kInactive;
  std::uint32_t active_last_ = kInactive;
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> made_orphan_;  // by the last augmentation, adopted last in, first out
  std::vector<std::uint32_t> descendants_;  // orphans below the one in hand, first in, first out
};

}  // namespace cellocut::solvers
