#include "cellocut/proxy/cluster_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "cellocut/base/disjoint_sets.h"

namespace cellocut {

namespace {

constexpr std::uint32_t kNone = ClusterTree::kNone;
constexpr float kNever = std::numeric_limits<float>::infinity();

constexpr double kCell = 2;       // edge of the cells of the first step
constexpr double kAgree = 0.97;   // least cosine between normals of the first step
constexpr int kMatchings = 3;     // before costs are measured again
constexpr double kHurried = 0.9;  // of the clusters' best mergers may be made by a later matching
// Of the squared length, added to the squared departure: clusters become round, and of one size
// where the surface bends alike. Without it cells of the complex leak through the slab where it is
// smooth (energies 5 to 20 % up on many models; docs/performance.md).
constexpr double kCompactness = 1e-4;

float cost_of(double departure, double area, double squared_length) {
  return static_cast<float>(departure + kCompactness * area * squared_length);
}

struct Cluster {
  Quadric quadric;
  Point3 at{};     // its representative
  double own = 0;  // quadric.at(at)
};

class Growth {
 public:
  Growth(const std::vector<ClusterLeaf>& leaves,
         const std::vector<std::array<std::uint32_t, 2>>& edges, double error);

  // The first step.
  void merge_smooth(const std::vector<ClusterLeaf>& leaves);
  // One round of pairs. Returns whether there was one.
  bool merge_pairs();

  ClusterTree tree() && { return std::move(tree_); }

 private:
  // Measures all edges: what each merger costs.
  void measure_edges();
  // The best partner of each cluster among those not yet matched, over edges of at most `bound`.
  void match_once(float bound);
  // The cost that a share of the clusters can have a partner for.
  [[nodiscard]] float bound_of(double share) const;
  // Makes clusters of clusters: `group` is the new number of each, `count` how many there are.
  void merge(const std::vector<std::uint32_t>& group, std::size_t count);
  void join_edges(const std::vector<std::uint32_t>& group, std::size_t count);

  double squared_error_;
  ClusterTree tree_;
  std::vector<Cluster> cluster_;
  std::vector<std::uint32_t> node_;  // of the tree, per cluster
  // Edges in rows of the lower end, each once.
  std::vector<std::uint32_t> row_;
  std::vector<std::uint32_t> other_;
  // Of a round.
  std::vector<float> edge_cost_;
  std::vector<float> best_cost_;
  std::vector<std::uint32_t> best_;
  std::vector<std::uint32_t> partner_;
};

Growth::Growth(const std::vector<ClusterLeaf>& leaves,
               const std::vector<std::array<std::uint32_t, 2>>& edges, double error)
    : squared_error_(error * error), cluster_(leaves.size()), node_(leaves.size()) {
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    cluster_[i] = {leaves[i].quadric, leaves[i].at, leaves[i].quadric.at(leaves[i].at)};
  }
  std::iota(node_.begin(), node_.end(), 0U);
  tree_.leaves = leaves.size();
  tree_.parent.assign(leaves.size(), kNone);
  tree_.representative = node_;
  tree_.cost.assign(leaves.size(), 0);
  row_.assign(leaves.size() + 1, 0);
  for (const auto& [a, b] : edges) ++row_[std::min(a, b) + 1];
  std::partial_sum(row_.begin(), row_.end(), row_.begin());
  other_.resize(edges.size());
  std::vector<std::uint32_t> next(row_.begin(), row_.end() - 1);
  for (const auto& [a, b] : edges) other_[next[std::min(a, b)]++] = std::max(a, b);
}

void Growth::merge(const std::vector<std::uint32_t>& group, std::size_t count) {
  std::vector<Cluster> merged(count);
  std::vector<std::uint32_t> members(count, 0);
  for (std::size_t i = 0; i < cluster_.size(); ++i) {
    merged[group[i]].quadric += cluster_[i].quadric;
    ++members[group[i]];
  }
  // The member that is the best representative.
  std::vector<std::uint32_t> best(count, kNone);
  for (std::uint32_t i = 0; i < cluster_.size(); ++i) {
    Cluster& m = merged[group[i]];
    const double own = m.quadric.at(cluster_[i].at);
    if (best[group[i]] != kNone && own >= m.own) continue;
    best[group[i]] = i;
    m.own = own;
    m.at = cluster_[i].at;
  }
  std::vector<std::uint32_t> node(count);
  for (std::size_t m = 0; m < count; ++m) {
    node[m] = node_[best[m]];
    if (members[m] == 1) continue;
    const std::uint32_t representative = tree_.representative[node[m]];
    node[m] = static_cast<std::uint32_t>(tree_.size());
    tree_.parent.push_back(kNone);
    tree_.representative.push_back(representative);
    tree_.cost.push_back(0);
  }
  for (std::size_t i = 0; i < cluster_.size(); ++i) {
    const std::uint32_t parent = node[group[i]];
    if (parent == node_[i]) continue;
    tree_.parent[node_[i]] = parent;
    const Cluster& m = merged[group[i]];
    tree_.cost[parent] =
        std::max({tree_.cost[parent], tree_.cost[node_[i]],
                  cost_of(m.own, m.quadric.area, squared_norm(cluster_[i].at - m.at))});
  }
  join_edges(group, count);
  cluster_ = std::move(merged);
  node_ = std::move(node);
}

void Growth::join_edges(const std::vector<std::uint32_t>& group, std::size_t count) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(other_.size());
  std::vector<std::uint32_t> row(count + 1, 0);
  for (std::uint32_t i = 0; i < cluster_.size(); ++i) {
    for (std::uint32_t e = row_[i]; e < row_[i + 1]; ++e) {
      const auto [a, b] = std::minmax(group[i], group[other_[e]]);
      if (a == b) continue;
      edges.push_back({a, b});
      ++row[a + 1];
    }
  }
  std::partial_sum(row.begin(), row.end(), row.begin());
  other_.resize(edges.size());
  std::vector<std::uint32_t> next(row.begin(), row.end() - 1);
  for (const auto& [a, b] : edges) other_[next[a]++] = b;
  // Those that were there before go.
  std::vector<std::uint32_t> seen_from(count, kNone);
  std::uint32_t left = 0;
  for (std::uint32_t a = 0; a < count; ++a) {
    const std::uint32_t begin = row[a];
    row[a] = left;
    for (std::uint32_t e = begin; e < next[a]; ++e) {
      const std::uint32_t b = other_[e];
      if (seen_from[b] == a) continue;
      seen_from[b] = a;
      other_[left++] = b;
    }
  }
  row.back() = left;
  other_.resize(left);
  row_ = std::move(row);
}

