#include "viz/section_colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace cellocut::viz {

namespace {

constexpr Colour kPale{0.925, 0.937, 0.953};
constexpr Colour kSolid{0.867, 0.478, 0.235};
constexpr Colour kMarked{0.722, 0.118, 0.290};
constexpr Colour kAnchored{0.235, 0.471, 0.690};

// Distinguishable with every common kind of colour vision (Okabe and Ito, 2008).
constexpr std::array<Colour, 7> kDistinct{{{0.902, 0.624, 0.000},
                                           {0.337, 0.706, 0.914},
                                           {0.000, 0.620, 0.451},
                                           {0.941, 0.894, 0.259},
                                           {0.000, 0.447, 0.698},
                                           {0.835, 0.369, 0.000},
                                           {0.800, 0.475, 0.655}}};

// Beyond the palette: hues that step by the golden ratio, which keeps any number of them apart.
Colour golden_hue(std::size_t i) {
  const double hue = std::fmod(static_cast<double>(i) * 0.61803398875, 1.0) * 6;
  const auto channel = [hue](double shift) {
    const double k = std::fmod(shift + hue, 6.0);
    return 0.68 - 0.5 * std::clamp(std::min(k, 4 - k), 0.0, 1.0);
  };
  return {channel(5), channel(3), channel(1)};
}

Colour distinct_colour(std::int32_t value) {
  if (value < 0) return {0.6, 0.6, 0.6};
  const auto i = static_cast<std::size_t>(value);
  return i < kDistinct.size() ? kDistinct[i] : golden_hue(i);
}

std::vector<Category> known_categories(const std::string& array_name) {
  if (array_name == "label" || array_name.starts_with("label_")) {
    return {{0, "interior", kSolid}, {1, "exterior", kPale}};
  }
  if (array_name == "ambiguous") return {{0, "decided", kPale}, {1, "ambiguous", kMarked}};
  if (array_name == "anchored") return {{0, "free", kPale}, {1, "anchored", kAnchored}};
  return {};
}

}  // namespace

std::vector<Category> categories_of(const std::string& array_name,
                                    const std::vector<std::int32_t>& present) {
  std::vector<Category> categories = known_categories(array_name);
  for (const std::int32_t value : present) {
    const bool known = std::any_of(categories.begin(), categories.end(),
                                   [value](const Category& c) { return c.value == value; });
    if (known) continue;
    categories.push_back({value, array_name + " " + std::to_string(value), distinct_colour(value)});
  }
  std::sort(categories.begin(), categories.end(),
            [](const Category& a, const Category& b) { return a.value < b.value; });
  return categories;
}

std::vector<Category> bands_of(const std::vector<double>& borders) {
  const std::size_t count = borders.size() - 1;
  const auto mixed = [](const Colour& a, const Colour& b, double t) {
    return Colour{a.red + t * (b.red - a.red), a.green + t * (b.green - a.green),
                  a.blue + t * (b.blue - a.blue)};
  };
  constexpr Colour kLow{0.950, 0.930, 0.800};
  constexpr Colour kMiddle{0.240, 0.600, 0.560};
  constexpr Colour kHigh{0.190, 0.080, 0.330};
  constexpr Colour kNegative{0.060, 0.290, 0.600};
  constexpr Colour kPositive{0.700, 0.120, 0.130};
  const auto zero = static_cast<std::size_t>(std::lower_bound(borders.begin(), borders.end(), 0.0) -
                                             borders.begin());
  const bool diverging = zero > 0 && zero < count && borders[zero] == 0;
  std::vector<Category> bands;
  bands.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Colour colour;
    if (diverging) {
      const bool below = i < zero;
      const std::size_t steps = below ? zero - i : i - zero + 1;
      const std::size_t most = below ? zero : count - zero;
      colour = mixed(kPale, below ? kNegative : kPositive,
                     static_cast<double>(steps) / static_cast<double>(most));
    } else {
      const double t = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0.5;
      colour = t < 0.5 ? mixed(kLow, kMiddle, 2 * t) : mixed(kMiddle, kHigh, 2 * t - 1);
    }
    bands.push_back({static_cast<std::int32_t>(i),
                     fmt::format("{:.3g} to {:.3g}", borders[i], borders[i + 1]), colour});
  }
  return bands;
}

Colour surface_line_colour(std::size_t i) {
  constexpr std::array<Colour, 4> kLines{
      {{0.090, 0.170, 0.330}, {0.640, 0.070, 0.160}, {0.040, 0.390, 0.250}, {0.380, 0.190, 0.530}}};
  return kLines[i % kLines.size()];
}

Colour surface_fill_colour(std::size_t i) {
  const Colour line = surface_line_colour(i);
  const auto lighter = [](double x) { return 0.35 * x + 0.65; };
  return {lighter(line.red), lighter(line.green), lighter(line.blue)};
}

}  // namespace cellocut::viz
