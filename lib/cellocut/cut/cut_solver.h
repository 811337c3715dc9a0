// The contract of a minimum-cut solver.
//
// A solver delivers a maximum flow, one net value per edge. Everything else that a caller relies on
// is recomputed here from that flow, by code that no solver shares: its feasibility, its value, and
// the two canonical minimum cuts. A minimum cut is not unique; the set of nodes that the source
// reaches in the residual graph is the smallest source side of all minimum cuts, the complement of
// the set that reaches the sink is the largest (Picard and Queyranne 1980; Ford and Fulkerson
// 1962), and both are the same for every maximum flow, so exact solvers agree bit for bit.
//
// A relaxation delivers a labelling and a dual flow instead: one value per edge within its
// capacities, that need not balance. By weak duality no labelling costs less than
//     constant + sum over nodes i of min(to_source[i], to_sink[i] + net flow out of i),
// which is evaluated here in 128-bit integers from flows in multiples of 2^-24 and rounded up.
// Where that bound meets the cost of the labelling, the labelling is proved to be a minimum cut,
// one of possibly many; where it does not, both are what is known (status `gap`).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/base/stopwatch.h"
#include "cellocut/cut/cut_problem.h"

namespace cellocut {

enum class CutStatus {
  optimal,  // value == lower_bound, the flow or the dual flow proves it
  gap,      // of a relaxation: lower_bound <= value of a minimum cut <= value, and they differ
  invalid   // what the solver returned breaks a capacity or a balance, or does not add up to what
            // it claims: a defect of the solver
};
const char* to_string(CutStatus status);

struct SolverInfo {
  std::string name;
  std::string summary;    // one line for `cellocut list`
  std::string licence;    // SPDX, of the solver with what it links
  std::string reference;  // what to cite
  bool exact = true;      // delivers a maximum flow; false: a relaxation
  bool outside = false;   // somebody else's code, an outside witness and never a default
  std::int64_t capacity_limit = kCapacityLimit;  // refuses problems whose capacity sum is not below
};

// When a relaxation stops; exact solvers take no notice.
struct RelaxationOptions {
  double relative_gap = 0;   // stops at (value - lower_bound) <= this * value; 0: at a proof only
  double seconds_limit = 0;  // stops the iteration after so long; 0: never
  std::int64_t iteration_limit = 50000;
  bool crossover = true;  // complete the dual flow to a maximum flow, so that the result is exact

