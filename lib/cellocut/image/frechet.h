// The Frechet distance between sets of feature vectors, as FID takes it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace cellocut {

struct Gaussian {
  std::vector<double> mean;
  std::vector<double> covariance;  // symmetric, row by row: the square of mean.size()

  [[nodiscard]] std::size_t dimensions() const { return mean.size(); }
};

// Feature vectors of one length.
class FeatureSamples {
 public:
  // Errors: InputError where its length differs from that of the first, or it holds a number that
  // is not finite.
  void add(std::span<const float> feature);

  [[nodiscard]] std::size_t size() const {
    return dimensions_ == 0 ? 0 : values_.size() / dimensions_;
  }
  [[nodiscard]] std::size_t dimensions() const { return dimensions_; }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }  // one after another

 private:
  std::size_t dimensions_ = 0;
  std::vector<double> values_;
};

// The mean, and the covariance with n - 1 below. Precondition: two samples or more. O(n d^2).
Gaussian gaussian_of(const FeatureSamples& samples);

// |m - n|^2 + tr(C + D - 2 (C^(1/2) D C^(1/2))^(1/2)) (Dowson and Landau, The Frechet distance
// between multivariate normal distributions, 1982; Heusel et al., GANs trained by a two time-scale
// update rule, 2017). The trace of the root is the sum of the singular values of F' G for any
// factors C = F F', D = G G': no root of a product that rounding has made asymmetric or indefinite.
// Factors come from symmetric eigenvalue decompositions, negative eigenvalues counted as 0.
// Precondition: the same dimensions. O(d^3).
double frechet_distance(const Gaussian& a, const Gaussian& b);

// That of their means and covariances. With fewer samples than dimensions the centred samples
// themselves are the factors: exact, and O(n^2 d). The distance then depends on the number of
// samples and compares with others of the same number only. Preconditions: two samples or more on
// either side, the same dimensions.
double frechet_distance(const FeatureSamples& a, const FeatureSamples& b);

}  // namespace cellocut
