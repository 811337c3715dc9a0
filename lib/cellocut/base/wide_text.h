// 128-bit integers as text.
#pragma once

#include <algorithm>
#include <string>

namespace cellocut {

__extension__ using Wide = __int128;

inline std::string to_decimal(Wide number) {
  const bool negative = number < 0;
  std::string digits;  // last first
  do {
    const int digit = static_cast<int>(number % 10);
    digits += static_cast<char>('0' + (negative ? -digit : digit));
    number /= 10;
  } while (number != 0);
  if (negative) digits += '-';
  std::reverse(digits.begin(), digits.end());
  return digits;
}

}  // namespace cellocut
