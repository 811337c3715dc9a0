#include "cellocut/cut/reduction.h"

#include <algorithm>
#include <numeric>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

constexpr std::uint32_t kNone = 0xffff'ffffU;
// Nodes of more halves are left alone: joining makes large ones, and their sums cost time.
constexpr std::size_t kMostHalves = 16;

// Of a balance b of two terminals together, what the one called `part` supplies. Where they have
// the same sign the other gives first; where not, as much as can passes from one to the other.
std::int64_t share(std::int64_t b, std::int64_t own, std::int64_t part) {
  if ((own >= 0) == (part >= 0) || own == 0 || part == 0) {
    return b - std::clamp(b, std::min<std::int64_t>(own, 0), std::max<std::int64_t>(own, 0));
  }
  const bool part_is_used_up = (own + part >= 0) == (part < 0);
  return part_is_used_up ? part : b - own;
}

}  // namespace

class Reducer {
 public:
  Reducer(const CutProblem& problem, Reduction& result);
  void drop_unreachable();
  void run(const ReductionRules& rules);
  void collect();

 private:
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  std::uint32_t far_end(std::uint32_t half) {
    const CutEdge& edge = problem_.edges[half / 2];
    return find(half % 2 == 0 ? edge.to : edge.from);
  }
  void mark(bool from_source, std::vector<std::uint8_t>& marked) const;
  bool gather(std::uint32_t i);
  void merge_parallel();
  void wake(std::uint32_t i) {
    if (waiting_[i] != 0 || gone_[i] != 0) return;
    waiting_[i] = 1;
    queue_.push_back(i);
  }
  void give(std::uint32_t i, bool source);
  void join(std::uint32_t i, std::uint32_t half, std::uint32_t j);
  void visit(std::uint32_t i, const ReductionRules& rules);

  const CutProblem& problem_;
  Reduction& result_;
  std::vector<std::int64_t> terminal_;  // t
  std::vector<std::int64_t> capacity_;  // per half, away from its end
  std::vector<std::uint32_t> parent_;   // disjoint sets of nodes
  std::vector<std::uint32_t> first_;    // per node, list of halves
  std::vector<std::uint32_t> last_;
  std::vector<std::uint32_t> next_;  // per half
  std::vector<std::uint8_t> dead_;   // per edge
  std::vector<std::uint8_t> gone_;   // per node: dropped, or joined to another
  std::vector<std::uint8_t> waiting_;
  std::vector<std::uint32_t> queue_;
  std::vector<std::uint32_t> halves_;  // of the node in hand
};

Reducer::Reducer(const CutProblem& problem, Reduction& result)
    : problem_(problem),
      result_(result),
      terminal_(problem.node_count()),
      capacity_(2 * problem.edges.size()),
      parent_(problem.node_count()),
      first_(problem.node_count(), kNone),
      last_(problem.node_count(), kNone),
      next_(2 * problem.edges.size(), kNone),
      dead_(problem.edges.size(), 0),
      gone_(problem.node_count(), 0),
      waiting_(problem.node_count(), 0) {
  result.alone_.assign(problem.node_count(), 0);
  std::iota(parent_.begin(), parent_.end(), 0U);
  for (std::size_t i = 0; i < terminal_.size(); ++i) {
    terminal_[i] = problem.to_source[i] - problem.to_sink[i];
  }
  for (auto e = static_cast<std::uint32_t>(problem.edges.size()); e-- > 0;) {
    const CutEdge& edge = problem.edges[e];
    if (edge.from == edge.to || (edge.capacity | edge.reverse_capacity) == 0) {
      dead_[e] = 1;
      continue;
    }
    capacity_[2 * e] = edge.capacity;
    capacity_[2 * e + 1] = edge.reverse_capacity;
    for (const std::uint32_t half : {2 * e, 2 * e + 1}) {
      const std::uint32_t i = half % 2 == 0 ? edge.from : edge.to;
      next_[half] = first_[i];
      if (first_[i] == kNone) last_[i] = half;
      first_[i] = half;
    }
  }
}

// Marks what the source reaches, or what reaches the sink.
void Reducer::mark(bool from_source, std::vector<std::uint8_t>& marked) const {
  std::vector<std::uint32_t> stack;
  const auto visit = [&](std::uint32_t i) {
    if (marked[i] != 0) return;
    marked[i] = 1;
    stack.push_back(i);
  };
  for (std::uint32_t i = 0; i < terminal_.size(); ++i) {
    if (from_source ? terminal_[i] > 0 : terminal_[i] < 0) visit(i);
  }
  while (!stack.empty()) {
    const std::uint32_t i = stack.back();
    stack.pop_back();
    for (std::uint32_t half = first_[i]; half != kNone; half = next_[half]) {
      const CutEdge& edge = problem_.edges[half / 2];
      if (capacity_[from_source ? half : half ^ 1U] > 0) {
        visit(half % 2 == 0 ? edge.to : edge.from);
      }
    }
  }
}

