#include "cellocut/surface/patch_solvers.h"

#include <Eigen/SparseCholesky>

namespace cellocut {

namespace {

constexpr std::uint32_t kFixed = 0xFFFFFFFFU;

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

}  // namespace cellocut
