// The two systems of equations that fair a patch. Lengths in grid steps.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/surface/laplacian.h"

namespace cellocut {

// Moves the vertices i with is_free[i] (one byte per movable vertex) to where the sum over edges of
// |x_i - x_j|^2 and over free vertices of anchor |x_i - its present place|^2 is least. One sparse
// Cholesky factorisation for the three coordinates. False, and nothing moved, where the system is
// singular to rounding, which it is not for anchor > 0. O(n^1.5) on surfaces.
bool relax_membrane(const LaplaceRows& rows, const std::vector<std::uint8_t>& is_free,
                    double anchor, std::vector<Point3>& points);

// A data term: weight^2 loss(offset + slope u), loss(r) = r^2 below `threshold`, linear beyond
// (Huber). No term where weight is 0.
struct DataTerm {
  double weight = 0;
  double offset = 0;
  double slope = 0;
};

// How far each movable vertex goes along its normal.
struct NormalProblem {
  const LaplaceRows* rows = nullptr;
  std::vector<double> curvature;  // of every row before the move: 2 H, per length
  std::vector<DataTerm> data;     // of every movable vertex
  double threshold = 0;
  int max_iterations = 0;
};

// The u that minimises the sum over rows of area (curvature + L u)^2 and the data terms; u = 0 on
// fixed rows. By Ceres (Levenberg-Marquardt, sparse normal equations, one thread). Zeros where it
// finds nothing better.
std::vector<double> solve_normal_moves(const NormalProblem& problem);

}  // namespace cellocut
