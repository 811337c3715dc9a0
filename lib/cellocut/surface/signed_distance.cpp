#include "cellocut/surface/signed_distance.h"

#include <tbb/parallel_for.h>

#include "cellocut/field/band.h"
#include "cellocut/field/line_crossings.h"

namespace cellocut {

SparseField compute_signed_distance(const TriangleSoup& boundary, const Frame& frame,
                                    Observer& observer) {
  const TriangleSet set = make_triangle_set(boundary, frame);
  Band band = find_band(set.triangles, frame.extent, 0.0, observer);
  const LineCrossings crossings(boundary, frame, 0);
  tbb::parallel_for(std::size_t{0}, band.leaves.size(), [&](std::size_t n) {
    for (auto value = band.leaves[n]->beginValueOn(); value; ++value) {
      const openvdb::Coord at = value.getCoord();
      if (crossings.inside(at.x(), at.y(), at.z())) value.setValue(-*value);
    }
  });
  auto grid = std::make_shared<SparseField::Grid>();
  for (std::unique_ptr<FieldLeaf>& leaf : band.leaves) grid->tree.addLeaf(leaf.release());
  return SparseField(std::move(grid));
}

}  // namespace cellocut
