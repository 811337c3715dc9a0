// From a dual flow in integers to a maximum flow.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_solver.h"
#include "solvers/lp/rounding.h"

namespace cellocut::solvers::lp {

struct Crossover {
  std::vector<std::int64_t> edge_flow;  // a maximum flow
  std::int64_t added_value = 0;         // that the exact solver added to the dual flow
  std::int64_t returned = 0;            // and that went back to where it came from
};

// Completes a dual flow by an exact solver (bk) on what is left of the capacities. First from nodes
// with a surplus to nodes that lack something: now the value is that of a maximum flow, and no
// residual path leads from a surplus to a lack. What surplus remains beyond what a source arc can
// take back in place is returned to nodes that draw from the source, and what lack remains is made
// up by nodes that give to the sink: in the residual graph there is a way for each, as for the
// second phase of a preflow algorithm.
// Errors: as CutSolver::solve.
Crossover complete_flow(const CutProblem& problem, const ResidualGraph& graph, IntegerFlow flow,
                        const SolveContext& context);

}  // namespace cellocut::solvers::lp
