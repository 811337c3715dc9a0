#include "cellocut/field/line_crossings.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

#include "cellocut/base/line_coverage.h"

namespace cellocut {

namespace {

struct Crossing {
  std::uint64_t line;
  double at;
  auto operator<=>(const Crossing&) const = default;
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

  // Count, then write: the same list for any number of threads.
  const std::vector<Triangle>& faces = mesh.triangles;
  std::vector<std::size_t> offset(faces.size() + 1, 0);
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t f) {
    for_each_crossing(faces[f], [&](std::uint64_t, double) { ++offset[f + 1]; });
  });
  for (std::size_t f = 0; f < faces.size(); ++f) offset[f + 1] += offset[f];
  std::vector<Crossing> crossings(offset.back());
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t f) {
    std::size_t next = offset[f];
    for_each_crossing(faces[f], [&](std::uint64_t line, double x) {
      crossings[next++] = {line, x};
    });
  });
  tbb::parallel_sort(crossings.begin(), crossings.end());

  first_.assign(static_cast<std::size_t>(extent_) * extent_ + 1, 0);
  crossing_.reserve(crossings.size());
  for (const Crossing& crossing : crossings) {
    ++first_[crossing.line + 1];
    crossing_.push_back(crossing.at);
  }
  for (std::size_t line = 1; line < first_.size(); ++line) first_[line] += first_[line - 1];
}

}  // namespace cellocut
