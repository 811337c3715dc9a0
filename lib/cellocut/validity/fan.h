// The faces around a vertex, as a few tests of them want them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// The faces (v, from, to) around a vertex v.
struct Fan {
  static constexpr std::size_t kMostFaces = 16;

  std::size_t count;
  std::array<std::uint32_t, kMostFaces> from;
  std::array<std::uint32_t, kMostFaces> to;

  // `corners`: 3 f + k for each corner k of a face f that v is. Precondition: at most kMostFaces.
  Fan(const std::vector<Triangle>& triangles, std::span<const std::uint32_t> corners)
      : count(corners.size()) {
    for (std::size_t i = 0; i < count; ++i) {
      const Triangle& triangle = triangles[corners[i] / 3];
      const std::uint32_t k = corners[i] % 3;
      from[i] = triangle[(k + 1) % 3];
      to[i] = triangle[(k + 2) % 3];
    }
  }
};

}  // namespace cellocut
