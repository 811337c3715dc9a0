#include "cellocut/path/fill_path.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>

#include "cellocut/path/envelope.h"
#include "cellocut/path/piece.h"

namespace cellocut {

namespace {

// What changes in one part of the problem at one lambda.
struct Change {
  Lambda lambda;
  InterfaceAreas before;  // of the largest minimum there, and of the smallest
  InterfaceAreas after;
  std::vector<std::uint32_t> node;  // of the whole problem, on the source side of the largest
  std::vector<std::uint32_t> edge;  // of the part, as in the whole problem, with a flow at lambda
  std::vector<Wide> flow;
};

class PathSearch {
 public:
  PathSearch(CutSolver& solver, Observer& observer) : solver_(solver), observer_(observer) {}

  FillPath run(const ParametricProblem& problem, const Lambda& first, const Lambda& last);

 private:
  WideCut solve(const Piece& piece, const Lambda& lambda);
  // Finds what changes within the open range, in each connected part on its own: parts that no edge
  // joins have paths that know nothing of each other. So have the two halves of a range; whatever
  // is independent is done in parallel, and the changes come in the order of the recursion.
  std::vector<Change> divide(Piece piece, const LambdaInterval& range);
  std::vector<Change> divide_connected(Piece piece, const LambdaInterval& range);
  // Puts the changes in order: those at one lambda are one breakpoint.
  void find_breakpoints(InterfaceAreas areas);

  CutSolver& solver_;  // keeps nothing from one problem to the next
  Observer& observer_;
  FillPath path_;
  std::vector<Change> changes_;
  std::atomic<int> solves_ = 0;
  std::atomic<int> digits_ = 0;
  std::atomic<std::int64_t> solved_nodes_ = 0;
};

void append(std::vector<Change>& changes, std::vector<Change>&& more) {
  changes.insert(changes.end(), std::make_move_iterator(more.begin()),
                 std::make_move_iterator(more.end()));
}

Change change_of(const Piece& piece, const Lambda& lambda, const InterfaceAreas& before,
                 const InterfaceAreas& after, WideCut cut) {
  Change change{lambda, before, after, {}, piece.edge, std::move(cut.edge_flow)};
  for (std::size_t i = 0; i < piece.node.size(); ++i) {
    if (cut.largest_source_side[i] != 0) change.node.push_back(piece.node[i]);
  }
  return change;
}

double ratio(std::int64_t a, std::int64_t b) {
  return static_cast<double>(a) / static_cast<double>(b);
}

void remember_flow(Piece& piece, const WideCut& cut, const Lambda& lambda) {
  piece.flow_at = lambda;
  piece.flow.assign(cut.edge_flow.begin(), cut.edge_flow.end());
}

WideCut PathSearch::solve(const Piece& piece, const Lambda& lambda) {
  // Capacities are q times supported and p times unsupported area. A flow at another lambda obeys
  // them when it is scaled as q is where lambda has grown, and as p is where it has fallen: what
  // the other area adds to a capacity, so scaled, can only have grown.
  const Lambda& at = piece.flow_at;
  const double scale = at < lambda ? ratio(lambda.q, at.q) : ratio(lambda.p, at.p);
  std::vector<double> start = piece.flow;
  for (double& flow : start) flow *= scale;
  WideCut cut = solve_wide(at_lambda(piece.problem, lambda), solver_, observer_, start);
  ++solves_;
  digits_ += cut.digits;
  solved_nodes_ += static_cast<std::int64_t>(piece.problem.node_count());
  return cut;
}

// Where to divide a range: at the crossing, which may be a breakpoint; but first at a simple
// fraction near by, where one digit of capacities does, unless an end of the range is as near.
Lambda divider(const Lambda& crossing, const LambdaInterval& range) {
  constexpr double kNear = 1.0 / 32;
  constexpr double kUnit = 0x1p20;
  const double middle = to_double(crossing);
  if (middle < 0x1p-10 || middle > 0x1p20) return crossing;
  const auto in_units = [](double x) {
    return Lambda{static_cast<std::int64_t>(x * kUnit), static_cast<std::int64_t>(kUnit)};
  };
  const Lambda low = in_units((1 - kNear) * middle);
  const Lambda high = in_units((1 + kNear) * middle);
  return range.from < low && high < range.to ? simplest_between(low, high) : crossing;
}

std::vector<Change> PathSearch::divide_connected(Piece piece, const LambdaInterval& range) {
  const ParametricProblem& problem = piece.problem;
  const InterfaceAreas before = areas_of(problem, piece.before);
  const InterfaceAreas after = areas_of(problem, piece.after);
  if (before == after) return {};
  const Lambda both = crossing(before, after);
  if (problem.node_count() == 1) {
    // Nothing to solve: at the crossing both sides cost the same.
    return {{both, before, after, piece.node, {}, {}}};
  }
  const Lambda lambda = divider(both, range);
  WideCut cut = solve(piece, lambda);
  if (lambda == both && cut.value == cost_at(before, lambda)) {
    return {change_of(piece, lambda, before, after, std::move(cut))};
  }
  remember_flow(piece, cut, lambda);
  const CutLabels none(problem.node_count(), 0);
  const CutLabels all(problem.node_count(), 1);
  const CutLabels& smallest = cut.smallest_source_side;
  const CutLabels& largest = cut.largest_source_side;
  std::vector<Change> changes;
  std::vector<Change> later;
  tbb::parallel_invoke(
      [&] {
        changes =
            divide(contract(piece, smallest, all, piece.before, largest), {range.from, lambda});
      },
      [&] {
        later = divide(contract(piece, none, largest, smallest, piece.after), {lambda, range.to});
      });
  append(changes, std::move(later));
  const InterfaceAreas most = areas_of(problem, largest);
  const InterfaceAreas least = areas_of(problem, smallest);
  if (!(most == least)) {
    changes.push_back(change_of(piece, lambda, most, least, std::move(cut)));
  }
  return changes;
}

std::vector<Change> PathSearch::divide(Piece piece, const LambdaInterval& range) {
  std::vector<Piece> parts = connected_parts(std::move(piece));
  std::vector<std::vector<Change>> of_part(parts.size());
  tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
    of_part[i] = divide_connected(std::move(parts[i]), range);
  });
  std::vector<Change> changes;
  for (std::vector<Change>& some : of_part) append(changes, std::move(some));
  return changes;
}

