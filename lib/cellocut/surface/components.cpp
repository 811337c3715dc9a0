#include "cellocut/surface/components.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cellocut {

std::int64_t drop_small_components(TriangleSoup& surface, double share) {
  if (share <= 0 || surface.empty()) return 0;
  std::vector<std::uint32_t> root(surface.points.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&root](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (const Triangle& t : surface.triangles) {
    root[find(t[1])] = find(t[0]);
    root[find(t[2])] = find(t[0]);
  }
  std::vector<double> volume(surface.points.size(), 0);
  double total = 0;
  const Point3 origin = surface.points.front();
  for (const Triangle& t : surface.triangles) {
    const double part =
        six_volumes(origin, surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]) / 6;
    volume[find(t[0])] += part;
    total += part;
  }
  double largest = 0;
  for (const double part : volume) largest = std::max(largest, std::fabs(part));
  const double limit = std::min(share * std::fabs(total), largest);
  const auto dropped = [&](std::uint32_t v) { return std::fabs(volume[find(v)]) < limit; };

  std::int64_t count = 0;
  TriangleSoup kept;
  std::vector<std::uint32_t> number(surface.points.size(), 0);
  for (std::uint32_t v = 0; v < surface.points.size(); ++v) {
    if (dropped(v)) {
      count += find(v) == v ? 1 : 0;
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
