#include "solvers/comparison.h"

#include <algorithm>

#include "cellocut/base/errors.h"
#include "cellocut/base/stopwatch.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

// Passes cancellation on and adds a deadline.
class Deadline final : public Observer {
 public:
  Deadline(Observer* outer, double seconds) : outer_(outer), seconds_(seconds) {}
  [[nodiscard]] bool cancelled() const override {
    return (outer_ != nullptr && outer_->cancelled()) || passed();
  }
  [[nodiscard]] bool passed() const { return seconds_ > 0 && clock_.seconds() > seconds_; }

 private:
  Observer* outer_;
  double seconds_;
  Stopwatch clock_;
};

void solve_once(CutSolver& solver, const CutProblem& problem, const ComparisonOptions& options,
                SolverRun& run) {
  Deadline deadline(options.observer, options.seconds_limit);
  try {
    CutResult result = solver.solve(problem, SolveOptions{.observer = &deadline,
                                                          .relaxation = options.relaxation,
                                                          .reduce = options.reduce});
    run.build_seconds.push_back(result.build_seconds);
    run.solve_seconds.push_back(result.solve_seconds);
    run.verify_seconds.push_back(result.verify_seconds);
    if (run.build_seconds.size() == 1) run.result = std::move(result);
  } catch (const LimitError& error) {
    run.refused = error.what();
  } catch (const Cancelled&) {
    if (options.observer != nullptr) options.observer->check();
    run.refused = "over the time limit";
  }
}

// Every minimum cut holds the smallest source side and is held by the largest.
bool lies_between(const CutLabels& labels, const CutResult& exact) {
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < exact.smallest_source_side[i] || labels[i] > exact.largest_source_side[i]) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<SolverRun> compare_solvers(const CutProblem& problem,
                                       const ComparisonOptions& options) {
  if (options.repeats < 1 || options.repeats > 1000) {
    throw UsageError("repeats: give a number from 1 to 1000");
  }
  // Written so that a NaN fails.
  if (!(options.seconds_limit >= 0)) throw UsageError("time limit: give seconds, 0 for none");
  problem.validate();
  std::vector<std::unique_ptr<CutSolver>> solvers;
  std::vector<SolverRun> runs;
  for (const std::string& name : options.solvers) {
    solvers.push_back(make(name));
    runs.emplace_back().info = solvers.back()->info();
  }
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (std::size_t s = 0; s < runs.size(); ++s) {
      if (options.observer != nullptr) options.observer->check();
      if (runs[s].refused.empty()) solve_once(*solvers[s], problem, options, runs[s]);
    }
  }
  return runs;
}

std::string find_disagreement(const std::vector<SolverRun>& runs) {
  const auto wrong = [](const SolverRun& run, const std::string& what) {
    return "solver '" + run.info.name + "': " + what;
  };
  const SolverRun* first = nullptr;
  for (const SolverRun& run : runs) {
    if (!run.refused.empty()) continue;
    if (run.result.status == CutStatus::invalid) return wrong(run, run.result.message);
    if (!run.result.canonical) {
      if (run.info.exact) return wrong(run, "no maximum flow");
      continue;
    }
    if (first == nullptr) {
      first = &run;
      continue;
    }
    if (run.result.value != first->result.value) {
      return wrong(run, "value " + std::to_string(run.result.value) + ", but '" + first->info.name +
                            "' has " + std::to_string(first->result.value));
    }
    if (run.result.smallest_source_side != first->result.smallest_source_side ||
        run.result.largest_source_side != first->result.largest_source_side) {
      return wrong(run, "other canonical labellings than '" + first->info.name + "'");
    }
  }
  for (const SolverRun& run : runs) {
    if (!run.refused.empty() || run.result.canonical) continue;
    // Without an exact result the relaxations are held against each other.
    for (const SolverRun& other : runs) {
      if (!other.refused.empty() || run.result.lower_bound <= other.result.value) continue;
      return wrong(run, "lower bound " + std::to_string(run.result.lower_bound) + ", but '" +
                            other.info.name + "' has a cut of " +
                            std::to_string(other.result.value));
    }
    if (first == nullptr) continue;
    if (run.result.value < first->result.value ||
        (run.result.status == CutStatus::optimal && run.result.value != first->result.value)) {
      return wrong(run, "value " + std::to_string(run.result.value) + ", but '" + first->info.name +
                            "' has " + std::to_string(first->result.value));
    }
    if (run.result.status == CutStatus::optimal &&
        !lies_between(run.result.largest_source_side, first->result)) {
      return wrong(run, "a labelling outside of the canonical ones of '" + first->info.name + "'");
    }
  }
  return {};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace cellocut::solvers
