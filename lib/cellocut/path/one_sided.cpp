#include "cellocut/path/one_sided.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "cellocut/complex/point_location.h"

namespace cellocut {

std::vector<SheetSample> sample_sheets(const TetComplex& complex, const FacetList& facets,
                                       const FacetAreas& areas, const CellLabels& initial,
                                       const NearestTriangle& input, double offset,
                                       Observer& observer) {
  // An area of -1 leaves the facet out.
  std::vector<SheetSample> samples(facets.size(), SheetSample{-1, kOutside, kOutside});
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
    samples[f] = {static_cast<double>(areas.quantised[f]) / areas.scale,
                  first_in_front ? static_cast<std::int32_t>(facet.cell) : facet.other,
                  locate_from(complex, place, facet.cell)};
  });
  observer.check();
  std::erase_if(samples, [](const SheetSample& s) { return s.area < 0; });
  return samples;
}

std::vector<SheetSides> measure_sheet_sides(const std::vector<SheetSample>& samples,
                                            const CellPath& path) {
  const auto level = [&path](std::int32_t cell) {
    return cell == kOutside ? 0U : path.level[static_cast<std::size_t>(cell)];
  };
  // Labellings from the front's level on have the front outside; those before the level behind
  // have it solid there.
  const std::size_t count = path.count();
  std::vector<SheetSides> change(count + 1);
  for (const SheetSample& s : samples) {
    const std::size_t front = level(s.front);
    const std::size_t turn = std::max(front, std::size_t{level(s.behind)});
    change[front].one_sided += s.area;
    change[turn].one_sided -= s.area;
    change[turn].open += s.area;
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
