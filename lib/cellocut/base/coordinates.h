// Which numbers a file format keeps of coordinates.
#pragma once

#include <cstdint>

#include "cellocut/base/point.h"

namespace cellocut {

enum class Coordinates : std::uint8_t { doubles, floats };

// Volatile, because g++ 12.2 wrongly drops a conversion to float and back where it vectorizes two
// of them (already at -O2).
inline double rounded_to_float(double x) {
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}

// What is kept of a point: itself, or the nearest float of each coordinate.
inline Point3 kept(const Point3& p, Coordinates coordinates) {
  if (coordinates == Coordinates::doubles) return p;
  return {rounded_to_float(p[0]), rounded_to_float(p[1]), rounded_to_float(p[2])};
}

}  // namespace cellocut