void Reducer::drop_unreachable() {
  std::vector<std::uint8_t> source(terminal_.size(), 0);
  std::vector<std::uint8_t> sink(terminal_.size(), 0);
  mark(true, source);
  mark(false, sink);
  for (std::uint32_t i = 0; i < terminal_.size(); ++i) {
    if ((source[i] & sink[i]) != 0 || first_[i] == kNone) continue;
    gone_[i] = 1;
    result_.alone_[i] = source[i];
    ++result_.counts_.unreachable;
    for (std::uint32_t half = first_[i]; half != kNone; half = next_[half]) dead_[half / 2] = 1;
  }
}

// The living halves of i, also as its new list. False where they are too many; dead ones that were
// met leave the list all the same, so that nobody meets them again.
bool Reducer::gather(std::uint32_t i) {
  halves_.clear();
  std::uint32_t alive = kNone;  // the last one
  for (std::uint32_t half = first_[i]; half != kNone; half = next_[half]) {
    if (dead_[half / 2] != 0) continue;
    if (halves_.size() == kMostHalves) {
      next_[alive] = half;
      return false;
    }
    if (alive == kNone) {
      first_[i] = half;
    } else {
      next_[alive] = half;
    }
    alive = half;
    halves_.push_back(half);
  }
  merge_parallel();
  first_[i] = last_[i] = kNone;
  for (const std::uint32_t half : halves_) {
    next_[half] = kNone;
    if (first_[i] == kNone) {
      first_[i] = half;
    } else {
      next_[last_[i]] = half;
    }
    last_[i] = half;
  }
  return true;
}

void Reducer::merge_parallel() {
  for (std::size_t k = 0; k < halves_.size(); ++k) {
    const std::uint32_t stays = halves_[k];
    for (std::size_t l = k + 1; l < halves_.size();) {
      const std::uint32_t goes = halves_[l];
      if (far_end(goes) != far_end(stays)) {
        ++l;
        continue;
      }
      result_.moves_.push_back(
          {Reduction::Step::merge, stays, goes, 0, capacity_[stays], capacity_[stays ^ 1U], 0});
      capacity_[stays] += capacity_[goes];
      capacity_[stays ^ 1U] += capacity_[goes ^ 1U];
      dead_[goes / 2] = 1;
      halves_.erase(halves_.begin() + static_cast<std::ptrdiff_t>(l));
    }
  }
}

void Reducer::give(std::uint32_t i, bool source) {
  for (const std::uint32_t half : halves_) {
    const std::uint32_t j = far_end(half);
    const std::int64_t part = source ? capacity_[half] : -capacity_[half ^ 1U];
    if (part != 0) {
      result_.moves_.push_back({Reduction::Step::give, half, i, j, part, terminal_[j], 0});
      terminal_[j] += part;
    }
    dead_[half / 2] = 1;
    wake(j);
  }
  gone_[i] = 1;
  result_.alone_[i] = source ? 1 : 0;
  ++result_.counts_.dominated;
}

void Reducer::join(std::uint32_t i, std::uint32_t half, std::uint32_t j) {
  for (const std::uint32_t other : halves_) {
    if (other == half) continue;
    result_.others_.push_back(other);
    wake(far_end(other));
  }
  result_.moves_.push_back({Reduction::Step::join, half, i, j, terminal_[i], terminal_[j],
                            static_cast<std::uint32_t>(result_.others_.size())});
  dead_[half / 2] = 1;
  terminal_[j] += terminal_[i];
  parent_[i] = j;
  if (last_[j] == kNone) {
    first_[j] = first_[i];
  } else {
    next_[last_[j]] = first_[i];
  }
  last_[j] = last_[i];
  gone_[i] = 1;
  wake(j);
  ++result_.counts_.heavy_edges;
}

void Reducer::visit(std::uint32_t i, const ReductionRules& rules) {
  if (gone_[i] != 0 || !gather(i) || halves_.empty()) return;
  std::int64_t out = 0;
  std::int64_t in = 0;
  for (const std::uint32_t half : halves_) {
    out += capacity_[half];
    in += capacity_[half ^ 1U];
  }
  const std::int64_t t = terminal_[i];
  if (rules.dominated && t >= 0 && t >= out) return give(i, true);
  if (rules.dominated && t <= 0 && -t >= in) return give(i, false);
  if (!rules.heavy_edges) return;
  for (const std::uint32_t half : halves_) {
    const std::int64_t there = capacity_[half];
    const std::int64_t back = capacity_[half ^ 1U];
    if (there >= in - back + std::max<std::int64_t>(t, 0) &&
        back >= out - there + std::max<std::int64_t>(-t, 0)) {
      return join(i, half, far_end(half));
    }
  }
}

