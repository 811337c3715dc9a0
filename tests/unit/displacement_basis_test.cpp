// Displacements that a reduced basis has to be able to say.
#include "cellocut/surface/displacement_basis.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>

namespace cellocut {
namespace {

constexpr int kSide = 30;

// A lattice with a side of kSide steps, a step apart, shaken within its plane; all rows, and those
// next to its border fine.
struct Sheet {
  LaplaceRows rows;
  std::vector<Point3> points;
  std::vector<Point3> normals;
  std::vector<std::uint8_t> is_fine;

  void add(double height) {
    const auto base = static_cast<int>(points.size());
    if (rows.first.empty()) rows.first.push_back(0);
    for (int y = 0; y <= kSide; ++y) {
      for (int x = 0; x <= kSide; ++x) {
        points.push_back({x + 0.2 * std::sin(7.0 * y + x), y + 0.2 * std::sin(5.0 * x), height});
        normals.push_back({0, 0, 1});
        is_fine.push_back(std::min({x, y, kSide - x, kSide - y}) < 3 ? 1 : 0);
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const bool is_inside = x + dx >= 0 && x + dx <= kSide && y + dy >= 0 && y + dy <= kSide;
            if ((dx == 0 && dy == 0) || !is_inside) continue;
            rows.column.push_back(
                static_cast<std::uint32_t>(base + (y + dy) * (kSide + 1) + x + dx));
          }
        }
        rows.first.push_back(static_cast<std::uint32_t>(rows.column.size()));
        rows.weight.resize(rows.column.size(), 1.0);
        rows.area.push_back(1);
      }
    }
  }

  [[nodiscard]] RowMatrix basis(double spacing = 3) const {
    return make_displacement_basis(rows, points, normals, is_fine, spacing);
  }
};

double worst_fit(const Sheet& sheet, const std::function<double(const Point3&)>& shape) {
  const Eigen::MatrixXd basis = sheet.basis();
  Eigen::VectorXd wanted(basis.rows());
  for (Eigen::Index i = 0; i < wanted.size(); ++i) {
    wanted[i] = shape(sheet.points[static_cast<std::size_t>(i)]);
  }
  const Eigen::VectorXd unknowns = basis.colPivHouseholderQr().solve(wanted);
  return (basis * unknowns - wanted).cwiseAbs().maxCoeff();
}

TEST(DisplacementBasis, HasFewUnknownsInside) {
  Sheet sheet;
  sheet.add(0);
  const RowMatrix basis = sheet.basis();
  EXPECT_EQ(basis.rows(), (kSide + 1) * (kSide + 1));
  const auto fine = static_cast<Eigen::Index>(
      std::count(sheet.is_fine.begin(), sheet.is_fine.end(), std::uint8_t{1}));
  EXPECT_GT(basis.cols(), fine + 50);
  EXPECT_LT(basis.cols(), fine + (basis.rows() - fine) / 3);
}

TEST(DisplacementBasis, FineVerticesHaveAnUnknownEach) {
  Sheet sheet;
  sheet.add(0);
  const RowMatrix basis = sheet.basis();
  const Eigen::VectorXd uses = RowMatrix(basis.transpose()) * Eigen::VectorXd::Ones(basis.rows());
  for (Eigen::Index i = 0; i < basis.rows(); ++i) {
    if (sheet.is_fine[static_cast<std::size_t>(i)] == 0) continue;
    const RowMatrix::InnerIterator entry(basis, i);
    EXPECT_EQ(basis.row(i).nonZeros(), 1);
    EXPECT_EQ(entry.value(), 1);
    EXPECT_EQ(uses[entry.col()], 1);
  }
}

TEST(DisplacementBasis, SaysQuadraticsExactly) {
  Sheet sheet;
  sheet.add(0);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(sheet.basis().cols());
  EXPECT_LT(((sheet.basis() * ones).array() - 1).abs().maxCoeff(), 1e-11);
  EXPECT_LT(worst_fit(sheet, [](const Point3& p) { return 3 * p[0] - p[1]; }), 1e-9);
  EXPECT_LT(worst_fit(sheet, [](const Point3& p) { return p[0] * p[1] - p[1] * p[1]; }), 1e-8);
  // And no short waves.
  EXPECT_GT(worst_fit(sheet, [](const Point3& p) { return std::cos(3 * p[0]); }), 0.3);
}

TEST(DisplacementBasis, NearSheetsShareNoNode) {
  Sheet sheet;
  sheet.add(0);
  const RowMatrix one = sheet.basis();
  sheet.add(0.5);
  const RowMatrix two = sheet.basis();
  EXPECT_EQ(two.cols(), 2 * one.cols());
  EXPECT_EQ(two.nonZeros(), 2 * one.nonZeros());
}

TEST(DisplacementBasis, WhoSeesTooFewNodesIsFine) {
  Sheet sheet;
  sheet.add(0);
  for (Point3& p : sheet.points) p[1] = 0;  // a line determines no quadratic
  const RowMatrix basis = sheet.basis();
  EXPECT_EQ(basis.cols(), basis.rows());
  EXPECT_EQ(basis.nonZeros(), basis.rows());
}

}  // namespace
}  // namespace cellocut
