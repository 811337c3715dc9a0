#include "cellocut/field/flood_sign.h"

#include <array>

#include "cellocut/field/band.h"
#include "cellocut/field/grid_components.h"
#include "cellocut/field/line_crossings.h"

namespace cellocut {

SparseField compute_flood_signed_distance(const TriangleSoup& mesh, const Frame& frame,
                                          Observer& observer) {
  const TriangleSet set = make_triangle_set(mesh, frame);
  Band band = find_band(set.triangles, frame.extent, 0.0, observer);
  const std::array<LineCrossings, 3> crossings{
      LineCrossings(mesh, frame, 0), LineCrossings(mesh, frame, 1), LineCrossings(mesh, frame, 2)};
  // No face comes near a tile. Leaves reach past the extent, where no line is named and no face is.
  const auto joined = [&](const openvdb::Coord& at, int axis) {
    const int j = at[(axis + 1) % 3];
    const int k = at[(axis + 2) % 3];
    return j >= frame.extent || k >= frame.extent ||
           !crossings[axis].crossed(at[axis], at[axis] + 1, j, k);
  };
  std::vector<openvdb::Coord> origins;
  for (const std::unique_ptr<FieldLeaf>& leaf : band.leaves) origins.push_back(leaf->origin());
  GridComponents components(std::move(origins), std::move(band.outside));
  components.join([](std::size_t, std::uint32_t) { return true; }, [](const Tile&) { return true; },
                  joined, observer);
  const std::uint32_t outside = components.at(openvdb::Coord(0, 0, 0));

  auto grid = std::make_shared<SparseField::Grid>();
  for (std::size_t n = 0; n < components.tiles().size(); ++n) {
    if (components.of_tile(n) != outside) add_inside_tile(grid->tree, components.tiles()[n]);
  }
  for (std::size_t n = 0; n < band.leaves.size(); ++n) {
    FieldLeaf& leaf = *band.leaves[n];
    for (openvdb::Index offset = 0; offset < FieldLeaf::SIZE; ++offset) {
      if (components.of_point(n, offset) != outside) {
        leaf.setValueOnly(offset, -leaf.getValue(offset));
      }
    }
  }
  for (std::unique_ptr<FieldLeaf>& leaf : band.leaves) grid->tree.addLeaf(leaf.release());
  return SparseField(std::move(grid));
}

}  // namespace cellocut
