#include "cellocut/mesh/point_merger.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "cellocut/base/errors.h"

namespace cellocut::mesh_io {
namespace {

std::size_t hash_of(const Point3& point) {
  std::uint64_t hash = 0;
  for (const double coordinate : point) {
    // Adding +0 turns -0 into +0, so that equal coordinates have equal bits.
    hash ^= std::bit_cast<std::uint64_t>(coordinate + 0.0);
    hash *=
        0x9E3779B97F4A7C15u;  // 2^64 / golden ratio: multiplicative hashing (Knuth, TAOCP 3, 6.4)
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace

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
