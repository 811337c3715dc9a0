#include "cellocut/surface/pull.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "cellocut/surface/crease_slide.h"
#include "cellocut/surface/retreat.h"
#include "cellocut/validity/incidence.h"

namespace cellocut {

namespace {

// What became of supported vertices.
struct Outcome {
  std::int64_t supported = 0;
  std::int64_t shifted = 0;
  std::int64_t stopped_early = 0;
  std::int64_t went_back = 0;

  Outcome& operator+=(const Outcome& other) {
    supported += other.supported;
    shifted += other.shifted;
    stopped_early += other.stopped_early;
    went_back += other.went_back;
    return *this;
  }
};

}  // namespace

Quantiles quantiles_of(std::span<double> values) {
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
                         Observer& observer, Coordinates coordinates) {
  const std::size_t count = surface.points.size();
  // (Memory that the threads touch first, each its part.)
  const auto from = std::make_unique_for_overwrite<Point3[]>(count);
  const auto to = std::make_unique_for_overwrite<Point3[]>(count);
  const auto sides = std::make_unique_for_overwrite<Point3[]>(count);
  const auto offset = std::make_unique_for_overwrite<double[]>(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    from[v] = surface.points[v];
    to[v] = from[v];
    sides[v] = {};
    offset[v] = 0;
    if (supported[v] == 0) return;
    NearestPoint nearest = input(from[v], 1.25 * expected);
    if (!nearest.found()) nearest = input(from[v]);
    offset[v] = nearest.distance;
    if (!(nearest.distance > distance)) return;
    sides[v] = (1 / nearest.distance) * (from[v] - nearest.point);
    to[v] = kept(nearest.point + distance * sides[v], coordinates);
    offset[v] = coordinates == Coordinates::doubles ? distance : norm(to[v] - nearest.point);
  });
  const Buckets corners_at = corners_by_point(surface.triangles, count);
  const CreaseSlide slide({from.get(), count}, surface.triangles, corners_at, {sides.get(), count},
                          input, expected, distance);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    surface.points[v] = kept(slide(static_cast<std::uint32_t>(v), to[v]), coordinates);
  });
  observer.check();
  Retreat moved = move_vertices({from.get(), count}, {to.get(), count}, std::move(surface.points),
                                surface.triangles, corners_at, observer, coordinates);
  const Outcome outcome = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count), Outcome{},
      [&](const auto& range, Outcome sum) {
        for (std::size_t v = range.begin(); v < range.end(); ++v) {
          if (supported[v] == 0) continue;
          const bool shifted = moved.is_beyond(v, to[v]);
          if (shifted || moved.halvings[v] > 0) offset[v] = input(moved.points[v]).distance;
          sum += {.supported = 1,
                  .shifted = shifted,
                  .stopped_early = moved.halvings[v] > 0 && moved.halvings[v] < Retreat::kStayed,
                  .went_back = moved.halvings[v] == Retreat::kStayed};
        }
        return sum;
      },
      [](Outcome a, const Outcome& b) { return a += b; });
  surface.points = std::move(moved.points);

  std::size_t left = 0;  // of `offset`, those of supported vertices
  for (std::size_t v = 0; v < count; ++v) {
    if (supported[v] != 0) offset[left++] = offset[v];
  }
  return {.distance = distance,
          .vertices = static_cast<std::int64_t>(count),
          .supported = outcome.supported,
          .shifted = outcome.shifted,
          .stopped_early = outcome.stopped_early,
          .went_back = outcome.went_back,
          .bad_faces_at_first = moved.bad_faces_at_first,
          .rounds = moved.rounds,
          .offset = quantiles_of({offset.get(), left})};
}

}  // namespace cellocut
