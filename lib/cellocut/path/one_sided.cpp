#include "cellocut/path/one_sided.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "cellocut/complex/point_location.h"

namespace cellocut {

namespace {

// A supported facet: in how many labellings the cell in front of it is solid, and the place behind.
struct Sample {
  bool counts = false;
  std::uint32_t front = 0;
  std::uint32_t behind = 0;
};

}  // namespace

std::vector<SheetSides> measure_sheet_sides(const TetComplex& complex, const FacetList& facets,
                                            const FacetAreas& areas, const CellLabels& initial,
                                            const CellPath& path, const NearestTriangle& input,
                                            double offset, Observer& observer) {
  const auto level = [&path](std::int32_t cell) {
    return cell == kOutside ? 0U : path.level[static_cast<std::size_t>(cell)];
  };
  std::vector<Sample> samples(facets.size());
  tbb::parallel_for(std::size_t{0}, facets.size(), [&](std::size_t f) {
    if (f % 4096 == 0) observer.check();
    const Facet& facet = facets[f];
    if (!is_supported(facet, initial)) return;
    const auto corners = facet_corners(complex, facet.cell, facet.corner);
    const Point3 centre = (1.0 / 3) * (complex.points[corners[0]] + complex.points[corners[1]] +
                                       complex.points[corners[2]]);
    const NearestPoint nearest = input(centre, 4 * offset);
    // Where cells leak through the slab a facet may lie in the sheet; it tells no side.
    if (!nearest.found() || nearest.distance < offset / 4) return;
    const Point3 place = nearest.point - (2 * offset / nearest.distance) * (centre - nearest.point);
    const bool first_in_front = initial[facet.cell] == kExterior;
    samples[f] = {true, level(first_in_front ? static_cast<std::int32_t>(facet.cell) : facet.other),
                  level(locate_from(complex, place, facet.cell))};
  });
  observer.check();
  // Labellings from `front` on have the front outside; those before `behind` have it solid behind.
  const std::size_t count = path.count();
  std::vector<SheetSides> change(count + 1);
  for (std::size_t f = 0; f < samples.size(); ++f) {
    const Sample& s = samples[f];
    if (!s.counts) continue;
    const double area = static_cast<double>(areas.quantised[f]) / areas.scale;
    const std::size_t turn = std::max(s.front, s.behind);
    change[s.front].one_sided += area;
    change[turn].one_sided -= area;
    change[turn].open += area;
  }
  std::vector<SheetSides> sides(count);
  SheetSides now;
  for (std::size_t k = 0; k < count; ++k) {
    now.one_sided += change[k].one_sided;
    now.open += change[k].open;
    sides[k] = now;
  }
  return sides;
}

}  // namespace cellocut
