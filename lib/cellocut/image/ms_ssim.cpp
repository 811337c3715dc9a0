#include "cellocut/image/ms_ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace cellocut {

namespace {

constexpr int kWindow = 11;
constexpr double kSigma = 1.5;
constexpr std::array<double, 5> kPowers{0.0448, 0.2856, 0.3001, 0.2363, 0.1333};
constexpr double kLuminance = (0.01 * 255) * (0.01 * 255);
constexpr double kContrast = (0.03 * 255) * (0.03 * 255);

using Window = std::array<double, kWindow>;

Window gaussian_window() {
  Window weights{};
  for (int i = 0; i < kWindow; ++i) {
    const int x = i - (kWindow - 1) / 2;  // from the middle
    weights[i] = std::exp(-x * x / (2 * kSigma * kSigma));
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& w : weights) w /= sum;
  return weights;
}

// The weighted means of value(i), i a pixel's number, at all places where the window fits: rows,
// then columns.
template <class Value>
std::vector<double> smoothed(int width, int height, const Value& value) {
  static const Window weights = gaussian_window();
  const int columns = width - kWindow + 1;
  const int rows = height - kWindow + 1;
  std::vector<double> across(static_cast<std::size_t>(columns) * height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < columns; ++x) {
      double sum = 0;
      for (int k = 0; k < kWindow; ++k) {
        sum += weights[k] * value(static_cast<std::size_t>(y) * width + x + k);
      }
      across[static_cast<std::size_t>(y) * columns + x] = sum;
    }
  }
  std::vector<double> result(static_cast<std::size_t>(columns) * rows);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      double sum = 0;
      for (int k = 0; k < kWindow; ++k) {
        sum += weights[k] * across[static_cast<std::size_t>(y + k) * columns + x];
      }
      result[static_cast<std::size_t>(y) * columns + x] = sum;
    }
  }
  return result;
}

struct Similarity {
  double structure = 0;  // the mean of contrast times structure
  double all = 0;        // the mean of that times luminance
};

Similarity similarity(const GreyImage& a, const GreyImage& b) {
  const auto smooth = [&](const auto& value) { return smoothed(a.width, a.height, value); };
  const auto& u = a.values;
  const auto& v = b.values;
  const std::vector<double> mean_a = smooth([&](std::size_t i) { return u[i]; });
  const std::vector<double> mean_b = smooth([&](std::size_t i) { return v[i]; });
  const std::vector<double> square_a = smooth([&](std::size_t i) { return u[i] * u[i]; });
  const std::vector<double> square_b = smooth([&](std::size_t i) { return v[i] * v[i]; });
  const std::vector<double> product = smooth([&](std::size_t i) { return u[i] * v[i]; });
  Similarity sum;
  for (std::size_t i = 0; i < product.size(); ++i) {
    const double ma = mean_a[i];
    const double mb = mean_b[i];
    const double variance_a = square_a[i] - ma * ma;
    const double variance_b = square_b[i] - mb * mb;
    const double covariance = product[i] - ma * mb;
    const double structure = (2 * covariance + kContrast) / (variance_a + variance_b + kContrast);
    const double luminance = (2 * ma * mb + kLuminance) / (ma * ma + mb * mb + kLuminance);
    sum.structure += structure;
    sum.all += structure * luminance;
  }
  const auto count = static_cast<double>(product.size());
  return {sum.structure / count, sum.all / count};
}

GreyImage halved(const GreyImage& image) {
  GreyImage half{.width = image.width / 2, .height = image.height / 2, .values = {}};
  half.values.reserve(static_cast<std::size_t>(half.width) * half.height);
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(2) * y * image.width + 2 * x;
      half.values.push_back((image.values[i] + image.values[i + 1] + image.values[i + image.width] +
                             image.values[i + image.width + 1]) /
                            4);
    }
  }
  return half;
}

int fitting_scales(const GreyImage& image) {
  int scales = 0;
  for (int size = std::min(image.width, image.height);
       size >= kWindow && scales < static_cast<int>(kPowers.size()); size /= 2) {
    ++scales;
  }
  return scales;
}

}  // namespace

GreyImage grey_image(const View& view) {
  GreyImage grey{.width = view.resolution, .height = view.resolution, .values = {}};
  grey.values.reserve(view.clay.size());
  for (const auto& pixel : view.clay) {
    grey.values.push_back(0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2]);
  }
  return grey;
}

MsSsim ms_ssim(const GreyImage& a, const GreyImage& b) {
  const int scales = fitting_scales(a);
  if (scales == 0) return {};
  // As published, the five add up to 1.0001; they stay as they are.
  const bool all = scales == static_cast<int>(kPowers.size());
  const double sum = all ? 1 : std::accumulate(kPowers.begin(), kPowers.begin() + scales, 0.0);
  double product = 1;
  GreyImage first = a;
  GreyImage second = b;
  for (int scale = 0; scale < scales; ++scale) {
    if (scale > 0) {
      first = halved(first);
      second = halved(second);
    }
    const Similarity found = similarity(first, second);
    const double term = scale + 1 == scales ? found.all : found.structure;
    product *= std::pow(std::max(0.0, term), kPowers[scale] / sum);
  }
  return {.value = product, .scales = scales};
}

}  // namespace cellocut
