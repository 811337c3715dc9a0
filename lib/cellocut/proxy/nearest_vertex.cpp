#include "cellocut/proxy/nearest_vertex.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>

namespace cellocut {

namespace {

constexpr int kReach = 2;  // cells around the point's own

std::uint64_t cell_key(int x, int y, int z) {
  // One step of room below zero, for the cells around a point on the border.
  const auto part = [](int value) { return static_cast<std::uint64_t>(value + kReach) & 0x1FFFFF; };
  return (part(x) << 42) | (part(y) << 21) | part(z);
}

}  // namespace

NearestVertex::NearestVertex(const std::vector<Point3>& points)
    : points_(points), entries_(points.size()) {
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    const Point3& p = points[i];
    entries_[i] = {cell_key(static_cast<int>(p[0]), static_cast<int>(p[1]), static_cast<int>(p[2])),
                   static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(entries_.begin(), entries_.end());
}

std::uint32_t NearestVertex::operator()(const Point3& p,
                                        std::span<const std::uint32_t> excluded) const {
  const int x = static_cast<int>(p[0]);
  const int y = static_cast<int>(p[1]);
  const int z = static_cast<int>(p[2]);
  double nearest = std::numeric_limits<double>::infinity();
  std::uint32_t winner = kNone;
  for (int i = x - kReach; i <= x + kReach; ++i) {
    for (int j = y - kReach; j <= y + kReach; ++j) {
      const std::uint64_t last = cell_key(i, j, z + kReach);
      for (auto entry = std::lower_bound(entries_.begin(), entries_.end(),
                                         Entry{cell_key(i, j, z - kReach), 0});
           entry != entries_.end() && entry->cell <= last; ++entry) {
        const double squared = squared_norm(points_[entry->point] - p);
        if (squared > nearest || (squared == nearest && entry->point > winner)) continue;
        if (std::find(excluded.begin(), excluded.end(), entry->point) == excluded.end()) {
          nearest = squared;
          winner = entry->point;
        }
      }
    }
  }
  return winner;
}

}  // namespace cellocut