void Reducer::run(const ReductionRules& rules) {
  if (!rules.dominated && !rules.heavy_edges) return;
  for (std::uint32_t i = 0; i < terminal_.size(); ++i) {
    visit(i, rules);
    while (!queue_.empty()) {
      const std::uint32_t woken = queue_.back();
      queue_.pop_back();
      waiting_[woken] = 0;
      visit(woken, rules);
    }
  }
}

// What is left, renumbered in the order of the whole.
void Reducer::collect() {
  std::vector<std::uint8_t> used(terminal_.size(), 0);
  for (std::uint32_t e = 0; e < dead_.size(); ++e) {
    if (dead_[e] == 0) used[far_end(2 * e)] = used[far_end(2 * e + 1)] = 1;
  }
  CutProblem& left = result_.left_;
  std::vector<std::uint32_t> number(terminal_.size(), kNone);
  for (std::uint32_t i = 0; i < terminal_.size(); ++i) {
    if (used[i] == 0) {
      if (gone_[i] == 0) {
        result_.alone_[i] = terminal_[i] > 0 ? 1 : 0;
        ++result_.counts_.isolated;
      }
      continue;
    }
    number[i] = static_cast<std::uint32_t>(left.to_source.size());
    left.to_source.push_back(std::max<std::int64_t>(terminal_[i], 0));
    left.to_sink.push_back(std::max<std::int64_t>(-terminal_[i], 0));
    result_.node_left_.push_back(i);
  }
  result_.edge_left_.assign(dead_.size(), kNone);
  for (std::uint32_t e = 0; e < dead_.size(); ++e) {
    if (dead_[e] != 0) continue;
    result_.edge_left_[e] = static_cast<std::uint32_t>(left.edges.size());
    left.edges.push_back({number[far_end(2 * e + 1)], number[far_end(2 * e)], capacity_[2 * e],
                          capacity_[2 * e + 1]});
  }
}

Reduction::Reduction(const CutProblem& problem, const ReductionRules& rules) {
  if (problem.edges.size() >= kNone / 2) {
    throw LimitError("cut problem: too many edges to be reduced");
  }
  Reducer reducer(problem, *this);
  if (rules.unreachable) reducer.drop_unreachable();
  reducer.run(rules);
  reducer.collect();
}

std::vector<std::int64_t> Reduction::lift(const std::vector<std::int64_t>& edge_flow) const {
  std::vector<std::int64_t> flow(edge_left_.size(), 0);
  std::vector<std::int64_t> net(alone_.size(), 0);  // out of a node along its edges
  for (std::size_t e = 0; e < edge_left_.size(); ++e) {
    if (edge_left_[e] == kNone) continue;
    flow[e] = edge_flow[edge_left_[e]];
    const CutEdge& edge = left_.edges[edge_left_[e]];
    net[node_left_[edge.from]] += flow[e];
    net[node_left_[edge.to]] -= flow[e];
  }
  const auto out_along = [&](std::uint32_t half) {
    return half % 2 == 0 ? flow[half / 2] : -flow[half / 2];
  };
  const auto set_out = [&](std::uint32_t half, std::int64_t amount) {
    flow[half / 2] = half % 2 == 0 ? amount : -amount;
  };
  std::size_t end = others_.size();
  for (auto move = moves_.rbegin(); move != moves_.rend(); ++move) {
    if (move->step == Step::merge) {
      const std::int64_t together = out_along(move->half);
      const std::int64_t first = std::clamp(together, -move->own, move->part);
      set_out(move->half, first);
      set_out(move->node, together - first);
      continue;
    }
    const std::int64_t part = share(net[move->into], move->own, move->part);
    net[move->into] -= part;
    net[move->node] += part;
    if (move->step == Step::give) {
      set_out(move->half, part);
      continue;
    }
    const auto before =
        std::find_if(move + 1, moves_.rend(), [](const Move& m) { return m.step == Step::join; });
    const std::size_t begin = before == moves_.rend() ? 0 : before->others;
    std::int64_t elsewhere = 0;
    for (std::size_t k = begin; k < end; ++k) elsewhere += out_along(others_[k]);
    end = begin;
    set_out(move->half, part - elsewhere);
  }
  return flow;
}

std::vector<float> Reduction::lift_values(const std::vector<float>& values) const {
  std::vector<float> lifted(alone_.begin(), alone_.end());
  for (std::size_t i = 0; i < node_left_.size(); ++i) lifted[node_left_[i]] = values[i];
  for (auto move = moves_.rbegin(); move != moves_.rend(); ++move) {
    if (move->step == Step::join) lifted[move->node] = lifted[move->into];
  }
  return lifted;
}

}  // namespace cellocut
