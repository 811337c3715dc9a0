#include "cellocut/image/feature_distance.h"

#include <cmath>
#include <string>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

constexpr double kTiny = 1e-10;  // as in the authors' code

// The length of the feature vector at each place.
std::vector<double> lengths(const FeatureMap& map) {
  std::vector<double> result(map.places(), 0);
  for (int c = 0; c < map.channels; ++c) {
    for (std::size_t i = 0; i < map.places(); ++i) {
      const double value = map.values[c * map.places() + i];
      result[i] += value * value;
    }
  }
  for (double& length : result) length = std::sqrt(length);
  return result;
}

double layer_distance(const FeatureMap& a, const FeatureMap& b,
                      const std::vector<double>& weights) {
  const std::vector<double> length_a = lengths(a);
  const std::vector<double> length_b = lengths(b);
  const std::size_t places = a.places();
  double sum = 0;
  for (int c = 0; c < a.channels; ++c) {
    double channel = 0;
    for (std::size_t i = 0; i < places; ++i) {
      const double difference = a.values[c * places + i] / (length_a[i] + kTiny) -
                                b.values[c * places + i] / (length_b[i] + kTiny);
      channel += difference * difference;
    }
    sum += weights[c] * channel;
  }
  return sum / static_cast<double>(places);
}

}  // namespace

double lpips_distance(const std::vector<FeatureMap>& a, const std::vector<FeatureMap>& b,
                      const std::vector<std::vector<double>>& weights) {
  if (a.size() != weights.size() || b.size() != weights.size()) {
    throw InputError("LPIPS: weights for " + std::to_string(weights.size()) +
                     " layers, but the network has " + std::to_string(a.size()) + " outputs");
  }
  double sum = 0;
  for (std::size_t layer = 0; layer < a.size(); ++layer) {
    const FeatureMap& map = a[layer];
    if (static_cast<std::size_t>(map.channels) != weights[layer].size()) {
      throw InputError("LPIPS: " + std::to_string(weights[layer].size()) + " weights for layer " +
                       std::to_string(layer + 1) + ", which has " + std::to_string(map.channels) +
                       " channels");
    }
    if (map.channels != b[layer].channels || map.height != b[layer].height ||
        map.width != b[layer].width) {
      throw InputError("LPIPS: the features of two images differ in their size");
    }
    sum += layer_distance(map, b[layer], weights[layer]);
  }
  return sum;
}

std::optional<double> cosine_score(std::span<const float> a, std::span<const float> b) {
  if (a.size() != b.size()) throw InputError("embeddings differ in their length");
  double product = 0;
  double square_a = 0;
  double square_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    product += static_cast<double>(a[i]) * b[i];
    square_a += static_cast<double>(a[i]) * a[i];
    square_b += static_cast<double>(b[i]) * b[i];
  }
  if (square_a == 0 || square_b == 0) return std::nullopt;
  return 100 * product / (std::sqrt(square_a) * std::sqrt(square_b));
}

std::vector<float> channel_means(const FeatureMap& map) {
  std::vector<float> means;
  means.reserve(map.channels);
  for (int c = 0; c < map.channels; ++c) {
    double sum = 0;
    for (std::size_t i = 0; i < map.places(); ++i) sum += map.values[c * map.places() + i];
    means.push_back(static_cast<float>(sum / static_cast<double>(map.places())));
  }
  return means;
}

}  // namespace cellocut
