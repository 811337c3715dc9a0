// lp: the linear relaxation of the minimum cut by a primal-dual hybrid gradient method.
//
// Definition. A labelling is a point x in {0, 1}^n; letting x be anything in [0, 1] gives
//     min over x in [0,1]^n of  constant + sum to_source_i (1 - x_i) + sum to_sink_i x_i
//                               + sum capacity_e (x_from - x_to)+ + reverse_e (x_to - x_from)+ ,
// whose value is that of the minimum cut (the matrix is totally unimodular): every threshold of an
// optimal x is a minimum cut. Its dual is a flow y within the capacities that need not balance,
// worth sum min(to_source_i, to_sink_i + net flow out of i). The method alternates steps
//     y <- clip(y + sigma_e (xbar_from - xbar_to)),  x <- clip(x - tau_i (t_i + net outflow)),
// with xbar = 2 x_new - x_old, in the manner of PDLP:
//   preconditioning  sigma_e = step * weight * c_e / 2, tau_i = step / (weight * sum of c_e at i),
//                    c_e the larger capacity: with step = 1 the method converges (Pock, Chambolle),
//   step size        as long as the movement of the last sampled iteration allows,
//   restarts         from the average of the sampled iterations or from where it is, whichever has
//   the
//                    smaller gap, where that has fallen far, or has fallen and rises, or at length,
//   primal weight    after each restart moved towards the ratio of the ways of y and x.
//
// Proof. At times x is rounded at its best threshold, exactly in integers, and y is rounded to
// integers and repaired for that labelling (lp/rounding.h). Both claims are recomputed by
// cut_solver.cpp. It stops at a proof, at a stated gap, at a limit of time or of iterations.
// Then, unless it is told not to, the dual flow is completed to a maximum flow by bk
// (lp/crossover.h); what that added to the value is the counter `crossover_added`, 0 after a proof.
//
// Files. lp/reordering: neighbours close together. lp/operator: arrays, iteration, restart.
// lp/rounding: threshold and repair. lp/crossover: to a maximum flow.
//
// Invariants. (1) x and y are feasible after every step, so every gap that is measured is one. (2)
// value_ >= minimum cut >= lower_bound_, and value_ never rises, lower_bound_ never falls. (3) All
// but the time limit is the same bit for bit for any number of threads.
//
// Complexity. O(n + m) per iteration, all cores; the gap of a linear program falls linearly with
// restarts at a rate that depends on the instance, and no bound in n and m is known. Where an
// iteration in 32-bit floats can no longer tell, the repair must finish; with very unlike
// capacities it may not, and the iteration limit stops it.
//
// References.
//   D. Applegate et al.: Practical large-scale linear programming using primal-dual hybrid
//   gradient. NeurIPS 2021 (PDLP). D. Applegate, O. Hinder, H. Lu, M. Lubin: Faster first-order
//   primal-dual methods for linear programming using restarts and sharpness. Mathematical
//   Programming 201, 2023. A. Chambolle, T. Pock: A first-order primal-dual algorithm for convex
//   problems with applications to imaging. JMIV 40(1), 2011. T. Pock, A. Chambolle: Diagonal
//   preconditioning for first order primal-dual algorithms in convex optimization. ICCV 2011.
//
// Licence: GPL-3.0-or-later, this project's own code, with Eigen (MPL-2.0) and TBB (Apache-2.0).
// Capabilities: a relaxation; exact with crossover; every valid problem, all cores, can be
// cancelled.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "solvers/lp/crossover.h"
#include "solvers/lp/operator.h"
#include "solvers/lp/reordering.h"
#include "solvers/lp/rounding.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

// The point that the iteration is at, with the best labelling and the best bound so far.
class Relaxation {
 public:
  Relaxation(const CutProblem& problem, const SolveContext& context);
  void run();
  [[nodiscard]] SolverOutput output();

 private:
  static constexpr std::int64_t kSampleInterval = 8;
  static constexpr std::int64_t kCheckInterval = 64;

  void adapt_step(const lp::Movement& movement);
  void consider_restart();
  void restart(bool from_average);
  void round(bool last);
  [[nodiscard]] bool should_stop();

  lp::Reordering order_;
  const CutProblem& problem_;  // reordered, as all that follows
  const SolveContext& context_;
  const RelaxationOptions& options_;
  ResidualGraph graph_;
  lp::Operator operator_;
  lp::Steps steps_;
  std::int64_t iteration_ = 0;
  std::int64_t last_rounding_ = 0;
  std::int64_t next_rounding_ = kCheckInterval / 2;

