// A region of cells on the grid: its boundary, and which grid points lie in it. Internal to the
// fields (OpenVDB types).
#pragma once

#include <algorithm>
#include <cstdint>

#include "cellocut/complex/tet_complex.h"
#include "cellocut/energy/energy.h"
#include "cellocut/field/band.h"
#include "cellocut/field/frame.h"
#include "cellocut/field/leaf_walk.h"
#include "cellocut/field/line_crossings.h"

namespace cellocut {

class CellRegion {
 public:
  // The cells labelled interior.
  CellRegion(const TetComplex& complex, const CellLabels& region, const Frame& frame);

  [[nodiscard]] const TriangleSoup& boundary() const { return boundary_; }

  [[nodiscard]] bool contains(const openvdb::Coord& at) const {
    return on_grid(at.y(), at.z()) && crossings_.inside(at.x(), at.y(), at.z());
  }
  // Bit i: whether the point (x + i, y, z) lies in the region, i < count <= 32.
  [[nodiscard]] std::uint32_t row(int x, int y, int z, int count) const {
    return on_grid(y, z) ? crossings_.inside_row(x, count, y, z) : 0;
  }
  // The points of the leaf that begins at `low`.
  [[nodiscard]] LeafMask points_of_leaf(const openvdb::Coord& low) const;
  // How many points of the cube lie in the region.
  [[nodiscard]] std::int64_t count(const Tile& tile) const;

 private:
  [[nodiscard]] bool on_grid(int y, int z) const {
    return std::min(y, z) >= 0 && std::max(y, z) < extent_;
  }

  TriangleSoup boundary_;
  LineCrossings crossings_;  // along x
  int extent_;
};

}  // namespace cellocut
