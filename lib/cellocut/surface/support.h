// Which vertices of a surface follow the input, and which lie where the cut completed it.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// How far a supported vertex may lie from phi = 0, in grid steps: linear interpolation along a grid
// edge is that much off around a sharp edge of the input.
inline constexpr double kSupportTolerance = 0.25;

// 1 for each vertex of an iso-surface (index coordinates) that lies on phi = 0, up to
// kSupportTolerance. Parallel; O(vertices).
std::vector<std::uint8_t> find_supported(const TriangleSoup& surface, const SparseField& phi);

}  // namespace cellocut
