#include "cellocut/proxy/departure.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cellocut/base/raster_points.h"
#include "cellocut/field/sparse_grid.h"

namespace cellocut {

namespace {

constexpr double kRaster = 0.5;  // grid steps between samples

void add_sample(Departure& worst, FieldSampler& phi, const Point3& p) {
  const double sample = std::fabs(phi(p));
  if (sample > worst.distance) worst = {sample, p};
}

}  // namespace

std::vector<Departure> measure_faces(const std::vector<Point3>& points,
                                     const std::vector<Triangle>& faces, const SparseField& phi) {
  std::vector<Departure> worst(faces.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 256),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      FieldSampler sampler(phi);
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        const Triangle& t = faces[i];
                        for_each_raster_point(
                            {points[t[0]], points[t[1]], points[t[2]]}, kRaster,
                            [&](const Point3& p) { add_sample(worst[i], sampler, p); });
                      }
                    });
  return worst;
}

Departure measure_edge(const Point3& a, const Point3& b, const SparseField& phi) {
  Departure worst;
  FieldSampler sampler(phi);
  for_each_raster_point(a, b, kRaster, [&](const Point3& p) { add_sample(worst, sampler, p); });
  return worst;
}

double largest_distance(const std::vector<Departure>& departures) {
  double largest = 0;
  for (const Departure& departure : departures) largest = std::max(largest, departure.distance);
  return largest;
}

}  // namespace cellocut
