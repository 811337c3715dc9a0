#include "cellocut/surface/pull.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "cellocut/surface/retreat.h"

namespace cellocut {

Quantiles quantiles_of(std::vector<double> values) {
  if (values.empty()) return {};
  const auto at = [&values](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
  };
  return {at(0.5), at(0.95), at(1.0)};
}

PullReport pull_to_input(TriangleSoup& surface, const std::vector<std::uint8_t>& supported,
                         const NearestTriangle& input, double expected, double distance,
                         Observer& observer) {
  const std::size_t count = surface.points.size();
  PullReport report;
  report.distance = distance;
  report.vertices = static_cast<std::int64_t>(count);

  std::vector<Point3> to = surface.points;
  std::vector<double> offset(count, 0);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    if (supported[v] == 0) return;
    const Point3& from = surface.points[v];
    NearestPoint nearest = input(from, 1.25 * expected);
    if (!nearest.found()) nearest = input(from);
    offset[v] = nearest.distance;
    if (!(nearest.distance > distance)) return;
    to[v] = nearest.point + (distance / nearest.distance) * (from - nearest.point);
    offset[v] = distance;
  });
  observer.check();
  Retreat moved = move_vertices(surface.points, to, surface.triangles, observer);
  surface.points = std::move(moved.points);
  report.pairs_at_first = moved.pairs_at_first;
  report.rounds = moved.rounds;

  std::vector<double> offsets;
  for (std::size_t v = 0; v < count; ++v) {
    if (supported[v] == 0) continue;
    ++report.supported;
    if (moved.halvings[v] == Retreat::kStayed) ++report.went_back;
    if (moved.halvings[v] > 0 && moved.halvings[v] < Retreat::kStayed) ++report.stopped_early;
    offsets.push_back(moved.halvings[v] == 0 ? offset[v] : input(surface.points[v]).distance);
  }
  report.offset = quantiles_of(std::move(offsets));
  return report;
}

}  // namespace cellocut
