#include "cellocut/surface/cell_region.h"

#include "cellocut/surface/interface.h"

namespace cellocut {

CellRegion::CellRegion(const TetComplex& complex, const CellLabels& region, const Frame& frame)
    : boundary_(interface_triangles(complex, list_interface(complex, region))),
      crossings_(boundary_, frame, 0),
      extent_(frame.extent) {}

LeafMask CellRegion::points_of_leaf(const openvdb::Coord& low) const {
  LeafMask mask{};  // by x, as leaves are ordered
  for (int y = 0; y < kLeafEdge; ++y) {
    for (int z = 0; z < kLeafEdge; ++z) {
      const std::uint64_t points = row(low.x(), low.y() + y, low.z() + z, kLeafEdge);
      for (int x = 0; x < kLeafEdge; ++x) {
        mask[x] |= (points >> x & 1U) << (kLeafEdge * y + z);
      }
    }
  }
  return mask;
}

std::int64_t CellRegion::count(const Tile& tile) const {
  std::int64_t points = 0;
  for (int y = tile.low.y(); y < std::min(tile.low.y() + tile.edge, extent_); ++y) {
    for (int z = tile.low.z(); z < std::min(tile.low.z() + tile.edge, extent_); ++z) {
      points += crossings_.count_inside(tile.low.x(), tile.low.x() + tile.edge, y, z);
    }
  }
  return points;
}

}  // namespace cellocut
