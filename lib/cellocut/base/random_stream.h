// Random numbers that are the same on every machine and can be taken in any order.
#pragma once

#include <cstdint>

namespace cellocut {

// The output function of SplitMix64 (Steele, Lea and Flood, Fast splittable pseudorandom number
// generators, 2014): every bit of the result depends on every bit of z.
constexpr std::uint64_t mix_bits(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

// SplitMix64's stream of a seed, open at any place. The seed is mixed first: streams whose starts
// differ by a few steps are shifts of one another.
class RandomStream {
 public:
  explicit constexpr RandomStream(std::uint64_t seed) : start_(mix_bits(seed + kStep)) {}
  [[nodiscard]] constexpr std::uint64_t bits(std::uint64_t n) const {
    return mix_bits(start_ + (n + 1) * kStep);
  }
  // Number n, uniform in [0, 1): a multiple of 2^-53. Not std::uniform_real_distribution, whose
  // result depends on the library.
  [[nodiscard]] constexpr double operator()(std::uint64_t n) const {
    return static_cast<double>(bits(n) >> 11) * 0x1p-53;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15U;
  std::uint64_t start_;
};

}  // namespace cellocut