void Growth::merge_smooth(const std::vector<ClusterLeaf>& leaves) {
  const auto cell_of = [&](std::size_t i) {
    std::uint32_t cell = 0;
    for (const double x : leaves[i].at) {
      cell = (cell << 10) | static_cast<std::uint32_t>(x / kCell);
    }
    return cell;
  };
  DisjointSets sets(leaves.size());
  for (std::uint32_t a = 0; a < leaves.size(); ++a) {
    const std::uint32_t cell = cell_of(a);
    for (std::uint32_t e = row_[a]; e < row_[a + 1]; ++e) {
      const std::uint32_t b = other_[e];
      if (cell == cell_of(b) && dot(leaves[a].normal, leaves[b].normal) > kAgree) sets.join(a, b);
    }
  }
  std::vector<std::uint32_t> group(leaves.size());
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < leaves.size(); ++i) {
    const std::uint32_t root = sets.root(i);
    group[i] = root == i ? count++ : group[root];
  }
  merge(group, count);
}

void Growth::measure_edges() {
  edge_cost_.resize(other_.size());
  for (std::uint32_t a = 0; a < cluster_.size(); ++a) {
    const Cluster p = cluster_[a];
    for (std::uint32_t e = row_[a]; e < row_[a + 1]; ++e) {
      const Cluster& q = cluster_[other_[e]];
      const double least = std::min(p.own + q.quadric.at(p.at), p.quadric.at(q.at) + q.own);
      const double area = p.quadric.area + q.quadric.area;
      edge_cost_[e] =
          least > squared_error_ * area ? kNever : cost_of(least, area, squared_norm(p.at - q.at));
    }
  }
}

void Growth::match_once(float bound) {
  best_cost_.assign(cluster_.size(), kNever);
  best_.assign(cluster_.size(), kNone);
  const auto offer = [&](std::uint32_t to, std::uint32_t other, float cost) {
    if (cost < best_cost_[to]) {
      best_cost_[to] = cost;
      best_[to] = other;
    }
  };
  for (std::uint32_t a = 0; a < cluster_.size(); ++a) {
    if (partner_[a] != kNone) continue;
    for (std::uint32_t e = row_[a]; e < row_[a + 1]; ++e) {
      const std::uint32_t b = other_[e];
      if (edge_cost_[e] > bound || partner_[b] != kNone) continue;
      offer(a, b, edge_cost_[e]);
      offer(b, a, edge_cost_[e]);
    }
  }
  for (std::uint32_t a = 0; a < cluster_.size(); ++a) {
    if (best_[a] != kNone && best_[best_[a]] == a) partner_[a] = best_[a];
  }
}

float Growth::bound_of(double share) const {
  std::vector<float> cost = best_cost_;
  const auto place =
      cost.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(cost.size()));
  std::nth_element(cost.begin(), place, cost.end());
  return *place;
}

bool Growth::merge_pairs() {
  if (cluster_.size() < 2) return false;
  measure_edges();
  partner_.assign(cluster_.size(), kNone);
  match_once(kNever);
  const float bound = bound_of(kHurried);
  for (int n = 1; n < kMatchings; ++n) match_once(bound);
  std::vector<std::uint32_t> group(cluster_.size());
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < cluster_.size(); ++i) {
    group[i] = partner_[i] < i ? group[partner_[i]] : count++;
  }
  if (count == cluster_.size()) return false;
  merge(group, count);
  return true;
}

}  // namespace

ClusterTree grow_cluster_tree(std::vector<ClusterLeaf> leaves,
                              const std::vector<std::array<std::uint32_t, 2>>& edges,
                              double error) {
  Growth growth(leaves, edges, error);
  growth.merge_smooth(leaves);
  leaves = {};
  while (growth.merge_pairs()) {
  }
  return std::move(growth).tree();
}

}  // namespace cellocut
