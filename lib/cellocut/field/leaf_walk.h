// Short walks over the points of a sparse grid. Internal to the fields (OpenVDB types).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/field/sparse_grid.h"

namespace cellocut {

// A set of the points of a leaf: of the point (x, y, z) in it bit 8 y + z of word x.
using LeafMask = std::array<std::uint64_t, kLeafEdge>;

// `offset`: of the point in its leaf, as OpenVDB counts.
inline bool has_point(const LeafMask& mask, std::uint32_t offset) {
  return (mask[offset / 64] >> (offset % 64) & 1) != 0;
}

// Adds to `reached` those points of `through` to which a path of at most `steps` grid edges leads
// from a reached point, all of whose points are reached or in `through`. Masks are by leaf;
// `leaves` are their first points. What is in no leaf is reached where `elsewhere` is positive.
// O(steps * leaves); the same result for any number of threads. Errors: Cancelled.
void walk_leaves(const std::vector<openvdb::Coord>& leaves, const FieldTree& elsewhere,
                 const std::vector<LeafMask>& through, int steps, std::vector<LeafMask>& reached,
                 Observer& observer);

}  // namespace cellocut