  std::int64_t restarted_at_ = 0;
  double gap_at_restart_ = std::numeric_limits<double>::infinity();
  double last_candidate_ = std::numeric_limits<double>::infinity();

  std::vector<float> relaxed_;
  CutLabels labels_;
  std::int64_t value_ = std::numeric_limits<std::int64_t>::max();
  lp::IntegerFlow flow_;
  std::int64_t lower_bound_ = std::numeric_limits<std::int64_t>::min();
  std::string stop_;

  std::int64_t restarts_ = 0;
  std::int64_t roundings_ = 0;
  lp::RepairCounts repairs_;
};

Relaxation::Relaxation(const CutProblem& problem, const SolveContext& context)
    : order_(lp::reorder(problem)),
      problem_(order_.problem),
      context_(context),
      options_(context.relaxation()),
      graph_(problem_),
      operator_(graph_),
      relaxed_(graph_.node_count()) {
  constexpr float kFirstWeight = 0.3F;
  steps_.weight = kFirstWeight;
}

// PDLP's rule, from every sampled iteration: the step may be as long as its own movement allows,
// and approaches that the more slowly the longer the iteration lasts.
void Relaxation::adapt_step(const lp::Movement& movement) {
  if (!(std::abs(movement.cross) > 0)) return;
  const double weight = steps_.weight;
  const double limit =
      0.5 * (weight * movement.primal + movement.dual / weight) / std::abs(movement.cross);
  const std::int64_t sample = iteration_ / kSampleInterval + 1;
  const auto samples = static_cast<double>(sample);
  const double step =
      std::min((1 - std::pow(samples, -0.3)) * limit, (1 + std::pow(samples, -0.6)) * steps_.step);
  steps_.step = static_cast<float>(std::clamp(step, 1.0, 4.0));
}

void Relaxation::consider_restart() {
  const double here = operator_.gap().size();
  const double average = operator_.average_gap().size();
  const double candidate = std::min(here, average);
  const std::int64_t length = iteration_ - restarted_at_;
  const bool enough = candidate <= 0.2 * gap_at_restart_;
  const bool stalls = candidate <= 0.8 * gap_at_restart_ && candidate > last_candidate_;
  const bool too_long = 10 * length >= 4 * iteration_ && iteration_ > 2 * kCheckInterval;
  last_candidate_ = candidate;
  if (!enough && !stalls && !too_long) return;
  restart(average < here);
  gap_at_restart_ = candidate;
}

void Relaxation::restart(bool from_average) {
  const lp::Movement moved = operator_.restart(from_average);
  // The primal weight follows the ratio of the ways that both went since the last restart.
  if (moved.primal > 0 && moved.dual > 0) {
    const double ratio = std::sqrt(moved.dual / moved.primal);
    const double weight = std::exp(0.5 * std::log(ratio) + 0.5 * std::log(steps_.weight));
    steps_.weight = static_cast<float>(std::clamp(weight, 0.02, 20.0));
  }
  restarted_at_ = iteration_;
  last_candidate_ = std::numeric_limits<double>::infinity();
  ++restarts_;
}

void Relaxation::round(bool last) {
  ++roundings_;
  // The repair may take about as long as the iterations since the last one: a step of it costs as
  // much as several of theirs.
  constexpr std::int64_t kRepairCost = 12;
  const std::int64_t arcs = static_cast<std::int64_t>(graph_.arcs.size() + relaxed_.size());
  std::int64_t effort = (iteration_ - last_rounding_) * arcs / kRepairCost;
  last_rounding_ = iteration_;
  for (std::uint32_t i = 0; i < relaxed_.size(); ++i) relaxed_[i] = operator_.value(i);
  CutLabels labels;
  std::int64_t value = 0;
  lp::round_at_best_threshold(problem_, graph_, relaxed_, labels, value);
  if (value < value_) {
    value_ = value;
    labels_ = std::move(labels);
  }
  // Far from the end a repair has too much to move to be worth its while.
  constexpr double kNear = 0.03;
  const lp::Gap gap = operator_.gap();
  const double size = std::abs(gap.dual) + std::abs(gap.primal);
  if (gap.size() > kNear * size && !last) effort = 0;
  lp::IntegerFlow flow = lp::rounded_flow(graph_, operator_);
  const std::int64_t bound = value_ - lp::repair(graph_, flow, labels_, effort, repairs_);
  if (bound > lower_bound_) {
    lower_bound_ = bound;
    flow_ = std::move(flow);
  }
}

