#include "cellocut/complex/point_location.h"

#include <algorithm>

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

bool holds(const TetComplex& complex, std::uint32_t cell, const Point3& point) {
  for (int k = 0; k < 4; ++k) {
    if (beyond(complex, cell, k, point)) return false;
  }
  return true;
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

std::vector<std::uint32_t> cells_holding(const TetComplex& complex, const Point3& point) {
  if (complex.cells.empty()) return {};
  const std::int32_t first = locate_from(complex, point, 0);
  if (first == kOutside) return {};
  // The cells around a facet, an edge or a corner are joined through facets that hold it too.
  std::vector<std::uint32_t> cells{static_cast<std::uint32_t>(first)};
  for (std::size_t n = 0; n < cells.size(); ++n) {
    for (const std::int32_t other : complex.neighbours[cells[n]]) {
      if (other == kOutside) continue;
      const auto cell = static_cast<std::uint32_t>(other);
      if (std::find(cells.begin(), cells.end(), cell) != cells.end()) continue;
      if (holds(complex, cell, point)) cells.push_back(cell);
    }
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

}  // namespace cellocut
