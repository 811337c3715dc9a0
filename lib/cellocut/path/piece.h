// Parts of a parametric problem: what changes sides within a range of lambda.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_solver.h"
#include "cellocut/path/parametric_problem.h"

namespace cellocut {

// The nodes between two nested labellings, with the rest of the problem in the terminals, and two
// labellings of them.
struct Piece {
  ParametricProblem problem;
  std::vector<std::uint32_t> node;  // of the whole problem, per node of the piece
  std::vector<std::uint32_t> edge;  // likewise
  CutLabels before;                 // a minimum next to the beginning of the range
  CutLabels after;                  // and next to its end
  std::vector<double> flow;         // per edge, about its flow at the lambda `flow_at`; or empty
  Lambda flow_at;
};

// The nodes of `upper` that are not in `lower`. Areas of two labellings of the new piece differ as
// those of the old one do; what all have in common is left out. `before` and `after` are labellings
// of the old one.
// Preconditions: `lower` is a subset of both, both are subsets of `upper`. O(nodes + edges).
// Errors: std::logic_error where lower is no subset of upper.
Piece contract(const Piece& piece, const CutLabels& lower, const CutLabels& upper,
               const CutLabels& before, const CutLabels& after);

// The parts that no edge joins: what is minimal in the piece is so in each of them. In the order of
// their first nodes. O(nodes + edges).
std::vector<Piece> connected_parts(Piece piece);

}  // namespace cellocut
