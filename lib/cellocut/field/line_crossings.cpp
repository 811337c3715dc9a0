#include "cellocut/field/line_crossings.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "cellocut/base/line_coverage.h"

namespace cellocut {

namespace {

struct Crossing {
  std::size_t line;
  double at;
};

}  // namespace

LineCrossings::LineCrossings(const TriangleSoup& mesh, const Frame& frame, int axis)
    : extent_(frame.extent) {
  // Coordinates turned so that the lines run along the first.
  std::vector<Point3> points(mesh.points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    const Point3 p = frame.to_index(mesh.points[i]);
    points[i] = {p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]};
  });

  const auto for_each_crossing = [&](const Triangle& face, const auto& visit) {
    const Point3& a = points[face[0]];
    const Point3& b = points[face[1]];
    const Point3& c = points[face[2]];
    const Point3 normal = cross(b - a, c - a);
    const double x_low = std::min({a[0], b[0], c[0]});
    const double x_high = std::max({a[0], b[0], c[0]});
    const int j0 = std::max(0, static_cast<int>(std::ceil(std::min({a[1], b[1], c[1]}))));
    const int j1 = std::min(extent_ - 1, static_cast<int>(std::max({a[1], b[1], c[1]})));
    const int k0 = std::max(0, static_cast<int>(std::ceil(std::min({a[2], b[2], c[2]}))));
    const int k1 = std::min(extent_ - 1, static_cast<int>(std::max({a[2], b[2], c[2]})));
    for (int j = j0; j <= j1; ++j) {
      for (int k = k0; k <= k1; ++k) {
        const Flat line{static_cast<double>(j), static_cast<double>(k)};
        if (!line_passes({a[1], a[2]}, {b[1], b[2]}, {c[1], c[2]}, line)) continue;
        const double rise = normal[1] * (j - a[1]) + normal[2] * (k - a[2]);
        const double x = normal[0] != 0 ? a[0] - rise / normal[0] : x_low;
        visit(line_number(j, k), std::clamp(x, x_low, x_high));
      }
    }
  };

  // Each thread lists what it finds; then each line puts its own in order: the same for any number
  // of threads.
  using Crossings = std::vector<Crossing>;
  tbb::enumerable_thread_specific<Crossings> parts;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 1024),
                    [&](const auto& range) {
                      Crossings& found = parts.local();
                      for (std::size_t f = range.begin(); f < range.end(); ++f) {
                        for_each_crossing(mesh.triangles[f], [&found](std::size_t line, double x) {
                          found.push_back({line, x});
                        });
                      }
                    });
  const auto for_each_found = [&parts](const auto& visit) {
    tbb::parallel_for(parts.range(1), [&](const auto& range) {
      for (const Crossings& found : range) {
        for (const Crossing& crossing : found) visit(crossing);
      }
    });
  };
  first_.assign(static_cast<std::size_t>(extent_) * extent_ + 1, 0);
  for_each_found([this](const Crossing& crossing) {
    std::atomic_ref(first_[crossing.line]).fetch_add(1, std::memory_order_relaxed);
  });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  crossing_.resize(first_.back());
  // Filling from the back turns each line's end into its begin.
  for_each_found([this](const Crossing& crossing) {
    const std::size_t place =
        std::atomic_ref(first_[crossing.line]).fetch_sub(1, std::memory_order_relaxed) - 1;
    crossing_[place] = crossing.at;
  });
  tbb::parallel_for(std::size_t{0}, first_.size() - 1, [this](std::size_t line) {
    std::sort(crossing_.begin() + static_cast<std::ptrdiff_t>(first_[line]),
              crossing_.begin() + static_cast<std::ptrdiff_t>(first_[line + 1]));
  });
}

}  // namespace cellocut
