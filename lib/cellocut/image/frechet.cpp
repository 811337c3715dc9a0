#include "cellocut/image/frechet.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

using Matrix = Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A Gaussian whose covariance is factor * factor'.
struct Factored {
  Eigen::VectorXd mean;
  Matrix factor;
};

Eigen::Index index(std::size_t n) { return static_cast<Eigen::Index>(n); }

Eigen::Map<const RowMajor> rows_of(const FeatureSamples& samples) {
  return {samples.values().data(), index(samples.size()), index(samples.dimensions())};
}

Factored factored(const Gaussian& gaussian) {
  const Eigen::Index d = index(gaussian.dimensions());
  const Eigen::Map<const RowMajor> covariance(gaussian.covariance.data(), d, d);
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(covariance);
  const Eigen::VectorXd roots = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return {Eigen::Map<const Eigen::VectorXd>(gaussian.mean.data(), d),
          solver.eigenvectors() * roots.asDiagonal()};
}

Factored factored(const FeatureSamples& samples) {
  if (samples.size() > samples.dimensions()) return factored(gaussian_of(samples));
  const auto rows = rows_of(samples);
  const Eigen::RowVectorXd mean = rows.colwise().mean();
  const Matrix centred = rows.rowwise() - mean;
  return {mean.transpose(),
          centred.transpose() / std::sqrt(static_cast<double>(samples.size() - 1))};
}

double distance(const Factored& a, const Factored& b) {
  const Matrix product = a.factor.transpose() * b.factor;
  const double root = Eigen::BDCSVD<Matrix>(product).singularValues().sum();
  const double result =
      (a.mean - b.mean).squaredNorm() + a.factor.squaredNorm() + b.factor.squaredNorm() - 2 * root;
  return std::max(0.0, result);  // rounding, where both are the same
}

}  // namespace

void FeatureSamples::add(std::span<const float> feature) {
  if (feature.empty()) throw InputError("a feature vector is empty");
  if (dimensions_ == 0) dimensions_ = feature.size();
  if (feature.size() != dimensions_) throw InputError("feature vectors differ in their length");
  if (!std::all_of(feature.begin(), feature.end(), [](float v) { return std::isfinite(v); })) {
    throw InputError("a feature is not finite");
  }
  values_.insert(values_.end(), feature.begin(), feature.end());
}

Gaussian gaussian_of(const FeatureSamples& samples) {
  const auto rows = rows_of(samples);
  const Eigen::RowVectorXd mean = rows.colwise().mean();
  const Matrix centred = rows.rowwise() - mean;
  const Matrix covariance = centred.transpose() * centred / static_cast<double>(samples.size() - 1);
  return {.mean = {mean.data(), mean.data() + mean.size()},
          .covariance = {covariance.data(), covariance.data() + covariance.size()}};
}

double frechet_distance(const Gaussian& a, const Gaussian& b) {
  return distance(factored(a), factored(b));
}

double frechet_distance(const FeatureSamples& a, const FeatureSamples& b) {
  return distance(factored(a), factored(b));
}

}  // namespace cellocut
