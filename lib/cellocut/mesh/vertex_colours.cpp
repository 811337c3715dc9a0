#include "cellocut/mesh/vertex_colours.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cellocut::mesh_io {

void VertexColours::set(std::size_t point, std::span<const double> components) {
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::all_of(components.begin(), components.begin() + 3, finite)) return;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  components_.resize(point, {kNone, kNone, kNone});
  Components& colour = components_.emplace_back();
  for (std::size_t k = 0; k < 3; ++k) {
    // Clamped, as not every double fits a float; 65535 is the most that any file counts to.
    colour[k] = static_cast<float>(std::clamp(components[k], 0.0, 65535.0));
  }
  for (const double x : components) {
    if (x > largest_) largest_ = x;  // false for an opacity that is no number
  }
}

std::vector<Rgb> VertexColours::finish(std::size_t point_count) const {
  if (components_.empty()) return {};
  const double full = full_ > 0 ? full_ : largest_ > 1 ? 255 : 1;
  std::vector<Rgb> colours(point_count, {255, 255, 255});
  for (std::size_t i = 0; i < components_.size(); ++i) {
    if (std::isnan(components_[i][0])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const double share = static_cast<double>(components_[i][k]) / full;
      colours[i][k] = static_cast<std::uint8_t>(std::lround(255 * std::min(share, 1.0)));
    }
  }
  return colours;
}

}  // namespace cellocut::mesh_io