void PathSearch::find_breakpoints(InterfaceAreas areas) {
  std::stable_sort(changes_.begin(), changes_.end(),
                   [](const Change& a, const Change& b) { return a.lambda < b.lambda; });
  path_.areas.push_back(areas);
  for (const Change& change : changes_) {
    const bool another = path_.breakpoints.empty() || path_.breakpoints.back() < change.lambda;
    if (another) {
      path_.breakpoints.push_back(change.lambda);
      path_.areas.push_back(path_.areas.back());
    }
    InterfaceAreas& next = path_.areas.back();
    next.supported += change.after.supported - change.before.supported;
    next.unsupported += change.after.unsupported - change.before.unsupported;
    // Changes come in the order of lambda, so the last one that a node is in is its own.
    const auto level = static_cast<std::uint32_t>(path_.breakpoints.size());
    for (const std::uint32_t i : change.node) path_.level[i] = level;
  }
}

FillPath PathSearch::run(const ParametricProblem& problem, const Lambda& first,
                         const Lambda& last) {
  path_.first = first;
  path_.last = last;
  Piece whole{problem,
              std::vector<std::uint32_t>(problem.node_count()),
              std::vector<std::uint32_t>(problem.edges.size()),
              {},
              {},
              {},
              {}};
  std::iota(whole.node.begin(), whole.node.end(), 0U);
  std::iota(whole.edge.begin(), whole.edge.end(), 0U);
  WideCut begin;
  WideCut end;
  tbb::parallel_invoke([&] { begin = solve(whole, first); }, [&] { end = solve(whole, last); });
  const InterfaceAreas most = areas_of(problem, begin.smallest_source_side);
  const InterfaceAreas least = areas_of(problem, end.largest_source_side);
  // What comes next is near where the lines of both cross.
  const bool near_begin = !(most == least) && to_double(crossing(most, least)) <
                                                  std::sqrt(to_double(first) * to_double(last));
  if (near_begin) {
    remember_flow(whole, begin, first);
  } else {
    remember_flow(whole, end, last);
  }
  changes_ = divide(contract(whole, end.smallest_source_side, begin.largest_source_side,
                             begin.smallest_source_side, end.largest_source_side),
                    {first, last});
  path_.solves = solves_;
  path_.digits = digits_;
  path_.solved_nodes = solved_nodes_;
  path_.level.assign(problem.node_count(), 0);
  find_breakpoints(most);
  if (!(path_.areas.back() == least)) {
    throw std::logic_error("fill path: what changes is not what lies between the ends");
  }
  const auto count = static_cast<std::uint32_t>(path_.areas.size());
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
  std::uint32_t level = 0;
  for (const Change& change : changes_) {
    if (level == 0 || path_.breakpoints[level - 1] < change.lambda) ++level;
    for (std::size_t n = 0; n < change.edge.size(); ++n) {
      const std::uint32_t e = change.edge[n];
      if (level_of(e) == level) path_.zone_flow[e] = change.flow[n];
    }
  }
  return std::move(path_);
}

}  // namespace

FillPath find_fill_path(const ParametricProblem& problem, const Lambda& first, const Lambda& last,
                        CutSolver& solver, Observer& observer, const FlowWitness& witness) {
  if (problem.nested()) return PathSearch(solver, observer).run(problem, first, last);
  return find_envelope(problem, first, last, solver, observer, witness);
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
