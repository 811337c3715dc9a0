// The completed regions of a surface, each with its margin, as small meshes of their own.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Depth of a vertex: the number of edges to the nearest completed vertex, 0 for those themselves.
// Vertices come in three groups, each in the order of the surface:
//   [0, movable)        depth 0 to the margin's width: they may move
//   [movable, rows)     the next ring: fixed, and the patch joins it smoothly
//   [rows, all)         one ring more: fixed, so that every row has all of its faces here
// Movable groups of different patches neither share vertices nor touch.
struct FairingPatch {
  std::vector<std::uint32_t> vertices;  // of the surface
  std::uint32_t movable = 0;
  std::uint32_t rows = 0;
  std::vector<std::uint8_t> depth;  // of every row
  std::vector<Triangle> faces;      // corners into `vertices`; every face at a row

  [[nodiscard]] bool has_rim() const { return rows > movable; }
};

// Connected regions of the vertices up to `margin_rings` edges away from one that is not
// `supported` (one byte per vertex, 0 or not), in the order of their first vertices. O(margin_rings
// n) with a small constant for the search, the rest O(size of the regions).
// Preconditions: margin_rings from 0 to 250; a byte for each point. Errors: Cancelled.
std::vector<FairingPatch> find_patches(const TriangleSoup& surface,
                                       const std::vector<std::uint8_t>& supported, int margin_rings,
                                       const Observer& observer);

}  // namespace cellocut
