// Fewer points, evenly spread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cellocut/mesh/point_cloud.h"

namespace cellocut {

// The indices of points, ascending, that no two are closer than `spacing` to each other where their
// normals agree (a positive cosine), and that every point left out has one kept that is: a maximal
// Poisson-disc sample of the points (dart throwing; Cook, "Stochastic sampling in computer
// graphics", 1986). Points whose normals do not agree, as on the two sides of a sheet, do not see
// each other. The order in which points are tried is pseudo-random by their index and the seed.
//
// Preconditions: as many normals as points; spacing > 0 and at least 1e-6 of the extent of the
// points. Expected O(n).
std::vector<std::uint32_t> thin_to_spacing(const PointCloud& cloud, double spacing,
                                           std::uint64_t seed);

struct Thinning {
  std::vector<std::uint32_t> kept;  // ascending
  double spacing = 0;               // 0: nothing had to be left out
};

// Thins to at most `count` points, and as a rule to no less than 98 % of it, by the spacing that
// does so. Precondition: count >= 1; all points within a few units of the origin. Expected O(n) for
// each of some five spacings tried.
Thinning thin_to_count(const PointCloud& cloud, std::size_t count, std::uint64_t seed);

}  // namespace cellocut
