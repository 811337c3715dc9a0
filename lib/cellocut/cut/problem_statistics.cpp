#include "cellocut/cut/problem_statistics.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <random>
#include <vector>

namespace cellocut {

namespace {

constexpr std::uint32_t kUnseen = std::numeric_limits<std::uint32_t>::max();

bool is_loop(const CutEdge& edge) { return edge.from == edge.to; }

void count_capacity(CapacityHistogram& histogram, std::int64_t capacity) {
  if (capacity == 0) return;
  ++histogram[static_cast<std::size_t>(std::bit_width(static_cast<std::uint64_t>(capacity)) - 1)];
}

// The neighbours of node i are to[row[i] .. row[i + 1]).
struct Neighbours {
  std::vector<std::uint64_t> row;
  std::vector<std::uint32_t> to;

  explicit Neighbours(const CutProblem& problem) : row(problem.node_count() + 1, 0) {
    const auto connects = [](const CutEdge& edge) {
      return !is_loop(edge) && (edge.capacity | edge.reverse_capacity) != 0;
    };
    for (const CutEdge& edge : problem.edges) {
      if (!connects(edge)) continue;
      ++row[edge.from + std::size_t{1}];
      ++row[edge.to + std::size_t{1}];
    }
    for (std::size_t i = 1; i < row.size(); ++i) row[i] += row[i - 1];
    to.resize(row.back());
    std::vector<std::uint64_t> next(row.begin(), row.end() - 1);
    for (const CutEdge& edge : problem.edges) {
      if (!connects(edge)) continue;
      to[next[edge.from]++] = edge.to;
      to[next[edge.to]++] = edge.from;
    }
  }
};

// Breadth-first searches that share their memory.
class BreadthFirst {
 public:
  explicit BreadthFirst(const Neighbours& graph)
      : graph_(graph), distance_(graph.row.size() - 1, kUnseen) {}

  // Reaches what is not yet reached. Afterwards reached() are the nodes, nearest first.
  void search(std::uint32_t start) {
    queue_.assign(1, start);
    distance_[start] = 0;
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      const std::uint32_t i = queue_[k];
      for (std::uint64_t a = graph_.row[i]; a < graph_.row[i + std::size_t{1}]; ++a) {
        const std::uint32_t other = graph_.to[a];
        if (distance_[other] != kUnseen) continue;
        distance_[other] = distance_[i] + 1;
        queue_.push_back(other);
      }
    }
  }
  void forget() {
    for (const std::uint32_t i : queue_) distance_[i] = kUnseen;
  }
  [[nodiscard]] bool has_reached(std::uint32_t i) const { return distance_[i] != kUnseen; }
  [[nodiscard]] const std::vector<std::uint32_t>& reached() const { return queue_; }
  [[nodiscard]] std::uint32_t farthest() const { return queue_.back(); }
  [[nodiscard]] std::uint32_t farthest_distance() const { return distance_[queue_.back()]; }

 private:
  const Neighbours& graph_;
  std::vector<std::uint32_t> distance_;
  std::vector<std::uint32_t> queue_;
};

void count_arcs(const CutProblem& problem, ProblemStatistics& statistics) {
  for (const CutEdge& edge : problem.edges) {
    if (is_loop(edge)) {
      ++statistics.loops;
      continue;
    }
    for (const std::int64_t capacity : {edge.capacity, edge.reverse_capacity}) {
      ++(capacity > 0 ? statistics.arcs : statistics.zero_capacities);
      count_capacity(statistics.edge_capacities, capacity);
    }
  }
}

void count_terminals(const CutProblem& problem, ProblemStatistics& statistics) {
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    const bool source = problem.to_source[i] > 0;
    const bool sink = problem.to_sink[i] > 0;
    if (source) ++statistics.source_nodes;
    if (sink) ++statistics.sink_nodes;
    if (source && sink) ++statistics.both_nodes;
    count_capacity(statistics.terminal_capacities, problem.to_source[i]);
    count_capacity(statistics.terminal_capacities, problem.to_sink[i]);
  }
  const auto share = [&problem](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(problem.node_count());
  };
  statistics.source_share = share(statistics.source_nodes);
  statistics.sink_share = share(statistics.sink_nodes);
  statistics.both_share = share(statistics.both_nodes);
}

DegreeStatistics degrees(const CutProblem& problem) {
  std::vector<std::uint32_t> degree(problem.node_count(), 0);
  std::uint64_t ends = 0;
  for (const CutEdge& edge : problem.edges) {
    if (is_loop(edge)) continue;
    ++degree[edge.from];
    ++degree[edge.to];
    ends += 2;
  }
  const auto [least, most] = std::minmax_element(degree.begin(), degree.end());
  DegreeStatistics statistics;
  statistics.minimum = *least;
  statistics.maximum = *most;
  statistics.mean = static_cast<double>(ends) / static_cast<double>(degree.size());
  const auto middle = degree.begin() + static_cast<std::ptrdiff_t>((degree.size() - 1) / 2);
  std::nth_element(degree.begin(), middle, degree.end());
  statistics.median = *middle;
  return statistics;
}

// Counts the components and returns a node of the largest.
std::uint32_t count_components(const Neighbours& graph, ProblemStatistics& statistics) {
  BreadthFirst search(graph);
  std::uint32_t in_largest = 0;
  for (std::uint32_t i = 0; i < statistics.nodes; ++i) {
    if (search.has_reached(i)) continue;
    search.search(i);
    ++statistics.components;
    if (search.reached().size() > statistics.largest_component) {
      statistics.largest_component = search.reached().size();
      in_largest = i;
    }
  }
  return in_largest;
}

std::uint64_t longest_sweep(const Neighbours& graph, std::uint32_t first_start,
                            std::uint32_t sweeps, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  BreadthFirst search(graph);
  std::uint64_t longest = 0;
  for (std::uint32_t sweep = 0; sweep < sweeps; ++sweep) {
    const std::uint32_t start =
        sweep == 0 ? first_start : static_cast<std::uint32_t>(random() % (graph.row.size() - 1));
    search.search(start);
    const std::uint32_t farthest = search.farthest();
    search.forget();
    search.search(farthest);
    longest = std::max<std::uint64_t>(longest, search.farthest_distance());
    search.forget();
  }
  return longest;
}

}  // namespace

ProblemStatistics problem_statistics(const CutProblem& problem, std::uint32_t sweeps,
                                     std::uint64_t seed) {
  ProblemStatistics statistics;
  statistics.nodes = problem.node_count();
  statistics.edges = problem.edges.size();
  if (problem.node_count() == 0) return statistics;
  count_arcs(problem, statistics);
  count_terminals(problem, statistics);
  statistics.degree = degrees(problem);
  const Neighbours graph(problem);
  const std::uint32_t in_largest = count_components(graph, statistics);
  statistics.diameter_lower_bound = longest_sweep(graph, in_largest, sweeps, seed);
  return statistics;
}

}  // namespace cellocut
