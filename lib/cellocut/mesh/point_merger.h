// Gives points of equal coordinates one index, in the order of their first appearance (the two
// zeros are equal; the first one's bits stay). Internal to the mesh files.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/point.h"

namespace cellocut::mesh_io {

class PointMerger {
 public:
  // Appends `point` to `points` unless an equal one is there. Every call must pass the same vector,
  // and nobody else may change it. Expected O(1).
  std::uint32_t index_of(const Point3& point, std::vector<Point3>& points);

 private:
  void grow(const std::vector<Point3>& points);
  // Open addressing with linear probing: index + 1, or 0 where free. A power of two in size.
  std::vector<std::uint32_t> slots_;
};

}  // namespace cellocut::mesh_io
