#include "cellocut/path/envelope.h"

#include <cmath>
#include <optional>
#include <stdexcept>

namespace cellocut {

namespace {

class EnvelopeSearch {
 public:
  EnvelopeSearch(const ParametricProblem& problem, CutSolver& solver, Observer& observer,
                 const FlowWitness& witness)
      : problem_(problem), solver_(solver), observer_(observer), witness_(witness) {}

  FillPath run(const Lambda& first, const Lambda& last);

 private:
  WideCut solve(const Lambda& lambda);
  void show(const WideCut& cut, const Lambda& lambda) const;
  // The line of the largest minimum at an end of the range.
  InterfaceAreas solve_end(const Lambda& lambda);
  // A line below the crossing of two, or none.
  std::optional<InterfaceAreas> line_below(const InterfaceAreas& before, const Lambda& crossing);
  // Finds the lines and breakpoints between two lines of the envelope, in ascending order, the
  // first line included.
  void divide(const InterfaceAreas& before, const InterfaceAreas& after);
  // A line that is least at a single lambda has an interval without length.
  void drop_empty_intervals();
  void find_labellings();
  void report(const Lambda& lambda, double from, double to);

  const ParametricProblem& problem_;
  CutSolver& solver_;
  Observer& observer_;
  const FlowWitness& witness_;
  FillPath path_;
};

WideCut EnvelopeSearch::solve(const Lambda& lambda) {
  observer_.check();
  WideCut cut = solve_wide(at_lambda(problem_, lambda), solver_, observer_);
  ++path_.solves;
  path_.digits += cut.digits;
  path_.solved_nodes += static_cast<std::int64_t>(problem_.node_count());
  return cut;
}

void EnvelopeSearch::show(const WideCut& cut, const Lambda& lambda) const {
  if (witness_) witness_(lambda, cut.edge_flow);
}

InterfaceAreas EnvelopeSearch::solve_end(const Lambda& lambda) {
  const WideCut cut = solve(lambda);
  show(cut, lambda);
  return areas_of(problem_, cut.largest_source_side);
}

std::optional<InterfaceAreas> EnvelopeSearch::line_below(const InterfaceAreas& before,
                                                         const Lambda& crossing) {
  const WideCut cut = solve(crossing);
  if (cut.value < cost_at(before, crossing)) return areas_of(problem_, cut.largest_source_side);
  show(cut, crossing);
  return std::nullopt;
}

// Progress, by where lambda stands in the range on a logarithmic scale.
void EnvelopeSearch::report(const Lambda& lambda, double from, double to) {
  const double first = std::log(to_double(path_.first));
  const double last = std::log(to_double(path_.last));
  const double place = (std::log(to_double(lambda)) - first) / (last - first);
  observer_.progress(from + (to - from) * place);
}

void EnvelopeSearch::divide(const InterfaceAreas& before, const InterfaceAreas& after) {
  if (before == after) return;
  const Lambda lambda = crossing(before, after);
  // (Nothing of the size of the problem is kept while both parts are divided in turn.)
  if (const std::optional<InterfaceAreas> below = line_below(before, lambda)) {
    divide(before, *below);
    divide(*below, after);
    return;
  }
  path_.areas.push_back(before);
  path_.breakpoints.push_back(lambda);
  report(lambda, 0, 0.6);
}

void EnvelopeSearch::drop_empty_intervals() {
  std::vector<InterfaceAreas> areas;
  std::vector<Lambda> breakpoints;
  for (std::size_t k = 0; k < path_.areas.size(); ++k) {
    const LambdaInterval interval = interval_of(path_, k);
    if (!(interval.from < interval.to)) continue;
    if (!areas.empty()) breakpoints.push_back(interval.from);
    areas.push_back(path_.areas[k]);
  }
  path_.areas = std::move(areas);
  path_.breakpoints = std::move(breakpoints);
}

// The largest minimum in an open interval is the same throughout: all minima there have one line.
void EnvelopeSearch::find_labellings() {
  for (std::size_t k = 0; k < path_.areas.size(); ++k) {
    const LambdaInterval interval = interval_of(path_, k);
    const WideCut cut = solve(simplest_between(interval.from, interval.to));
    if (!(areas_of(problem_, cut.largest_source_side) == path_.areas[k])) {
      throw std::logic_error("fill path: a minimum within an interval is not that of its ends");
    }
    path_.source_side.emplace_back(cut.largest_source_side.begin(), cut.largest_source_side.end());
    report(interval.to, 0.6, 1);
  }
}

FillPath EnvelopeSearch::run(const Lambda& first, const Lambda& last) {
  path_.first = first;
  path_.last = last;
  path_.nested = false;
  const InterfaceAreas before = solve_end(first);
  const InterfaceAreas after = solve_end(last);
  divide(before, after);
  path_.areas.push_back(after);
  drop_empty_intervals();
  find_labellings();
  return std::move(path_);
}

}  // namespace

FillPath find_envelope(const ParametricProblem& problem, const Lambda& first, const Lambda& last,
                       CutSolver& solver, Observer& observer, const FlowWitness& witness) {
  return EnvelopeSearch(problem, solver, observer, witness).run(first, last);
}

}  // namespace cellocut
