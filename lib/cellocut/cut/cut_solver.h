// The contract of a minimum-cut solver.
//
// A solver delivers a maximum flow, one net value per edge. Everything else that a caller relies on
// is recomputed here from that flow, by code that no solver shares: its feasibility, its value, and
// the two canonical minimum cuts. A minimum cut is not unique; the set of nodes that the source
// reaches in the residual graph is the smallest source side of all minimum cuts, the complement of
// the set that reaches the sink is the largest (Picard and Queyranne 1980; Ford and Fulkerson
// 1962), and both are the same for every maximum flow, so exact solvers agree bit for bit.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/base/stopwatch.h"
#include "cellocut/cut/cut_problem.h"

namespace cellocut {

enum class CutStatus {
  optimal,  // value == lower_bound, the flow proves it
  invalid   // the flow that the solver returned breaks a capacity or a balance: a defect of the
            // solver
};
const char* to_string(CutStatus status);

struct SolverInfo {
  std::string name;
  std::string summary;    // one line for `cellocut list`
  std::string licence;    // SPDX, of the solver with what it links
  std::string reference;  // what to cite
  bool exact = true;      // delivers a maximum flow
  bool outside = false;   // somebody else's code, an outside witness and never a default
  std::int64_t capacity_limit = kCapacityLimit;  // refuses problems whose capacity sum is not below
};

struct SolveOptions {
  Observer* observer = nullptr;  // polled for cancellation; may be null
};

struct CutResult {
  CutStatus status = CutStatus::invalid;
  std::string message;                  // why the status is `invalid`; empty otherwise
  std::int64_t value = 0;               // cost of both labellings, problem.constant included
  std::int64_t lower_bound = 0;         // value of the flow, problem.constant included
  CutLabels smallest_source_side;       // of all minimum cuts, the one with the fewest source nodes
  CutLabels largest_source_side;        // of all minimum cuts, the one with the most
  std::vector<std::int64_t> edge_flow;  // per edge, net flow from `from` to `to`
  std::vector<std::pair<std::string, std::int64_t>> counters;  // algorithm-specific
  double build_seconds = 0;   // from the problem to the solver's own arrays
  double solve_seconds = 0;   // the search, up to and including the flow
  double verify_seconds = 0;  // feasibility, value and canonical cuts, done by the caller
  std::int64_t bytes = 0;     // size of the solver's own arrays, 0 where it does not tell
};

// What do_solve fills in.
struct SolverOutput {
  std::vector<std::int64_t> edge_flow;
  std::vector<std::pair<std::string, std::int64_t>> counters;
  std::int64_t bytes = 0;
};

// Handed to do_solve: marks the end of the build phase and carries cancellation.
class SolveContext {
 public:
  explicit SolveContext(const SolveOptions& options) : observer_(options.observer) {}
  // To be called once, when the solver's own arrays stand and the search begins.
  void built();
  // Throws Cancelled when the caller wants to stop. Cheap enough for every few thousand steps.
  void check() const {
    if (observer_ != nullptr) observer_->check();
  }
  [[nodiscard]] double built_at() const { return built_at_; }

 private:
  Observer* observer_;
  Stopwatch clock_;
  double built_at_ = -1;
};

class CutSolver {
 public:
  virtual ~CutSolver() = default;
  [[nodiscard]] virtual const SolverInfo& info() const = 0;

  // Validates the problem, solves and times it, and recomputes what the solver claims.
  // Errors: InputError as CutProblem::validate; LimitError where the sum of capacities exceeds what
  // this solver can represent; Cancelled.
  [[nodiscard]] CutResult solve(const CutProblem& problem, const SolveOptions& options = {});

 private:
  // Preconditions: problem.validate() holds, the sum of capacities is below info().capacity_limit.
  // Returns a maximum flow: per edge the net flow from `from` to `to`.
  virtual SolverOutput do_solve(const CutProblem& problem, SolveContext& context) = 0;
};

// The flow into node i from the source and out of it to the sink that go with a balance
// `out` = (net flow out of i along edges): as much as the terminal arcs let through.
struct TerminalFlow {
  std::int64_t from_source = 0;
  std::int64_t to_sink = 0;
};
// Precondition: -to_sink <= out <= to_source (else the flow is not feasible).
TerminalFlow terminal_flow(std::int64_t to_source, std::int64_t to_sink, std::int64_t out);

// Net flow out of every node along its edges.
std::vector<std::int64_t> node_balances(const CutProblem& problem,
                                        const std::vector<std::int64_t>& edge_flow);

}  // namespace cellocut
