// Four lanes of a register: vector types of GCC and Clang, which any 64-bit machine has.
#pragma once

#include <cstdint>
#include <cstring>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace cellocut {

using FloatLanes __attribute__((vector_size(16))) = float;
using IntLanes __attribute__((vector_size(16))) = std::int32_t;

// Lane i is values[i].
inline FloatLanes four_at(const float* values) {
  FloatLanes lanes;
  std::memcpy(&lanes, values, sizeof lanes);
  return lanes;
}

// Bit i is set where lane i of a comparison holds (all of its bits are set then, or none).
inline unsigned bits_of(IntLanes comparison) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(comparison)));
#else
  return static_cast<unsigned>((comparison[0] & 1) | (comparison[1] & 2) | (comparison[2] & 4) |
                               (comparison[3] & 8));
#endif
}

}  // namespace cellocut
