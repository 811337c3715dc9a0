// Several solvers on one problem: times over repeats, and whether they agree.
#pragma once

#include <string>
#include <vector>

#include "cellocut/cut/cut_solver.h"

namespace cellocut::solvers {

struct SolverRun {
  SolverInfo info;
  std::string refused;  // why there is no result: a limit of the solver or of time; else empty
  CutResult result;     // of the first repeat
  std::vector<double> build_seconds;  // one per repeat
  std::vector<double> solve_seconds;
  std::vector<double> verify_seconds;
};

struct ComparisonOptions {
  std::vector<std::string> solvers;  // names from the table, in the order of the rows
  int repeats = 1;                   // 1 to 1000
  // A solver that takes longer for one solve is given up (where it can be cancelled); 0: never.
  double seconds_limit = 0;
  RelaxationOptions relaxation{};
  bool reduce = false;  // as in SolveOptions
  Observer* observer = nullptr;
};

// The repeats go round: every solver once, then every solver again, so that a machine that slows
// down slows all of them. Reading a problem is outside all times.
// Errors: UsageError for a name that is not built; InputError as CutProblem::validate; Cancelled.
std::vector<SolverRun> compare_solvers(const CutProblem& problem, const ComparisonOptions& options);

// Results with a flow must have the same value and both the same canonical labellings, and every
// result must be proved. A relaxation without a flow must agree with them: where it claims a proof,
// its value is theirs and its labelling lies between the canonical ones; where it leaves a gap, its
// bound and its value enclose theirs. What is wrong, naming the solver; empty where nothing is.
std::string find_disagreement(const std::vector<SolverRun>& runs);

// Of an odd number of values the middle one, of an even number the mean of the two. Precondition:
// not empty.
double median(std::vector<double> values);

}  // namespace cellocut::solvers
