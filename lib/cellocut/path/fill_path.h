// Every labelling that is a minimum for some lambda_fill.
//
// As a function of lambda the least cost is the lower envelope of finitely many lines, one for each
// pair of supported and unsupported area that a minimum can have. The path is found by recursion on
// the envelope (Eisner and Severance, J. ACM 23, 1976): where the lines that are minimal next to
// both ends of a range are not the same, solve where they cross; either none is below, and the
// crossing is a breakpoint, or what is below divides the range. Everything is exact: breakpoints
// are fractions, capacities are multiplied out.
//
// Where minimum cuts are nested (parametric_problem.h) each solve concerns only the nodes in which
// the ends of its range differ, in each part that edges join on its own (piece.h), and where minima
// tie, the two canonical ones at a breakpoint are those of its sides: the largest minimum there is
// the largest on the interval before it, the smallest the smallest on the one after it. Where they
// are not (support measured on facets) each solve is one of the whole problem, and it takes one
// more for each labelling.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/cut/cut_solver.h"
#include "cellocut/path/parametric_problem.h"

namespace cellocut {

struct FillPath {
  Lambda first;  // the range
  Lambda last;
  // Labelling k is minimal from breakpoint k - 1 to breakpoint k (ends of the range beyond), and in
  // the open interval between them the largest minimum. Ascending in lambda: areas of supported
  // interface rise, those of unsupported fall, and each labelling holds the next where cuts are
  // nested.
  std::vector<InterfaceAreas> areas;
  std::vector<Lambda> breakpoints;  // one less
  bool nested = true;
  // Where cuts are not nested: per labelling, which nodes are on its source side. The proof is then
  // a flow at each breakpoint and both ends, too many to be kept: they are shown to a FlowWitness.
  // `level` and `zone_flow` are empty.
  std::vector<std::vector<bool>> source_side;
  // Per node: in how many labellings it is on the source side; in the first ones, as they are
  // nested.
  std::vector<std::uint32_t> level;
  // The proof. Nodes of one level are a zone; that of level k < areas.size() changes sides at
  // breakpoint k - 1, that of level 0 is a sink side before `first`, that of the highest a source
  // side beyond `last`. Per edge within a zone: net flow, at the lambda of that breakpoint or end,
  // in units of q supported + p unsupported. Edges between zones are saturated away from the higher
  // level, and have 0 here.
  std::vector<Wide> zone_flow;
  // Figures of the search.
  int solves = 0;                 // problems solved
  int digits = 0;                 // calls of the solver
  std::int64_t solved_nodes = 0;  // nodes of all problems
};

// Where cuts are not nested: sees a maximum flow at each breakpoint and both ends of the range, net
// per edge, in units of q supported + p unsupported, one after the other.
using FlowWitness = std::function<void(const Lambda& lambda, const std::vector<Wide>& edge_flow)>;

// The whole path over [first, last]. Labellings are the same for every exact solver; the flow and
// the figures of the search may differ. Takes fewer than two cuts for each labelling, and one at a
// simple fraction for each range that is wide, each of the nodes in which the ends of its range
// differ; where cuts are not nested, three of the whole problem for each labelling. Both ends of
// the range, and then whatever parts and halves of ranges are independent, are solved in parallel:
// `solver` must keep nothing from one problem to the next. Preconditions: first < last; areas sum
// to at most 2^50. Errors: as solve_wide(); std::logic_error where problem.nested() and cuts are
// not (not known to happen).
FillPath find_fill_path(const ParametricProblem& problem, const Lambda& first, const Lambda& last,
                        CutSolver& solver, Observer& observer, const FlowWitness& witness = {});

// Where labelling k is a minimum. Precondition: k < areas.size().
struct LambdaInterval {
  Lambda from;
  Lambda to;
};
LambdaInterval interval_of(const FillPath& path, std::size_t k);

// Whether labelling k has the node on its source side.
inline bool holds(const FillPath& path, std::size_t k, std::size_t node) {
  return path.nested ? path.level[node] > k : path.source_side[k][node];
}
// The labelling that is the largest minimum at lambda: at a breakpoint that of the smaller lambda.
// Precondition: lambda within the range.
std::size_t labelling_at(const FillPath& path, const Lambda& lambda);

}  // namespace cellocut
