#include "cellocut/surface/normal_moves.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cellocut {

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::SparseMatrix<double>;
using Factors = Eigen::SimplicialLLT<Matrix>;

constexpr int kSmoothingSteps = 30;  // waves of up to some 8 steps, between which nodes cannot see
// Of the largest entry: a node at the border of what follows it may hardly be felt.
constexpr double kRegularisation = 1e-10;

RowMatrix bending_jacobian(const LaplaceRows& rows, std::uint32_t movable) {
  RowMatrix jacobian(rows.rows(), movable);
  jacobian.reserve(static_cast<Eigen::Index>(rows.column.size() + movable));
  for (std::uint32_t i = 0; i < rows.rows(); ++i) {
    const double root = std::sqrt(rows.area[i]);
    double own = 0;
    for (std::uint32_t k = rows.first[i]; k < rows.first[i + 1]; ++k) own -= rows.weight[k];
    bool own_is_in = i >= movable;
    const auto insert_own = [&] {
      jacobian.insertBack(i, i) = root * own;
      own_is_in = true;
    };
    jacobian.startVec(i);
    for (std::uint32_t k = rows.first[i]; k < rows.first[i + 1]; ++k) {
      const std::uint32_t j = rows.column[k];
      if (!own_is_in && j > i) insert_own();
      if (j < movable) jacobian.insertBack(i, j) = root * rows.weight[k];
    }
    if (!own_is_in) insert_own();
  }
  jacobian.finalize();
  return jacobian;
}

// weight (offset + slope u) is quadratic up to `most`, linear beyond.
struct RobustTerms {
  RowMatrix slope;  // by the unknowns of the basis
  std::vector<double> offset;
  std::vector<double> most;

  RobustTerms(const NormalProblem& problem, const RowMatrix& basis, const Vector& moves) {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < problem.data.size(); ++i) {
      const DataTerm& data = problem.data[i];
      if (!(data.weight > 0)) continue;
      const auto vertex = static_cast<Eigen::Index>(i);
      for (RowMatrix::InnerIterator it(basis, vertex); it; ++it) {
        entries.emplace_back(static_cast<int>(offset.size()), static_cast<int>(it.col()),
                             data.weight * data.slope * it.value());
      }
      offset.push_back(data.weight * (data.offset + data.slope * moves[vertex]));
      most.push_back(data.weight * problem.threshold);
    }
    slope.resize(static_cast<Eigen::Index>(offset.size()), basis.cols());
    slope.setFromTriplets(entries.begin(), entries.end());
  }

  // Twice the cost; adds its gradient.
  double evaluate(const Vector& unknowns, Vector& gradient) const {
    if (offset.empty()) return 0;
    double sum = 0;
    Vector pull = slope * unknowns;
    for (Eigen::Index i = 0; i < pull.size(); ++i) {
      const auto at = static_cast<std::size_t>(i);
      const double r = pull[i] + offset[at];
      const bool is_outlier = std::fabs(r) > most[at];
      sum += is_outlier ? most[at] * (2 * std::fabs(r) - most[at]) : r * r;
      pull[i] = is_outlier ? std::copysign(most[at], r) : r;
    }
    gradient += slope.transpose() * pull;
    return sum;
  }
};

// The energy as a function of z, where R z are the unknowns of the basis and R R^T is the inverse
// of the Hessian without the robust loss.
class ReducedEnergy final : public ceres::FirstOrderFunction {
 public:
  // `residual` of the bending, and the `data`, where all unknowns are 0. `factors` know the pattern
  // of the Hessian of the bending; a data term couples no unknowns that the bending does not.
  ReducedEnergy(const RowMatrix& reduced, const Matrix& hessian, const Vector& residual,
                RobustTerms data, Factors& factors)
      : hessian_(hessian),
        data_(std::move(data)),
        force_(reduced.transpose() * residual),
        constant_(residual.squaredNorm()),
        factors_(factors) {
    Matrix full = hessian;
    if (!data_.offset.empty()) full += Matrix(data_.slope.transpose() * data_.slope);
    factors_.setShift(kRegularisation * Vector(full.diagonal()).maxCoeff());
    factors_.factorize(full);
  }

  [[nodiscard]] bool is_usable() const { return factors_.info() == Eigen::Success; }
  [[nodiscard]] int NumParameters() const override { return static_cast<int>(force_.size()); }

