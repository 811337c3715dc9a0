#include "cellocut/path/fill_path.h"

#include <algorithm>
#include <numeric>

#include "cellocut/path/envelope.h"

namespace cellocut {

namespace {

// A flow on a part of the problem at a breakpoint, and the largest minimum there.
struct ZoneProof {
  std::vector<std::uint32_t> node;  // of the whole problem, on the source side of that minimum
  std::vector<std::uint32_t> edge;  // of the whole problem, with its flow
  std::vector<Wide> flow;
};

class PathSearch {
 public:
  PathSearch(CutSolver& solver, Observer& observer) : solver_(solver), observer_(observer) {}

  FillPath run(const ParametricProblem& problem, const Lambda& first, const Lambda& last);

 private:
  WideCut solve(const Piece& piece, const Lambda& lambda);
  // Finds the breakpoints within the open range, in ascending order. `before` and `after` are the
  // lines that are minimal next to its ends.
  void divide(const Piece& piece, const InterfaceAreas& before, const InterfaceAreas& after);
  // `before`: the areas of the largest minimum.
  void add_breakpoint(const Piece& piece, const Lambda& lambda, const InterfaceAreas& before,
                      WideCut cut);

  CutSolver& solver_;
  Observer& observer_;
  FillPath path_;
  std::vector<ZoneProof> proofs_;  // by breakpoint
};

WideCut PathSearch::solve(const Piece& piece, const Lambda& lambda) {
  WideCut cut = solve_wide(at_lambda(piece.problem, lambda), solver_, observer_);
  ++path_.solves;
  path_.digits += cut.digits;
  path_.solved_nodes += static_cast<std::int64_t>(piece.problem.node_count());
  return cut;
}

void PathSearch::add_breakpoint(const Piece& piece, const Lambda& lambda,
                                const InterfaceAreas& before, WideCut cut) {
  ZoneProof proof{{}, piece.edge, std::move(cut.edge_flow)};
  for (std::size_t i = 0; i < piece.node.size(); ++i) {
    if (cut.largest_source_side[i] != 0) proof.node.push_back(piece.node[i]);
  }
  path_.breakpoints.push_back(lambda);
  path_.areas.push_back(before);
  proofs_.push_back(std::move(proof));
}

void PathSearch::divide(const Piece& piece, const InterfaceAreas& before,
                        const InterfaceAreas& after) {
  if (before == after) return;
  const Lambda lambda = crossing(before, after);
  WideCut cut = solve(piece, lambda);
  if (cut.value == cost_at(before, lambda)) {
    add_breakpoint(piece, lambda, before, std::move(cut));
    return;
  }
  const CutLabels none(piece.node.size(), 0);
  const CutLabels all(piece.node.size(), 1);
  const InterfaceAreas largest = areas_of(piece.problem, cut.largest_source_side);
  const InterfaceAreas smallest = areas_of(piece.problem, cut.smallest_source_side);
  divide(contract(piece, cut.smallest_source_side, all), before, largest);
  const Piece rest = contract(piece, none, cut.largest_source_side);
  if (!(largest == smallest)) add_breakpoint(piece, lambda, largest, std::move(cut));
  divide(rest, smallest, after);
}

FillPath PathSearch::run(const ParametricProblem& problem, const Lambda& first,
                         const Lambda& last) {
  path_.first = first;
  path_.last = last;
  Piece whole{problem, std::vector<std::uint32_t>(problem.node_count()),
              std::vector<std::uint32_t>(problem.edges.size())};
  std::iota(whole.node.begin(), whole.node.end(), 0U);
  std::iota(whole.edge.begin(), whole.edge.end(), 0U);
  const WideCut begin = solve(whole, first);
  const WideCut end = solve(whole, last);
  divide(contract(whole, end.smallest_source_side, begin.largest_source_side),
         areas_of(problem, begin.smallest_source_side), areas_of(problem, end.largest_source_side));
  path_.areas.push_back(areas_of(problem, end.largest_source_side));

  const auto count = static_cast<std::uint32_t>(path_.areas.size());
  path_.level.assign(problem.node_count(), 0);
  for (std::uint32_t k = 0; k + 1 < count; ++k) {
    for (const std::uint32_t i : proofs_[k].node) path_.level[i] = k + 1;
  }
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    if (end.largest_source_side[i] != 0) path_.level[i] = count;
  }
  // Each zone's part of the flow at its lambda.
  path_.zone_flow.assign(problem.edges.size(), 0);
  const auto level_of = [&](std::size_t e) {
    const std::uint32_t level = path_.level[problem.edges[e].from];
    return level == path_.level[problem.edges[e].to] ? level : count + 1;
  };
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const std::uint32_t level = level_of(e);
    if (level == 0) path_.zone_flow[e] = begin.edge_flow[e];
    if (level == count) path_.zone_flow[e] = end.edge_flow[e];
  }
  for (std::uint32_t k = 0; k + 1 < count; ++k) {
    for (std::size_t n = 0; n < proofs_[k].edge.size(); ++n) {
      const std::uint32_t e = proofs_[k].edge[n];
      if (level_of(e) == k + 1) path_.zone_flow[e] = proofs_[k].flow[n];
    }
  }
  return std::move(path_);
}

}  // namespace

FillPath find_fill_path(const ParametricProblem& problem, const Lambda& first, const Lambda& last,
                        CutSolver& solver, Observer& observer) {
  if (problem.nested()) return PathSearch(solver, observer).run(problem, first, last);
  return find_envelope(problem, first, last, solver, observer);
}

LambdaInterval interval_of(const FillPath& path, std::size_t k) {
  return {k == 0 ? path.first : path.breakpoints[k - 1],
          k + 1 == path.areas.size() ? path.last : path.breakpoints[k]};
}

std::size_t labelling_at(const FillPath& path, const Lambda& lambda) {
  return static_cast<std::size_t>(
      std::lower_bound(path.breakpoints.begin(), path.breakpoints.end(), lambda) -
      path.breakpoints.begin());
}

}  // namespace cellocut
