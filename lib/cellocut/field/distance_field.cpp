#include "cellocut/field/distance_field.h"

#include "cellocut/field/band.h"

namespace cellocut {

SparseField compute_distance_field(const TriangleSoup& mesh, const Frame& frame, double offset,
                                   Observer& observer) {
  const TriangleSet set = make_triangle_set(mesh, frame);
  Band band = find_band(set.triangles, frame.extent, offset, observer);
  auto grid = std::make_shared<SparseField::Grid>();
  for (std::unique_ptr<FieldLeaf>& leaf : band.leaves) grid->tree.addLeaf(leaf.release());
  for (const Tile& tile : band.inside) add_inside_tile(grid->tree, tile);
  return SparseField(std::move(grid));
}

}  // namespace cellocut