  [[nodiscard]] Vector unknowns(const double* parameters) const {
    const Vector z = Eigen::Map<const Vector>(parameters, force_.size());
    return factors_.permutationPinv() * Vector(factors_.matrixU().solve(z));
  }

  bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
    const Vector w = unknowns(parameters);
    const Vector image = hessian_ * w;
    Vector slope = image + force_;
    cost[0] = 0.5 * (constant_ + w.dot(image + 2 * force_) + data_.evaluate(w, slope));
    if (gradient != nullptr) {
      Eigen::Map<Vector>(gradient, slope.size()) =
          factors_.matrixL().solve(Vector(factors_.permutationP() * slope));
    }
    return std::isfinite(cost[0]);
  }

 private:
  const Matrix& hessian_;
  RobustTerms data_;
  Vector force_;
  double constant_;
  Factors& factors_;
};

}  // namespace

NormalBending::NormalBending(const LaplaceRows& rows, const std::vector<double>& curvature,
                             std::uint32_t movable)
    : jacobian_(bending_jacobian(rows, movable)),
      constant_(rows.rows()),
      diagonal_(Vector::Zero(movable)) {
  for (std::uint32_t i = 0; i < rows.rows(); ++i) {
    constant_[i] = std::sqrt(rows.area[i]) * curvature[i];
    for (RowMatrix::InnerIterator it(jacobian_, i); it; ++it) {
      diagonal_[it.col()] += it.value() * it.value();
    }
  }
}

void NormalBending::use_basis(const RowMatrix& basis) {
  basis_ = &basis;
  reduced_ = jacobian_ * basis;
  hessian_ = reduced_.transpose() * reduced_;
  factors_.analyzePattern(hessian_);
}

void NormalBending::minimise(const NormalProblem& problem, std::vector<double>& moves) {
  Vector u = Eigen::Map<const Vector>(moves.data(), static_cast<Eigen::Index>(moves.size()));
  const Vector residual = constant_ + jacobian_ * u;
  // Owned by the problem of Ceres.
  auto* energy =
      new ReducedEnergy(reduced_, hessian_, residual, RobustTerms(problem, *basis_, u), factors_);
  const ceres::GradientProblem ceres_problem(energy);
  if (!energy->is_usable()) return;
  Vector parameters = Vector::Zero(energy->NumParameters());
  ceres::GradientProblemSolver::Options options;
  options.max_num_iterations = problem.max_iterations;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-6;
  options.gradient_tolerance = 1e-8;
  options.parameter_tolerance = 0;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, ceres_problem, parameters.data(), &summary);
  if (!summary.IsSolutionUsable()) return;
  u += *basis_ * energy->unknowns(parameters.data());
  smooth(problem, u);
  if (u.allFinite()) std::copy(u.begin(), u.end(), moves.begin());
}

// Conjugate gradients with the diagonal for the robust weights of the present place; these majorise
// the loss, so that it is reduced, too.
void NormalBending::smooth(const NormalProblem& problem, Vector& moves) const {
  const Eigen::Index n = moves.size();
  Vector residual = -(jacobian_.transpose() * (constant_ + jacobian_ * moves));
  Vector stiffness(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const DataTerm& data = problem.data[static_cast<std::size_t>(i)];
    const double r = data.offset + data.slope * moves[i];
    const double robust = std::min(1.0, problem.threshold / std::fabs(r));
    const double weight = data.weight * data.weight * robust;
    stiffness[i] = weight * data.slope * data.slope;
    residual[i] -= weight * data.slope * r;
  }
  const Vector diagonal = diagonal_ + stiffness;
  Vector scaled = residual.cwiseQuotient(diagonal);
  Vector direction = scaled;
  double size = residual.dot(scaled);
  for (int step = 0; step < kSmoothingSteps && size > 0; ++step) {
    const Vector bent = jacobian_ * direction;
    const Vector image = jacobian_.transpose() * bent + stiffness.cwiseProduct(direction);
    const double length = size / direction.dot(image);
    moves += length * direction;
    residual -= length * image;
    scaled = residual.cwiseQuotient(diagonal);
    const double next = residual.dot(scaled);
    direction = scaled + (next / size) * direction;
    size = next;
  }
}

}  // namespace cellocut
