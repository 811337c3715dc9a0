#include "solvers/lp/rounding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace cellocut::solvers::lp {

namespace {

constexpr std::uint32_t kNone = 0xffff'ffffU;

// Nodes with 0 < x < 1, by falling x and rising number. Non-negative floats sort as their bits.
std::vector<std::uint32_t> sort_fractional(const std::vector<float>& relaxed) {
  struct Entry {
    std::uint32_t key;
    std::uint32_t node;
  };
  std::vector<Entry> entries;
  for (std::uint32_t i = 0; i < relaxed.size(); ++i) {
    if (relaxed[i] > 0 && relaxed[i] < 1) {
      entries.push_back({~std::bit_cast<std::uint32_t>(relaxed[i]), i});
    }
  }
  std::vector<Entry> other(entries.size());
  constexpr std::uint32_t kBits = 11;
  constexpr std::uint32_t kBuckets = 1U << kBits;
  for (std::uint32_t shift = 0; shift < 32; shift += kBits) {
    std::array<std::uint32_t, kBuckets + 1> next{};
    const auto bucket = [&](const Entry& entry) { return (entry.key >> shift) % kBuckets; };
    for (const Entry& entry : entries) ++next[bucket(entry) + 1];
    for (std::uint32_t b = 0; b < kBuckets; ++b) next[b + 1] += next[b];
    for (const Entry& entry : entries) other[next[bucket(entry)]++] = entry;
    entries.swap(other);
  }
  std::vector<std::uint32_t> nodes;
  nodes.reserve(entries.size());
  for (const Entry& entry : entries) nodes.push_back(entry.node);
  return nodes;
}

// One side of the labelling. kSign = 1: the source side, where a node in need has a negative
// surplus. kSign = -1: the sink side, the same with all signs and arcs turned round.
template <int kSign>
class SideRepair {
 public:
  SideRepair(const ResidualGraph& graph, IntegerFlow& flow, const CutLabels& labels,
             RepairCounts& counts)
      : graph_(graph),
        residual_(flow.residual),
        surplus_(flow.surplus),
        labels_(labels),
        counts_(counts),
        level_(graph.node_count(), kNone) {
    for (std::uint32_t i = 0; i < graph.node_count(); ++i) {
      if (on_side(i) && spare(i) < 0) needy_.push_back(i);
    }
  }

  // Returns what is missing in the end.
  std::int64_t run(std::int64_t effort) {
    // How much spare the search looks for, in multiples of the need: little at first, so that it
    // stays near by.
    std::int64_t reach = 2;
    std::int64_t need = total_need();
    visits_ = 0;
    while (need > 0 && visits_ < effort) {
      const bool everywhere = !search(need, reach);
      push();
      const std::int64_t left = total_need();
      if (left == need && everywhere) break;  // nothing can be moved to what is in need
      need = left;
      reach = std::min<std::int64_t>(2 * reach, std::int64_t{1} << 20);
      ++counts_.sweeps;
    }
    return need;
  }

 private:
  [[nodiscard]] bool on_side(std::uint32_t i) const { return (labels_[i] == 1) == (kSign == 1); }
  [[nodiscard]] std::int64_t spare(std::uint32_t i) const { return kSign * surplus_[i]; }
  // Residual capacity for moving spare along arc `id`, or along its sister.
  [[nodiscard]] std::uint32_t along(std::uint32_t id) const { return kSign == 1 ? id : id ^ 1U; }

  std::int64_t total_need() {
    std::int64_t need = 0;
    std::size_t kept = 0;
    for (const std::uint32_t i : needy_) {
      if (spare(i) >= 0) continue;
      need -= spare(i);
      needy_[kept++] = i;
    }
    needy_.resize(kept);
    return need;
  }

  // Levels are distances to the nearest node in need. Returns whether enough was found before the
  // side was exhausted.
  bool search(std::int64_t need, std::int64_t reach) {
    for (const std::uint32_t i : queue_) level_[i] = kNone;
    queue_ = needy_;
    for (const std::uint32_t i : queue_) level_[i] = 0;
    std::int64_t found = 0;
    std::uint32_t last_level = kNone;
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      const std::uint32_t i = queue_[k];
      if (level_[i] >= last_level) return true;
      visits_ += 2 * (std::int64_t{graph_.row[i + 1]} - graph_.row[i]) + 1;
      for (std::uint32_t a = graph_.row[i]; a < graph_.row[i + 1]; ++a) {
        const Arc arc = graph_.arcs[a];
        if (level_[arc.head] != kNone || !on_side(arc.head)) continue;
        if (residual_[along(arc.id ^ 1U)] == 0) continue;
        level_[arc.head] = level_[i] + 1;
        queue_.push_back(arc.head);
        found += std::max<std::int64_t>(spare(arc.head), 0);
        // Enough: finish this level.
        if (last_level == kNone && found / reach >= need) last_level = level_[i] + 1;
      }
    }
    return false;
  }

