// The same problem with neighbours close together in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_problem.h"

namespace cellocut::solvers::lp {

struct Reordering {
  CutProblem problem;
  std::vector<std::uint32_t> node;  // that was what in the original, per node of `problem`
  std::vector<std::uint32_t> edge;
};

// Nodes in breadth-first order from the lowest number of each component, edges by the first node
// that they join. Errors: LimitError as ResidualGraph. O(nodes + edges).
Reordering reorder(const CutProblem& problem);

}  // namespace cellocut::solvers::lp
