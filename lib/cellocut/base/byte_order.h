// Scalars in the byte orders of binary files, on a host of either order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

namespace cellocut {

template <class Scalar>
Scalar load(const char* bytes, std::endian order) {
  std::array<char, sizeof(Scalar)> raw;
  std::memcpy(raw.data(), bytes, sizeof(Scalar));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Scalar>(raw);
}

template <class Scalar>
Scalar load_little_endian(const char* bytes) {
  return load<Scalar>(bytes, std::endian::little);
}

template <class Scalar>
void append_little_endian(std::string& bytes, Scalar value) {
  auto raw = std::bit_cast<std::array<char, sizeof(Scalar)>>(value);
  if constexpr (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

}  // namespace cellocut