  // Throws UsageError that names what is wrong.
  void validate() const;
};

struct SolveOptions {
  Observer* observer = nullptr;  // polled for cancellation; may be null
  RelaxationOptions relaxation{};
  // Reduce the problem exactly before the search (reduction.h); what that removed is among the
  // counters, its time counts as building. A relaxation without crossover takes no notice.
  bool reduce = false;
  // A net flow per edge to begin with, such as a maximum flow of a problem much like this one. It
  // need not balance, and what exceeds a capacity is cut off. It changes the time and which of the
  // maximum flows is returned, nothing else; solvers that have no use for it take no notice, nor
  // does a reduced problem. May be null; must outlive the call.
  const std::vector<std::int64_t>* start = nullptr;
};

struct CutResult {
  CutStatus status = CutStatus::invalid;
  std::string message;  // why the status is `invalid`; empty otherwise
  // Whether edge_flow is a maximum flow and both labellings are the canonical ones. False for a
  // relaxation without crossover: edge_flow is empty and both labellings are the one that it
  // rounded to, which is a minimum cut where the status is `optimal`.
  bool canonical = false;
  std::int64_t value = 0;               // cost of both labellings, problem.constant included
  std::int64_t lower_bound = 0;         // proved by the flow, problem.constant included
  CutLabels smallest_source_side;       // of all minimum cuts, the one with the fewest source nodes
  CutLabels largest_source_side;        // of all minimum cuts, the one with the most
  std::vector<std::int64_t> edge_flow;  // per edge, net flow from `from` to `to`
  std::vector<float> relaxed;  // of a relaxation: its variable per node, 0 (sink) to 1 (source)
  std::string stop;            // of a relaxation: "proof", "gap", "time limit", "iteration limit"
  std::vector<std::pair<std::string, std::int64_t>> counters;  // algorithm-specific
  double build_seconds = 0;   // from the problem to the solver's own arrays
  double solve_seconds = 0;   // the search, up to and including the flow
  double verify_seconds = 0;  // feasibility, value and canonical cuts, done by the caller
  std::int64_t bytes = 0;     // size of the solver's own arrays, 0 where it does not tell
};

__extension__ using DualFlow = __int128;  // in multiples of 2^-kDualFlowBits
inline constexpr int kDualFlowBits = 24;

// What a relaxation fills in. With an edge_flow beside it (after a crossover) only `relaxed` and
// `stop` count.
struct RelaxedOutput {
  CutLabels labels;                 // one per node
  std::vector<DualFlow> dual_flow;  // one per edge, from `from` to `to`, within its capacities
  std::int64_t value = 0;           // what the solver takes for the cost of the labels
  std::int64_t lower_bound = 0;     // and for the bound of the dual flow: both are recomputed
  std::vector<float> relaxed;       // one per node, in [0, 1]
  std::string stop;
};

// What do_solve fills in.
struct SolverOutput {
  std::vector<std::int64_t> edge_flow;
  std::vector<std::pair<std::string, std::int64_t>> counters;
  std::int64_t bytes = 0;
  std::optional<RelaxedOutput> relaxed = std::nullopt;
};

// Handed to do_solve: marks the end of the build phase and carries cancellation.
class SolveContext {
 public:
  explicit SolveContext(const SolveOptions& options)
      : observer_(options.observer),
        relaxation_(options.relaxation),
        start_(options.reduce ? nullptr : options.start) {}
  // To be called once, when the solver's own arrays stand and the search begins.
  void built();
  // Throws Cancelled when the caller wants to stop. Cheap enough for every few thousand steps.
  void check() const {
    if (observer_ != nullptr) observer_->check();
  }
  [[nodiscard]] double built_at() const { return built_at_; }
  // Since the solver was called.
  [[nodiscard]] double seconds() const { return clock_.seconds(); }
  [[nodiscard]] Observer* observer() const { return observer_; }
  [[nodiscard]] const RelaxationOptions& relaxation() const { return relaxation_; }
  // One flow per edge, or null.
  [[nodiscard]] const std::vector<std::int64_t>* start() const { return start_; }

 private:
  Observer* observer_;
  RelaxationOptions relaxation_;
  const std::vector<std::int64_t>* start_;
  Stopwatch clock_;
  double built_at_ = -1;
};

class CutSolver {
 public:
  virtual ~CutSolver() = default;
  [[nodiscard]] virtual const SolverInfo& info() const = 0;

  // Validates the problem, solves and times it, and recomputes what the solver claims. Keeps
  // nothing for the next problem, and several threads may call it at once.
  // Errors: InputError as CutProblem::validate; UsageError as RelaxationOptions::validate, and for
  // a start with another number of edges;
  // LimitError where the sum of capacities exceeds what this solver can represent; Cancelled.
  [[nodiscard]] CutResult solve(const CutProblem& problem, const SolveOptions& options = {});

 private:
  // Preconditions: problem.validate() holds, the sum of capacities is below info().capacity_limit.
  // Returns a maximum flow: per edge the net flow from `from` to `to`; or, of a relaxation without
  // crossover, no flow and `relaxed`.
  virtual SolverOutput do_solve(const CutProblem& problem, SolveContext& context) = 0;
  SolverOutput solve_reduced(const CutProblem& problem, SolveContext& context);
};

// The flow into node i from the source and out of it to the sink that go with a balance
// `out` = (net flow out of i along edges): as much as the terminal arcs let through.
struct TerminalFlow {
  std::int64_t from_source = 0;
  std::int64_t to_sink = 0;
};
// Precondition: -to_sink <= out <= to_source (else the flow is not feasible).
TerminalFlow terminal_flow(std::int64_t to_source, std::int64_t to_sink, std::int64_t out);

// The lower bound that a dual flow within the capacities proves, constant included, rounded up.
// Preconditions: problem.validate() holds, one flow per edge, each within its capacities.
std::int64_t dual_bound(const CutProblem& problem, const std::vector<DualFlow>& dual_flow);

// Net flow out of every node along its edges.
std::vector<std::int64_t> node_balances(const CutProblem& problem,
                                        const std::vector<std::int64_t>& edge_flow);

}  // namespace cellocut
