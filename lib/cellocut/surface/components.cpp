#include "cellocut/surface/components.h"

#include <algorithm>
#include <cmath>

#include "cellocut/base/disjoint_sets.h"

namespace cellocut {

std::int64_t drop_small_components(TriangleSoup& surface, double share) {
  if (share <= 0 || surface.empty()) return 0;
  DisjointSets sets(surface.points.size());
  for (const Triangle& t : surface.triangles) {
    sets.join(t[0], t[1]);
    sets.join(t[0], t[2]);
  }
  std::vector<double> volume(surface.points.size(), 0);
  double total = 0;
  const Point3 origin = surface.points.front();
  for (const Triangle& t : surface.triangles) {
    const double part =
        six_volumes(origin, surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]) / 6;
    volume[sets.root(t[0])] += part;
    total += part;
  }
  double largest = 0;
  for (const double part : volume) largest = std::max(largest, std::fabs(part));
  const double limit = std::min(share * std::fabs(total), largest);
  const auto dropped = [&](std::uint32_t v) { return std::fabs(volume[sets.root(v)]) < limit; };

  std::int64_t count = 0;
  TriangleSoup kept;
  std::vector<std::uint32_t> number(surface.points.size(), 0);
  for (std::uint32_t v = 0; v < surface.points.size(); ++v) {
    if (dropped(v)) {
      count += sets.root(v) == v ? 1 : 0;
      continue;
    }
    number[v] = static_cast<std::uint32_t>(kept.points.size());
    kept.points.push_back(surface.points[v]);
  }
  for (const Triangle& t : surface.triangles) {
    if (!dropped(t[0])) kept.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  surface = std::move(kept);
  return count;
}

}  // namespace cellocut
