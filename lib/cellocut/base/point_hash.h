// A hash of coordinates.
#pragma once

#include <bit>
#include <cstdint>

#include "cellocut/base/point.h"

namespace cellocut {

// The same for points that compare equal. Multiplicative hashing (Knuth, TAOCP 3, 6.4) by
// 2^64 / golden ratio, once for each coordinate.
inline std::uint64_t hash_of(const Point3& point) {
  std::uint64_t hash = 0;
  for (const double coordinate : point) {
    hash ^= std::bit_cast<std::uint64_t>(coordinate + 0.0);  // -0.0 + 0.0 is 0.0
    hash *= 0x9E3779B97F4A7C15U;
    hash ^= hash >> 29U;
  }
  return hash;
}

}  // namespace cellocut
