// How far apart two images are in the features of a network.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace cellocut {

// What one output of a network is for one image: channels of height x width numbers, channel by
// channel, row by row.
struct FeatureMap {
  int channels = 0;
  int height = 1;
  int width = 1;
  std::vector<float> values;

  [[nodiscard]] std::size_t places() const { return static_cast<std::size_t>(height) * width; }
};

// LPIPS (Zhang et al., The unreasonable effectiveness of deep features as a perceptual metric,
// 2018): for each layer, the features of every place made unit vectors (f / (|f| + 1e-10)), their
// squared differences weighted by channel, summed over channels, averaged over places; the sum over
// layers. 0 for equal maps. `weights`: one vector for each layer, one number for each channel.
// Errors: InputError where numbers of layers, channels or places do not fit. O(numbers).
double lpips_distance(const std::vector<FeatureMap>& a, const std::vector<FeatureMap>& b,
                      const std::vector<std::vector<double>>& weights);

// 100 times the cosine of two embeddings (Radford et al., Learning transferable visual models from
// natural language supervision, 2021, between two images). Nothing where either is zero.
// Errors: InputError where their lengths differ.
std::optional<double> cosine_score(std::span<const float> a, std::span<const float> b);

// The mean of each channel over all places.
std::vector<float> channel_means(const FeatureMap& map);

}  // namespace cellocut
