// Which points lie in the same place?
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/point.h"

namespace cellocut {

// For each point the smallest index among the points with equal coordinates (0.0 and -0.0 are
// equal; a point with a coordinate that is not finite is equal to none but itself). Expected O(n),
// O(n log n) at worst; parallel. Precondition: fewer than 2^32 points.
std::vector<std::uint32_t> merge_equal_positions(const std::vector<Point3>& points);

}  // namespace cellocut
