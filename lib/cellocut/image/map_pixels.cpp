#include "cellocut/image/map_pixels.h"

#include <algorithm>
#include <cmath>

namespace cellocut {

std::vector<std::uint16_t> depth_pixels(const View& view) {
  std::vector<std::uint16_t> levels(view.size(), 0);
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (!view.covers(i)) continue;
    const double share = std::clamp((static_cast<double>(view.depth[i]) + 1) / 2, 0.0, 1.0);
    levels[i] = static_cast<std::uint16_t>(1 + std::lround(65534 * share));
  }
  return levels;
}

std::vector<std::array<std::uint8_t, 3>> normal_pixels(const View& view) {
  std::vector<std::array<std::uint8_t, 3>> pixels(view.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    if (!view.covers(i)) continue;
    for (int k = 0; k < 3; ++k) {
      const double share = std::clamp((static_cast<double>(view.normals[i][k]) + 1) / 2, 0.0, 1.0);
      pixels[i][k] = static_cast<std::uint8_t>(std::lround(255 * share));
    }
  }
  return pixels;
}

}  // namespace cellocut
