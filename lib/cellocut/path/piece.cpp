#include "cellocut/path/piece.h"

#include <stdexcept>

#include "cellocut/base/disjoint_sets.h"

namespace cellocut {

Piece contract(const Piece& piece, const CutLabels& lower, const CutLabels& upper,
               const CutLabels& before, const CutLabels& after) {
  constexpr std::uint32_t kInside = 0xFFFFFFFEU;
  constexpr std::uint32_t kOut = 0xFFFFFFFFU;
  const ParametricProblem& whole = piece.problem;
  Piece result;
  result.flow_at = piece.flow_at;
  ParametricProblem& part = result.problem;
  std::vector<std::uint32_t> place(whole.node_count());
  for (std::uint32_t i = 0; i < whole.node_count(); ++i) {
    if (lower[i] != 0 && upper[i] == 0) throw std::logic_error("fill path: cuts are not nested");
    if (lower[i] != 0) {
      place[i] = kInside;
    } else if (upper[i] == 0) {
      place[i] = kOut;
    } else {
      place[i] = static_cast<std::uint32_t>(result.node.size());
      result.node.push_back(piece.node[i]);
      result.before.push_back(before[i]);
      result.after.push_back(after[i]);
      part.to_source.push_back(whole.to_source[i]);
      part.to_sink.push_back(whole.to_sink[i]);
    }
  }
  for (std::size_t e = 0; e < whole.edges.size(); ++e) {
    const ParametricProblem::Edge& edge = whole.edges[e];
    const std::uint32_t a = place[edge.from];
    const std::uint32_t b = place[edge.to];
    if (a < kInside && b < kInside) {
      part.edges.push_back({a, b, edge.areas});
      result.edge.push_back(piece.edge[e]);
      if (!piece.flow.empty()) result.flow.push_back(piece.flow[e]);
    } else if (a < kInside || b < kInside) {
      const std::uint32_t node = a < kInside ? a : b;
      const std::uint32_t other = a < kInside ? b : a;
      (other == kInside ? part.to_source : part.to_sink)[node] += edge.areas;
    }
  }
  return result;
}

namespace {

// Per node the number of its connected part, by order of first nodes, and how many parts there are.
struct Parts {
  std::vector<std::uint32_t> of_node;
  std::uint32_t count = 0;
};

Parts number_parts(const ParametricProblem& problem) {
  DisjointSets sets(problem.node_count());
  for (const ParametricProblem::Edge& edge : problem.edges) sets.join(edge.from, edge.to);
  Parts parts{std::vector<std::uint32_t>(problem.node_count()), 0};
  for (std::uint32_t i = 0; i < parts.of_node.size(); ++i) {
    const std::uint32_t first = sets.root(i);
    parts.of_node[i] = first == i ? parts.count++ : parts.of_node[first];
  }
  return parts;
}

}  // namespace

std::vector<Piece> connected_parts(Piece piece) {
  const ParametricProblem& problem = piece.problem;
  const Parts parts = number_parts(problem);
  std::vector<Piece> result(parts.count);
  if (parts.count == 1) {
    result[0] = std::move(piece);
    return result;
  }
  for (Piece& part : result) part.flow_at = piece.flow_at;
  std::vector<std::uint32_t> place(problem.node_count());
  for (std::uint32_t i = 0; i < place.size(); ++i) {
    Piece& part = result[parts.of_node[i]];
    place[i] = static_cast<std::uint32_t>(part.node.size());
    part.problem.to_source.push_back(problem.to_source[i]);
    part.problem.to_sink.push_back(problem.to_sink[i]);
    part.node.push_back(piece.node[i]);
    part.before.push_back(piece.before[i]);
    part.after.push_back(piece.after[i]);
  }
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const ParametricProblem::Edge& edge = problem.edges[e];
    Piece& part = result[parts.of_node[edge.from]];
    part.problem.edges.push_back({place[edge.from], place[edge.to], edge.areas});
    part.edge.push_back(piece.edge[e]);
    if (!piece.flow.empty()) part.flow.push_back(piece.flow[e]);
  }
  return result;
}

}  // namespace cellocut