bool Relaxation::should_stop() {
  if (value_ == lower_bound_) {
    stop_ = "proof";
  } else if (options_.relative_gap > 0 && lower_bound_ > std::numeric_limits<std::int64_t>::min() &&
             static_cast<double>(value_) - static_cast<double>(lower_bound_) <=
                 options_.relative_gap * static_cast<double>(value_)) {
    stop_ = "gap";
  } else if (options_.seconds_limit > 0 && context_.seconds() > options_.seconds_limit) {
    stop_ = "time limit";
  } else if (iteration_ >= options_.iteration_limit) {
    stop_ = "iteration limit";
  }
  return !stop_.empty();
}

void Relaxation::run() {
  while (true) {
    ++iteration_;
    if (iteration_ % kSampleInterval == 0) {
      adapt_step(operator_.iterate_sampled(steps_));
    } else {
      operator_.iterate(steps_);
    }
    if (iteration_ % (kCheckInterval / 2) != 0 && iteration_ < options_.iteration_limit) continue;
    context_.check();
    const bool last = iteration_ >= options_.iteration_limit ||
                      (options_.seconds_limit > 0 && context_.seconds() > options_.seconds_limit);
    if (iteration_ >= next_rounding_ || last) {
      round(last);
      next_rounding_ = iteration_ + std::max(kCheckInterval, iteration_ / 5);
      if (should_stop()) return;
    }
    if (iteration_ % kCheckInterval == 0) consider_restart();
  }
}

SolverOutput Relaxation::output() {
  SolverOutput output;
  const auto fractional =
      std::count_if(relaxed_.begin(), relaxed_.end(), [](float x) { return x > 0 && x < 1; });
  output.counters = {{"iterations", iteration_},
                     {"restarts", restarts_},
                     {"roundings", roundings_},
                     {"repair_sweeps", repairs_.sweeps},
                     {"repair_pushes", repairs_.pushes},
                     {"fractional", fractional},
                     {"lp_value", value_},
                     {"lp_lower_bound", lower_bound_}};
  output.bytes = graph_.bytes() + operator_.bytes() +
                 static_cast<std::int64_t>((flow_.residual.size() + flow_.surplus.size()) *
                                           sizeof(std::int64_t));
  RelaxedOutput& relaxed = output.relaxed.emplace();
  relaxed.relaxed.resize(relaxed_.size());
  for (std::size_t i = 0; i < relaxed_.size(); ++i) relaxed.relaxed[order_.node[i]] = relaxed_[i];
  relaxed.stop = stop_;
  if (options_.crossover) {
    lp::Crossover crossover = lp::complete_flow(problem_, graph_, std::move(flow_), context_);
    output.edge_flow.resize(problem_.edges.size());
    for (std::size_t e = 0; e < crossover.edge_flow.size(); ++e) {
      output.edge_flow[order_.edge[e]] = crossover.edge_flow[e];
    }
    output.counters.push_back({"crossover_added", crossover.added_value});
    output.counters.push_back({"crossover_returned", crossover.returned});
    return output;
  }
  relaxed.value = value_;
  relaxed.lower_bound = lower_bound_;
  relaxed.labels.resize(labels_.size());
  for (std::size_t i = 0; i < labels_.size(); ++i) relaxed.labels[order_.node[i]] = labels_[i];
  relaxed.dual_flow.resize(problem_.edges.size());
  for (std::size_t e = 0; e < relaxed.dual_flow.size(); ++e) {
    relaxed.dual_flow[order_.edge[e]] =
        static_cast<DualFlow>(graph_.residual[2 * e] - flow_.residual[2 * e]) *
        (DualFlow{1} << kDualFlowBits);
  }
  return output;
}

class LinearRelaxation final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "lp";
      i.summary = "the linear relaxation by a primal-dual hybrid gradient method, with crossover";
      i.licence = "GPL-3.0-or-later AND MPL-2.0 AND Apache-2.0";
      i.reference = "Applegate et al., NeurIPS 2021 (PDLP); Chambolle and Pock, JMIV 40(1), 2011";
      i.exact = false;
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    Relaxation relaxation(problem, context);
    context.built();
    relaxation.run();
    return relaxation.output();
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_lp();
std::unique_ptr<CutSolver> make_lp() { return std::make_unique<LinearRelaxation>(); }

}  // namespace cellocut::solvers
