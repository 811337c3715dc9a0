#include "cellocut/complex/point_location.h"

#include "cellocut/base/predicates.h"

namespace cellocut {

namespace {

// Whether the point lies beyond the facet opposite to corner k.
bool beyond(const TetComplex& complex, std::uint32_t cell, int k, const Point3& point) {
  std::array<const Point3*, 4> corner{};
  for (int i = 0; i < 4; ++i) corner[i] = &complex.points[complex.cells[cell][i]];
  corner[k] = &point;
  return orientation(*corner[0], *corner[1], *corner[2], *corner[3]) < 0;
}

}  // namespace

std::int32_t locate_from(const TetComplex& complex, const Point3& point, std::uint32_t start) {
  auto cell = static_cast<std::int32_t>(start);
  std::int32_t before = kOutside;
  while (cell != kOutside) {
    const auto here = static_cast<std::uint32_t>(cell);
    int exit = -1;
    for (int k = 0; k < 4 && exit < 0; ++k) {
      const std::int32_t other = complex.neighbours[here][k];
      // It has just come from there, so the point is on this side.
      if (other == before && before != kOutside) continue;
      if (beyond(complex, here, k, point)) exit = k;
    }
    if (exit < 0) return cell;
    before = cell;
    cell = complex.neighbours[here][exit];
  }
  return kOutside;
}

}  // namespace cellocut
