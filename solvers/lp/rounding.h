// From a fractional point to integers: the best threshold, and a dual flow that proves it.
#pragma once

#include <cstdint>
#include <vector>

#include "solvers/lp/operator.h"
#include "solvers/residual_graph.h"

namespace cellocut::solvers::lp {

// A dual flow in whole units: residual capacities by arc id, as in ResidualGraph, and what is left
// at every node, its terminal less the net flow out of it.
struct IntegerFlow {
  std::vector<std::int64_t> residual;
  std::vector<std::int64_t> surplus;
};

// The dual flow of the iteration, rounded and clipped to the capacities.
IntegerFlow rounded_flow(const ResidualGraph& graph, const Operator& iteration);

// The source side {x > theta} of the least cost over all thresholds, exactly in integers.
// O(nodes + edges), with a radix sort of the fractional values.
void round_at_best_threshold(const CutProblem& problem, const ResidualGraph& graph,
                             const std::vector<float>& relaxed, CutLabels& labels,
                             std::int64_t& value);

struct RepairCounts {
  std::int64_t sweeps = 0;
  std::int64_t pushes = 0;
};

// Repairs a dual flow for a labelling. A labelling is proved by a dual flow that saturates every
// edge that it cuts, and that leaves no node of the source side with less than its terminal gives
// and none of the sink side with more; the gap is the sum of what is missing. The flow of the
// iteration almost does that, so here, in integers: cut edges are saturated, and then, on each side
// apart, what is missing at some nodes is moved there from nodes near by that can spare it, along
// residual arcs towards the nearest node in need, a breadth-first search and a sweep over it at a
// time. Nothing that a sweep does makes the gap larger. It stops after about `effort` arcs on each
// side; where the labelling is not a minimum cut, a gap stays. Returns the gap that is left.
std::int64_t repair(const ResidualGraph& graph, IntegerFlow& flow, const CutLabels& labels,
                    std::int64_t effort, RepairCounts& counts);

}  // namespace cellocut::solvers::lp
