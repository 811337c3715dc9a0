#include "cellocut/surface/patch_solvers.h"

#include <ceres/ceres.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace cellocut {

namespace {

constexpr std::uint32_t kFixed = 0xFFFFFFFFU;

// A residual that is linear in numbers, each a parameter block of its own.
class LinearResidual final : public ceres::CostFunction {
 public:
  LinearResidual(std::vector<double> factors, double constant)
      : factors_(std::move(factors)), constant_(constant) {
    mutable_parameter_block_sizes()->assign(factors_.size(), 1);
    set_num_residuals(1);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    double sum = constant_;
    for (std::size_t k = 0; k < factors_.size(); ++k) sum += factors_[k] * parameters[k][0];
    residuals[0] = sum;
    if (jacobians == nullptr) return true;
    for (std::size_t k = 0; k < factors_.size(); ++k) {
      if (jacobians[k] != nullptr) jacobians[k][0] = factors_[k];
    }
    return true;
  }

 private:
  std::vector<double> factors_;
  double constant_;
};

void add_bending_term(ceres::Problem& ceres_problem, const NormalProblem& problem, std::uint32_t i,
                      std::vector<double>& moves) {
  const LaplaceRows& rows = *problem.rows;
  const double root = std::sqrt(rows.area[i]);
  std::vector<double> factors;
  std::vector<double*> blocks;
  double own = 0;
  for (std::uint32_t k = rows.first[i]; k < rows.first[i + 1]; ++k) {
    own -= root * rows.weight[k];
    if (rows.column[k] >= moves.size()) continue;
    factors.push_back(root * rows.weight[k]);
    blocks.push_back(&moves[rows.column[k]]);
  }
  if (i < moves.size()) {
    factors.push_back(own);
    blocks.push_back(&moves[i]);
  }
  if (blocks.empty()) return;
  // Ceres takes ownership.
  ceres_problem.AddResidualBlock(
      new LinearResidual(std::move(factors), root * problem.curvature[i]), nullptr, blocks);
}

}  // namespace

bool relax_membrane(const LaplaceRows& rows, const std::vector<std::uint8_t>& is_free,
                    double anchor, std::vector<Point3>& points) {
  std::vector<std::uint32_t> number(points.size(), kFixed);
  std::vector<std::uint32_t> vertex;
  for (std::uint32_t i = 0; i < is_free.size(); ++i) {
    if (is_free[i] == 0) continue;
    number[i] = static_cast<std::uint32_t>(vertex.size());
    vertex.push_back(i);
  }
  const auto unknowns = static_cast<Eigen::Index>(vertex.size());
  if (unknowns == 0) return true;

  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(unknowns, 3);
  for (Eigen::Index u = 0; u < unknowns; ++u) {
    const std::uint32_t i = vertex[static_cast<std::size_t>(u)];
    for (int axis = 0; axis < 3; ++axis) right(u, axis) = anchor * points[i][axis];
    for (std::uint32_t k = rows.first[i]; k < rows.first[i + 1]; ++k) {
      const std::uint32_t j = rows.column[k];
      if (number[j] != kFixed) {
        entries.emplace_back(static_cast<int>(u), static_cast<int>(number[j]), -1.0);
      } else {
        for (int axis = 0; axis < 3; ++axis) right(u, axis) += points[j][axis];
      }
    }
    entries.emplace_back(static_cast<int>(u), static_cast<int>(u),
                         anchor + (rows.first[i + 1] - rows.first[i]));
  }
  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factorisation(matrix);
  if (factorisation.info() != Eigen::Success) return false;
  const Eigen::MatrixX3d solution = factorisation.solve(right);
  if (!solution.allFinite()) return false;
  for (Eigen::Index u = 0; u < unknowns; ++u) {
    for (int axis = 0; axis < 3; ++axis) {
      points[vertex[static_cast<std::size_t>(u)]][axis] = solution(u, axis);
    }
  }
  return true;
}

std::vector<double> solve_normal_moves(const NormalProblem& problem) {
  std::vector<double> moves(problem.data.size(), 0.0);
  ceres::Problem::Options problem_options;
  problem_options.disable_all_safety_checks = true;
  ceres::Problem ceres_problem(problem_options);
  for (double& move : moves) ceres_problem.AddParameterBlock(&move, 1);
  for (std::uint32_t i = 0; i < problem.rows->rows(); ++i) {
    add_bending_term(ceres_problem, problem, i, moves);
  }
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const DataTerm& data = problem.data[i];
    if (data.weight > 0) {
      ceres_problem.AddResidualBlock(
          new LinearResidual({data.weight * data.slope}, data.weight * data.offset),
          new ceres::HuberLoss(data.weight * problem.threshold), &moves[i]);
    }
  }

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Not SuiteSparse: its BLAS may be one with threads, and sums in an order of its own.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = problem.max_iterations;
  options.logging_type = ceres::SILENT;
  // Without bounds and outliers the problem is linear: no damping, and the first step is the last.
  // The flattest modes of a plate of n vertices are n^2 times softer than the stiffest.
  options.initial_trust_region_radius = 1e16;
  options.max_trust_region_radius = 1e20;
  options.function_tolerance = 1e-4;
  options.gradient_tolerance = 1e-8;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &ceres_problem, &summary);
  if (!summary.IsSolutionUsable()) moves.assign(moves.size(), 0.0);
  return moves;
}

}  // namespace cellocut
