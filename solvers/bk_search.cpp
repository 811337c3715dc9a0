#include "solvers/bk_search.h"

#include <algorithm>
#include <limits>

#include "cellocut/base/errors.h"

namespace cellocut::solvers {

BkSearch::BkSearch(ResidualGraph& graph, const SolveContext& context)
    : storage_(std::size_t{graph.node_count()} + 1),
      nodes_(storage_.data()),
      begin_(0),
      size_(graph.node_count()),
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
    }
  }
  nodes_[count] = {0, graph.row[count], kFree, 0, kInactive, 0, 0};
}

BkSearch::BkSearch(BkSearch& whole, std::uint32_t begin, std::uint32_t end)
    : nodes_(whole.nodes_),
      begin_(begin),
      size_(end - begin),
      arcs_(whole.arcs_),
      residual_(whole.residual_),
      context_(whole.context_) {}

void BkSearch::begin_at_terminals() {
  for (std::uint32_t i = begin_; i < begin_ + size_; ++i) {
    if (nodes_[i].terminal != 0) activate(i);
  }
}

// The trees stand. What they have not seen are the arcs between the halves.
void BkSearch::take_over(const BkSearch& first, const BkSearch& second, std::uint32_t middle) {
  stamp_ = std::max(first.stamp_, second.stamp_);
  augmentations += first.augmentations + second.augmentations;
  grown += first.grown + second.grown;
  orphans += first.orphans + second.orphans;
  for (std::uint32_t i = begin_; i < begin_ + size_; ++i) {
    if (nodes_[i].parent == kFree) continue;
    for (const Arc* arc = arcs_ + nodes_[i].first; arc != arcs_ + nodes_[i + 1].first; ++arc) {
      if (outside(arc->head) || (arc->head < middle) == (i < middle)) continue;
      activate(i);
      break;
    }
  }
}

inline void BkSearch::activate(std::uint32_t i) {
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
inline std::uint32_t BkSearch::pop_active() {
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
template <BkSearch::Side side>
const Arc* BkSearch::grow(std::uint32_t i) {
  const Node& node = nodes_[i];
  const Arc* const end = arcs_ + nodes_[i + 1].first;
  for (const Arc* arc = arcs_ + node.first; arc != end; ++arc) {
    if (to_child<side>(arc->id) == 0 || outside(arc->head)) continue;
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

template <BkSearch::Side side>
std::int64_t BkSearch::bottleneck(std::uint32_t i, std::int64_t amount) const {
  while (nodes_[i].parent != kTerminal) {
    amount = std::min(amount, from_parent<side>(nodes_[i].parent_arc));
    i = nodes_[i].parent;
  }
  return std::min(amount, side == kSource ? nodes_[i].terminal : -nodes_[i].terminal);
}

template <BkSearch::Side side>
void BkSearch::push_to_root(std::uint32_t i, std::int64_t amount) {
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
void BkSearch::augment(std::uint32_t tail, std::uint32_t head, std::uint32_t arc) {
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
template <BkSearch::Side side>
std::uint32_t BkSearch::root_distance(std::uint32_t i) {
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

template <BkSearch::Side side>
void BkSearch::adopt(std::uint32_t i) {
  ++orphans;
  const Arc* const begin = arcs_ + nodes_[i].first;
  const Arc* const end = arcs_ + nodes_[i + 1].first;
  const Arc* best = nullptr;
  std::uint32_t nearest = kUnreachable;
  for (const Arc* arc = begin; arc != end; ++arc) {
    if (from_parent<side>(arc->id) == 0 || outside(arc->head)) continue;
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
    if (outside(arc->head)) continue;
    Node& other = nodes_[arc->head];
    if (other.parent == kFree || other.side() != side) continue;
    if (from_parent<side>(arc->id) != 0) activate(arc->head);
    if (other.parent == i) {
      other.parent = kOrphan;
      descendants_.push_back(arc->head);
    }
  }
}

void BkSearch::adopt_all() {
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

void BkSearch::run() {
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

}  // namespace cellocut::solvers
