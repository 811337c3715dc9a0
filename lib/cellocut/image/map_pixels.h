// Depth and normals of a view as the pixels of a picture.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cellocut/view/render.h"

namespace cellocut {

// 0 where nothing is seen; otherwise 1 + 65534 (depth + 1) / 2, rounded and held within 1 to 65535:
// 32768 is the depth of the frame's centre, larger is further away, a step is 1/32767 of the
// frame's unit.
std::vector<std::uint16_t> depth_pixels(const View& view);

// (0, 0, 0) where nothing is seen; otherwise 255 (n + 1) / 2, rounded, for each component of the
// normal: red to the right, green up, blue towards the viewer.
std::vector<std::array<std::uint8_t, 3>> normal_pixels(const View& view);

}  // namespace cellocut
