#include "cellocut/cut/cut_problem.h"

#include <string>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {
__extension__ using Wide = __int128;
}

void CutProblem::validate() const {
  if (to_sink.size() != to_source.size()) {
    throw InputError("cut problem: " + std::to_string(to_source.size()) +
                     " source capacities but " + std::to_string(to_sink.size()) +
                     " sink capacities");
  }
  if (constant < 0) throw InputError("cut problem: negative constant");
  Wide sum = constant;
  for (std::size_t i = 0; i < to_source.size(); ++i) {
    if (to_source[i] < 0 || to_sink[i] < 0) {
      throw InputError("cut problem: negative terminal capacity at node " + std::to_string(i));
    }
    sum += to_source[i];
    sum += to_sink[i];
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const CutEdge& edge = edges[e];
    if (edge.from >= node_count() || edge.to >= node_count()) {
      throw InputError("cut problem: edge " + std::to_string(e) +
                       " names a node that is not there");
    }
    if (edge.capacity < 0 || edge.reverse_capacity < 0) {
      throw InputError("cut problem: negative capacity at edge " + std::to_string(e));
    }
    sum += edge.capacity;
    sum += edge.reverse_capacity;
  }
  if (sum >= Wide{kCapacityLimit}) {
    throw InputError("cut problem: the capacities sum to 2^62 or more and would overflow");
  }
}

std::int64_t cut_cost(const CutProblem& problem, const CutLabels& source_side) {
  std::int64_t cost = problem.constant;
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    cost += source_side[i] != 0 ? problem.to_sink[i] : problem.to_source[i];
  }
  for (const CutEdge& edge : problem.edges) {
    if (source_side[edge.from] != 0 && source_side[edge.to] == 0) cost += edge.capacity;
    if (source_side[edge.from] == 0 && source_side[edge.to] != 0) cost += edge.reverse_capacity;
  }
  return cost;
}

}  // namespace cellocut
