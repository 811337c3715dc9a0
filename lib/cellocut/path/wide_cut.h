// Minimum cuts with capacities of up to 128 bits, by solvers of 64 bits.
//
// The method is scaling (Edmonds and Karp, J. ACM 19, 1972; Gabow, J. Comput. Syst. Sci. 31, 1985),
// with digits as large as a solver takes. Capacities without their lowest bits give a flow that is
// short of a maximum by less than one unit of that digit for each arc of its minimum cut. What is
// left to send is then known to be small, so all that a residual arc has beyond it may be
// forgotten, and the next digit fits again. One digit where the sum of all capacities does.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/cut/cut_problem.h"
#include "cellocut/cut/cut_solver.h"

namespace cellocut {

__extension__ using Wide = __int128;

// As CutProblem, each edge with one capacity for both directions.
struct WideProblem {
  struct Edge {
    std::uint32_t from;
    std::uint32_t to;
    Wide capacity;
  };
  std::vector<Wide> to_source;
  std::vector<Wide> to_sink;
  std::vector<Edge> edges;
  Wide constant = 0;

  [[nodiscard]] std::size_t node_count() const { return to_source.size(); }
};

struct WideCut {
  Wide value = 0;                  // constant included
  std::vector<Wide> edge_flow;     // net, from `from` to `to`
  CutLabels smallest_source_side;  // the two canonical minimum cuts
  CutLabels largest_source_side;
  int digits = 0;  // solves that it took
};

// Exact for every solver that is; the flow is checked, whatever the solver says of it. Costs a
// solve for each digit, and O(nodes + edges). `start`: about the flow of each edge, for the solver
// to begin with (SolveOptions); or empty. Preconditions: capacities are not negative and sum,
// constant included, to less than 2^124. Errors: those of CutSolver::solve; CertificateError where
// the solver's flow is no maximum flow.
WideCut solve_wide(const WideProblem& problem, CutSolver& solver, Observer& observer,
                   std::span<const double> start = {});

}  // namespace cellocut
