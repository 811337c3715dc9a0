// Pictures as PNG files.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace cellocut {

// The bytes of a PNG file of 8-bit sRGB, or of 16-bit grey levels that mean numbers, not light.
// Rows from above. Preconditions: width * height pixels, both at least 1. Errors: LimitError where
// memory is short. The same bytes for the same pixels.
std::string encode_png(const std::vector<std::array<std::uint8_t, 3>>& pixels, int width,
                       int height);
std::string encode_png(const std::vector<std::uint16_t>& levels, int width, int height);

}  // namespace cellocut
