#include "cellocut/energy/guidance.h"

#include <fmt/format.h>

#include <algorithm>

#include "cellocut/base/errors.h"
#include "cellocut/complex/point_location.h"

namespace cellocut {

namespace {

[[noreturn]] void refuse(const char* kind, const Point3& p, const char* why) {
  throw UsageError(fmt::format("--{} {},{},{}: {}", kind, p[0], p[1], p[2], why));
}

void sort_once(std::vector<std::uint32_t>& cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

}  // namespace

GuidedCells guide_cells(const TetComplex& complex, const Guidance& guidance,
                        const CellLabels& initial, std::vector<Anchor>& anchors) {
  GuidedCells guided;
  // Before any point, so that of two points in one cell the second is refused, not the first.
  const std::vector<Anchor> before = anchors;
  for (const Point3& point : guidance.outside) {
    if (!is_finite(point)) refuse("outside", point, "is not finite");
    for (const std::uint32_t cell : cells_holding(complex, point)) {
      if (initial[cell] == kInterior) {
        refuse("outside", point,
               "lies in the thickened input, which is always solid; move it further away, or use a "
               "smaller --epsilon");
      }
      anchors[cell] = Anchor::exterior;
      guided.outside.push_back(cell);
    }
  }
  for (const Point3& point : guidance.inside) {
    if (!is_finite(point)) refuse("inside", point, "is not finite");
    const std::vector<std::uint32_t> cells = cells_holding(complex, point);
    if (cells.empty()) refuse("inside", point, "lies beyond the hull of the thickened input");
    for (const std::uint32_t cell : cells) {
      if (before[cell] == Anchor::exterior) {
        refuse("inside", point, "lies in a cell that --exterior hull-cells fixes exterior");
      }
      if (anchors[cell] == Anchor::exterior) {
        refuse("inside", point, "lies in the same tetrahedron as an --outside point");
      }
      anchors[cell] = Anchor::interior;
      guided.inside.push_back(cell);
    }
  }
  sort_once(guided.inside);
  sort_once(guided.outside);
  return guided;
}

}  // namespace cellocut
