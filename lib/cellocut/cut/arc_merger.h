// Parallel and opposite arcs to edges. Internal to the problem files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_problem.h"

namespace cellocut::cut_io {

struct Arc {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::int64_t capacity = 0;
};

// One edge per unordered pair of nodes, in the order of first appearance, directed as the first
// arc; capacities of parallel arcs add up. Preconditions: fewer than 2^32 arcs, none a loop, nodes
// below `nodes`, the sum of all capacities fits 64 bits. O(nodes + arcs).
std::vector<CutEdge> merge_arcs(const std::vector<Arc>& arcs, std::size_t nodes);

}  // namespace cellocut::cut_io