  // From the farthest level on, every node hands its spare to the level below.
  void push() {
    for (std::size_t k = queue_.size(); k-- > 0;) {
      const std::uint32_t i = queue_[k];
      if (level_[i] == 0) break;
      if (spare(i) <= 0) continue;
      for (std::uint32_t a = graph_.row[i]; a < graph_.row[i + 1]; ++a) {
        const Arc arc = graph_.arcs[a];
        if (level_[arc.head] != level_[i] - 1) continue;
        std::int64_t& forwards = residual_[along(arc.id)];
        const std::int64_t amount = std::min(spare(i), forwards);
        if (amount == 0) continue;
        forwards -= amount;
        residual_[along(arc.id) ^ 1U] += amount;
        surplus_[i] -= kSign * amount;
        surplus_[arc.head] += kSign * amount;
        ++counts_.pushes;
        if (spare(i) == 0) break;
      }
    }
  }

  const ResidualGraph& graph_;
  std::vector<std::int64_t>& residual_;
  std::vector<std::int64_t>& surplus_;
  const CutLabels& labels_;
  RepairCounts& counts_;
  std::int64_t visits_ = 0;
  std::vector<std::uint32_t> level_;
  std::vector<std::uint32_t> needy_;
  std::vector<std::uint32_t> queue_;
};

void saturate_cut(const ResidualGraph& graph, IntegerFlow& flow, const CutLabels& labels) {
  for (std::uint32_t i = 0; i < graph.node_count(); ++i) {
    if (labels[i] == 0) continue;
    for (std::uint32_t a = graph.row[i]; a < graph.row[i + 1]; ++a) {
      const Arc arc = graph.arcs[a];
      if (labels[arc.head] != 0) continue;
      const std::int64_t amount = flow.residual[arc.id];
      flow.residual[arc.id] = 0;
      flow.residual[arc.id ^ 1U] += amount;
      flow.surplus[i] -= amount;
      flow.surplus[arc.head] += amount;
    }
  }
}

}  // namespace

void round_at_best_threshold(const CutProblem& problem, const ResidualGraph& graph,
                             const std::vector<float>& relaxed, CutLabels& labels,
                             std::int64_t& value) {
  const std::vector<std::uint32_t> order = sort_fractional(relaxed);
  labels.resize(relaxed.size());
  for (std::size_t i = 0; i < relaxed.size(); ++i) labels[i] = relaxed[i] >= 1 ? 1 : 0;
  // From the smallest source side on, one group of equal values after the other joins it.
  std::int64_t cost = cut_cost(problem, labels);
  value = cost;
  std::size_t best = 0;
  CutLabels side = labels;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t i = order[k];
    cost -= graph.terminal[i];
    for (std::uint32_t a = graph.row[i]; a < graph.row[i + 1]; ++a) {
      const Arc arc = graph.arcs[a];
      cost += side[arc.head] != 0 ? -graph.residual[arc.id ^ 1U] : graph.residual[arc.id];
    }
    side[i] = 1;
    const bool group_ends = k + 1 == order.size() || relaxed[order[k + 1]] != relaxed[i];
    if (group_ends && cost < value) {
      value = cost;
      best = k + 1;
    }
  }
  for (std::size_t k = 0; k < best; ++k) labels[order[k]] = 1;
}

IntegerFlow rounded_flow(const ResidualGraph& graph, const Operator& iteration) {
  IntegerFlow flow{graph.residual, graph.terminal};
  for (std::size_t e = 0; e < graph.residual.size() / 2; ++e) {
    if (!iteration.has_arcs(e)) continue;
    const std::int64_t capacity = graph.residual[2 * e];
    const std::int64_t reverse = graph.residual[2 * e + 1];
    // Below 2^62 in size, and clipped to the capacity in integers.
    const std::int64_t amount =
        std::clamp<std::int64_t>(std::llrint(iteration.flow(e)), -reverse, capacity);
    flow.residual[2 * e] -= amount;
    flow.residual[2 * e + 1] += amount;
  }
  for (std::uint32_t i = 0; i < graph.node_count(); ++i) {
    for (std::uint32_t a = graph.row[i]; a < graph.row[i + 1]; ++a) {
      const std::uint32_t id = graph.arcs[a].id;
      flow.surplus[i] -= graph.residual[id] - flow.residual[id];
    }
  }
  return flow;
}

std::int64_t repair(const ResidualGraph& graph, IntegerFlow& flow, const CutLabels& labels,
                    std::int64_t effort, RepairCounts& counts) {
  saturate_cut(graph, flow, labels);
  const std::int64_t source_gap = SideRepair<1>(graph, flow, labels, counts).run(effort);
  return source_gap + SideRepair<-1>(graph, flow, labels, counts).run(effort);
}

}  // namespace cellocut::solvers::lp
