#include "solvers/reference/boost_instance.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "solvers/residual_graph.h"

namespace cellocut::solvers {

namespace {

constexpr std::uint64_t kNoArc = UINT64_MAX;

struct DirectedArc {
  std::uint32_t tail;
  std::uint32_t head;
  std::int64_t capacity;
};

}  // namespace

BoostInstance::BoostInstance(const CutProblem& problem, const SolveContext& context)
    : context_(context) {
  // Four arcs per edge and two per terminal arc; two more nodes.
  require_index_range(problem, std::numeric_limits<std::uint32_t>::max() / 8);
  const auto nodes = static_cast<std::uint32_t>(problem.node_count());
  source_ = nodes;
  const std::uint32_t sink = nodes + 1;

  // Arc 2k and its opposite 2k + 1.
  std::vector<DirectedArc> arcs;
  arcs.reserve(4 * problem.edges.size() + 2 * std::size_t{nodes});
  const auto add = [&](std::uint32_t tail, std::uint32_t head, std::int64_t capacity) {
    if (tail == head || capacity == 0) return kNoArc;
    arcs.push_back({tail, head, capacity});
    arcs.push_back({head, tail, 0});
    return std::uint64_t{arcs.size() - 2};
  };
  arcs_of_edge_.reserve(problem.edges.size());
  for (const CutEdge& edge : problem.edges) {
    arcs_of_edge_.push_back(
        {add(edge.from, edge.to, edge.capacity), add(edge.to, edge.from, edge.reverse_capacity)});
  }
  for (std::uint32_t i = 0; i < nodes; ++i) {
    add(source_, i, problem.to_source[i]);
    add(i, sink, problem.to_sink[i]);
  }

  // Rows by tail: place[a] is where arc a goes.
  std::vector<std::uint64_t> next(std::size_t{nodes} + 3, 0);
  for (const DirectedArc& arc : arcs) ++next[arc.tail + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<std::uint64_t> place(arcs.size());
  for (std::size_t a = 0; a < arcs.size(); ++a) place[a] = next[arcs[a].tail]++;

  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends(arcs.size());
  capacity_.resize(arcs.size());
  std::vector<std::uint64_t> opposite(arcs.size());
  for (std::size_t a = 0; a < arcs.size(); ++a) {
    ends[place[a]] = {arcs[a].tail, arcs[a].head};
    capacity_[place[a]] = arcs[a].capacity;
    opposite[place[a]] = place[a ^ 1U];
  }
  for (auto& both : arcs_of_edge_) {
    for (std::uint64_t& arc : both) {
      if (arc != kNoArc) arc = place[arc];
    }
  }
  graph_ = Graph(boost::edges_are_sorted, ends.begin(), ends.end(), nodes + 2);
  residual_.assign(arcs.size(), 0);
  std::vector<Arc> by_number(arcs.size());
  for (auto [arc, end] = boost::edges(graph_); arc != end; ++arc) by_number[number(*arc)] = *arc;
  opposite_.reserve(arcs.size());
  for (const std::uint64_t other : opposite) opposite_.push_back(by_number[other]);
}

std::vector<std::int64_t> BoostInstance::edge_flow() const {
  const auto through = [this](std::uint64_t arc) {
    return arc == kNoArc ? 0 : capacity_[arc] - residual_[arc];
  };
  std::vector<std::int64_t> flow(arcs_of_edge_.size());
  for (std::size_t e = 0; e < flow.size(); ++e) {
    flow[e] = through(arcs_of_edge_[e][0]) - through(arcs_of_edge_[e][1]);
  }
  return flow;
}

std::int64_t BoostInstance::bytes() const {
  return static_cast<std::int64_t>(capacity_.size() * (8 + 2 * sizeof(std::int64_t) + sizeof(Arc)) +
                                   arcs_of_edge_.size() * 2 * sizeof(std::uint64_t) +
                                   boost::num_vertices(graph_) * sizeof(std::uint64_t));
}

}  // namespace cellocut::solvers
