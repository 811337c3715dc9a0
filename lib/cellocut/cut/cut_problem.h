// A minimum cut problem with 64-bit integer capacities, general enough for any max-flow instance.
//
// A labelling puts every node on the source side or on the sink side. Its cost is
//     constant + sum of to_source[i] over nodes i on the sink side
//              + sum of to_sink[i]   over nodes i on the source side
//              + sum of capacity         over edges with `from` on the source side and `to` on the
//              sink side
//              + sum of reverse_capacity over edges with `to` on the source side and `from` on the
//              sink side.
// Equivalently: arcs source -> i of capacity to_source[i] and i -> sink of capacity to_sink[i].
// For a remesh the source side is the interior.
#pragma once

#include <cstdint>
#include <vector>

namespace cellocut {

// Every sum that a solver can form is below this bound; see CutProblem::capacity_sum.
inline constexpr std::int64_t kCapacityLimit = std::int64_t{1} << 62;

struct CutEdge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::int64_t capacity = 0;          // from -> to
  std::int64_t reverse_capacity = 0;  // to -> from
};

struct CutProblem {
  std::vector<std::int64_t> to_source;  // one per node
  std::vector<std::int64_t> to_sink;    // one per node
  std::vector<CutEdge> edges;           // parallel edges, opposite edges and loops are allowed
  std::int64_t constant = 0;            // part of the cost of every labelling

  [[nodiscard]] std::size_t node_count() const { return to_source.size(); }

  // Throws InputError where sizes differ, an edge names a node that is not there, a capacity is
  // negative, or the sum of all terminal capacities, both directions of all edges and the constant
  // (in 128-bit arithmetic) is not below kCapacityLimit. O(nodes + edges).
  void validate() const;
};

// One entry per node, 1 on the source side.
using CutLabels = std::vector<std::uint8_t>;

// The cost of a labelling as defined above. Precondition: problem.validate() holds. O(nodes +
// edges).
std::int64_t cut_cost(const CutProblem& problem, const CutLabels& source_side);

}  // namespace cellocut
