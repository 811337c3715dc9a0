#include "cellocut/proxy/departure.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <compare>
#include <cstdint>
#include <span>

#include "cellocut/base/buckets.h"
#include "cellocut/base/raster_points.h"
#include "cellocut/field/sparse_grid.h"

namespace cellocut {

namespace {

constexpr double kRaster = 0.5;  // grid steps between samples

void add_sample(Departure& worst, FieldSampler& phi, const Point3& p) {
  const double sample = std::fabs(phi(p));
  if (sample > worst.distance) worst = {sample, p};
}

Departure worst_on_edge(const Point3& a, const Point3& b, FieldSampler& phi) {
  Departure worst;
  for_each_raster_point(a, b, kRaster, [&](const Point3& p) { add_sample(worst, phi, p); });
  return worst;
}

// An edge of a face, which other faces share: its ends, the lower one first.
struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  auto operator<=>(const Edge&) const = default;
};

// `side`: 3 f + k for the edge of face f from its corner k on.
Edge edge_of(const std::vector<Triangle>& faces, std::size_t side) {
  const Triangle& t = faces[side / 3];
  const auto [low, high] = std::minmax(t[side % 3], t[(side % 3 + 1) % 3]);
  return {low, high};
}

// How far the edge of each side departs; edges that faces share are measured once.
std::vector<Departure> measure_edges(const std::vector<Point3>& points,
                                     const std::vector<Triangle>& faces, const SparseField& phi) {
  const std::size_t sides = 3 * faces.size();
  // In buckets by the lower end, so that the edges are measured in the order of space.
  const auto shift = std::max(
      0, static_cast<int>(std::bit_width(points.size())) - static_cast<int>(std::bit_width(sides)));
  Buckets alike((points.size() >> shift) + 1, sides,
                [&](std::size_t side) { return edge_of(faces, side).low >> shift; });
  std::vector<Departure> worst(sides);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, alike.size(), 1024), [&](const auto& range) {
    FieldSampler sampler(phi);
    for (std::size_t bucket = range.begin(); bucket != range.end(); ++bucket) {
      const std::span<std::uint32_t> here = alike[bucket];
      std::sort(here.begin(), here.end(), [&](std::uint32_t a, std::uint32_t b) {
        return edge_of(faces, a) < edge_of(faces, b);
      });
      for (std::size_t n = 0; n < here.size(); ++n) {
        const Edge edge = edge_of(faces, here[n]);
        const bool known = n > 0 && edge_of(faces, here[n - 1]) == edge;
        worst[here[n]] = known ? worst[here[n - 1]]
                               : worst_on_edge(points[edge.low], points[edge.high], sampler);
      }
    }
  });
  return worst;
}

}  // namespace

std::vector<Departure> measure_faces(const std::vector<Point3>& points,
                                     const std::vector<Triangle>& faces, const SparseField& phi) {
  std::vector<Departure> worst(faces.size());
  const std::vector<Departure> on_edge = measure_edges(points, faces, phi);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 256), [&](const auto& range) {
    FieldSampler sampler(phi);
    for (std::size_t f = range.begin(); f != range.end(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Departure& edge = on_edge[3 * f + k];
        if (edge.distance > worst[f].distance) worst[f] = edge;
      }
      const Triangle& t = faces[f];
      for_each_inner_raster_point({points[t[0]], points[t[1]], points[t[2]]}, kRaster,
                                  [&](const Point3& p) { add_sample(worst[f], sampler, p); });
    }
  });
  return worst;
}

Departure measure_edge(const Point3& a, const Point3& b, const SparseField& phi) {
  FieldSampler sampler(phi);
  return worst_on_edge(a, b, sampler);
}

double largest_distance(const std::vector<Departure>& departures) {
  double largest = 0;
  for (const Departure& departure : departures) largest = std::max(largest, departure.distance);
  return largest;
}

}  // namespace cellocut
