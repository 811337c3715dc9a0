#include "cellocut/surface/pull.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "cellocut/surface/crease_slide.h"
#include "cellocut/surface/retreat.h"
#include "cellocut/validity/incidence.h"

namespace cellocut {

Quantiles quantiles_of(std::vector<double> values) {
  if (values.empty()) return {};
  auto begin = values.begin();  // what ranks below the last one lies before
  const auto at = [&](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(begin, values.begin() + rank, values.end());
    begin = values.begin() + rank;
    return *begin;
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

  // (Memory that the threads touch first, each its part.)
  const auto targets = std::make_unique_for_overwrite<PullTarget[]>(count);
  std::vector<double> offset(count, 0);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    targets[v] = {};
    if (supported[v] == 0) return;
    const Point3& from = surface.points[v];
    NearestPoint nearest = input(from, 1.25 * expected);
    if (!nearest.found()) nearest = input(from);
    offset[v] = nearest.distance;
    if (!(nearest.distance > distance)) return;
    targets[v] = {nearest.point, (1 / nearest.distance) * (from - nearest.point)};
    offset[v] = distance;
  });
  const Buckets corners_at = corners_by_point(surface.triangles, count);
  const CreaseSlide slide(surface, corners_at, {targets.get(), count}, input, expected, distance);
  const auto to = std::make_unique_for_overwrite<Point3[]>(count);
  std::vector<Point3> beyond(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    const PullTarget& target = targets[v];
    to[v] = squared_norm(target.direction) == 0 ? surface.points[v]
                                                : target.nearest + distance * target.direction;
    beyond[v] = slide(static_cast<std::uint32_t>(v), to[v]);
  });
  observer.check();
  Retreat moved = move_vertices(surface.points, {to.get(), count}, std::move(beyond),
                                surface.triangles, corners_at, observer);
  report.bad_faces_at_first = moved.bad_faces_at_first;
  report.rounds = moved.rounds;

  const auto shifted = [&](std::size_t v) { return moved.is_beyond(v, to[v]); };
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    const bool as_asked = moved.halvings[v] == 0 && !shifted(v);
    if (supported[v] != 0 && !as_asked) offset[v] = input(moved.points[v]).distance;
  });
  std::size_t kept = 0;  // of `offset`, those of supported vertices
  for (std::size_t v = 0; v < count; ++v) {
    if (supported[v] == 0) continue;
    if (shifted(v)) ++report.shifted;
    if (moved.halvings[v] == Retreat::kStayed) ++report.went_back;
    if (moved.halvings[v] > 0 && moved.halvings[v] < Retreat::kStayed) ++report.stopped_early;
    offset[kept++] = offset[v];
  }
  surface.points = std::move(moved.points);
  report.supported = static_cast<std::int64_t>(kept);
  offset.resize(kept);
  report.offset = quantiles_of(std::move(offset));
  return report;
}

}  // namespace cellocut
