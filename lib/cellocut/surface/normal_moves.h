// How far the vertices of a patch go along their normals to bend less. Lengths in grid steps.
#pragma once

#include <Eigen/SparseCholesky>
#include <cstdint>
#include <vector>

#include "cellocut/surface/displacement_basis.h"
#include "cellocut/surface/laplacian.h"

namespace cellocut {

// A data term: weight^2 loss(offset + slope u), loss(r) = r^2 below `threshold`, linear beyond
// (Huber). No term where weight is 0.
struct DataTerm {
  double weight = 0;
  double offset = 0;
  double slope = 0;
};

struct NormalProblem {
  std::vector<DataTerm> data;  // of every movable vertex
  double threshold = 0;        // above 0
  int max_iterations = 0;      // of Ceres
};

// The sum over rows of area (curvature + L u)^2, by the moves u of the movable vertices; u = 0 on
// fixed rows.
class NormalBending {
 public:
  // `curvature` of every row before the move: 2 H, per length. `movable`: how many of the rows
  // move, the first ones.
  NormalBending(const LaplaceRows& rows, const std::vector<double>& curvature,
                std::uint32_t movable);

  // A basis with a row for every movable vertex; kept by reference. O(vertices) for a basis of
  // bounded support.
  void use_basis(const RowMatrix& basis);

  // Reduces the energy and the data terms. `moves`: u of every movable vertex, from where it
  // starts; unchanged where nothing better is found.
  //
  // First among displacements that the basis spans: Ceres (L-BFGS) finds numbers in which, but for
  // the robust loss, the energy is a sphere, by a sparse Cholesky factorisation of the reduced
  // normal equations. What the basis cannot say is of short waves, and a fixed number of conjugate
  // gradient steps for all vertices takes it away. One thread; O(n) for n vertices and O(k^1.5) for
  // k unknowns of the basis. Precondition: use_basis() was called.
  void minimise(const NormalProblem& problem, std::vector<double>& moves);

 private:
  void smooth(const NormalProblem& problem, Eigen::VectorXd& moves) const;

  RowMatrix jacobian_;        // sqrt(area) L
  Eigen::VectorXd constant_;  // sqrt(area) curvature
  Eigen::VectorXd diagonal_;  // of jacobian^T jacobian
  const RowMatrix* basis_ = nullptr;
  RowMatrix reduced_;                                          // jacobian * basis
  Eigen::SparseMatrix<double> hessian_;                        // reduced^T reduced
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factors_;  // of it and the data terms
};

}  // namespace cellocut
