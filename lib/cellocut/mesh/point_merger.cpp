#include "cellocut/mesh/point_merger.h"

#include <algorithm>
#include <limits>

#include "cellocut/base/errors.h"
#include "cellocut/base/point_hash.h"

namespace cellocut::mesh_io {

std::uint32_t PointMerger::index_of(const Point3& point, std::vector<Point3>& points) {
  if (points.size() * 2 >= slots_.size()) grow(points);
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(point) & mask;
  while (slots_[slot] != 0) {
    if (points[slots_[slot] - 1] == point) return slots_[slot] - 1;
    slot = (slot + 1) & mask;
  }
  if (points.size() == std::numeric_limits<std::uint32_t>::max() - 1) {
    throw InputError("more than 4294967294 vertices");
  }
  points.push_back(point);
  slots_[slot] = static_cast<std::uint32_t>(points.size());
  return slots_[slot] - 1;
}

void PointMerger::grow(const std::vector<Point3>& points) {
  slots_.assign(std::max<std::size_t>(64, slots_.size() * 2), 0);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::size_t slot = hash_of(points[i]) & mask;
    while (slots_[slot] != 0) slot = (slot + 1) & mask;
    slots_[slot] = static_cast<std::uint32_t>(i + 1);
  }
}

}  // namespace cellocut::mesh_io
