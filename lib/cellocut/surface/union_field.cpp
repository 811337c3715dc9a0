#include "cellocut/surface/union_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "cellocut/field/band.h"
#include "cellocut/field/leaf_walk.h"
#include "cellocut/field/line_crossings.h"
#include "cellocut/surface/interface.h"

namespace cellocut {

namespace {

using LeafPointer = std::unique_ptr<FieldLeaf>;

// A region of cells on the grid: its boundary, and which grid points lie in it.
class CellRegion {
 public:
  CellRegion(const TetComplex& complex, const CellLabels& region, const Frame& frame)
      : boundary_(interface_triangles(complex, list_interface(complex, region))),
        crossings_(boundary_, frame, 0),
        extent_(frame.extent) {}

  [[nodiscard]] const TriangleSoup& boundary() const { return boundary_; }

  [[nodiscard]] bool contains(const openvdb::Coord& at) const {
    return at.y() < extent_ && at.z() < extent_ && crossings_.inside(at.x(), at.y(), at.z());
  }
  // How many points of the cube lie in the region.
  [[nodiscard]] std::int64_t count(const Tile& tile) const {
    std::int64_t points = 0;
    for (int y = tile.low.y(); y < std::min(tile.low.y() + tile.edge, extent_); ++y) {
      for (int z = tile.low.z(); z < std::min(tile.low.z() + tile.edge, extent_); ++z) {
        points += crossings_.count_inside(tile.low.x(), tile.low.x() + tile.edge, y, z);
      }
    }
    return points;
  }

 private:
  TriangleSoup boundary_;
  LineCrossings crossings_;
  int extent_;
};

CellLabels absorbed_cells(const CellLabels& initial, const CellLabels& label) {
  CellLabels absorbed(label.size(), kExterior);
  for (std::size_t c = 0; c < label.size(); ++c) {
    if (initial[c] == kExterior && label[c] == kInterior) absorbed[c] = kInterior;
  }
  return absorbed;
}

// The blocks that either field has stored, by their first points.
std::vector<openvdb::Coord> merge_blocks(const FieldTree& phi,
                                         const std::vector<LeafPointer>& band) {
  std::vector<openvdb::Coord> blocks;
  for (auto leaf = phi.cbeginLeaf(); leaf; ++leaf) blocks.push_back(leaf->origin());
  for (const LeafPointer& leaf : band) blocks.push_back(leaf->origin());
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

void store(FieldLeaf& leaf, std::uint32_t offset, float value) {
  if (std::fabs(value) < kBand) {
    leaf.setValueOn(offset, value);
  } else {
    leaf.setValueOff(offset, value < 0 ? -kBand : kBand);
  }
}

// The blocks that hold the combined field, and their first points.
struct Blocks {
  std::vector<openvdb::Coord> low;
  std::vector<LeafPointer> leaves;
};

// min(phi, signed distance to the region) in one block.
LeafPointer combine(const openvdb::Coord& low, const FieldTree& phi, const FieldLeaf* distance,
                    const CellRegion& absorbed) {
  auto leaf = std::make_unique<FieldLeaf>(low, kBand, false);
  const FieldLeaf* phi_leaf = phi.probeConstLeaf(low);
  const float phi_tile = phi_leaf == nullptr ? phi.getValue(low) : 0.0F;
  for (std::uint32_t n = 0; n < FieldLeaf::SIZE; ++n) {
    const float thick = phi_leaf == nullptr ? phi_tile : phi_leaf->getValue(n);
    float region = distance == nullptr ? kBand : distance->getValue(n);
    if (absorbed.contains(low + FieldLeaf::offsetToLocalCoord(n))) region = -region;
    store(*leaf, n, std::min(thick, region));
  }
  return leaf;
}

// min(phi, signed distance to the absorbed region) wherever it is within the band.
Blocks combine(const FieldTree& phi, const CellRegion& absorbed, const Frame& frame,
               Observer& observer) {
  Band band;
  if (!absorbed.boundary().empty()) {
    const TriangleSet set = make_triangle_set(absorbed.boundary(), frame);
    band = find_band(set.triangles, frame.extent, 0.0, observer);
  }
  Blocks blocks;
  blocks.low = merge_blocks(phi, band.leaves);
  blocks.leaves.resize(blocks.low.size());
  FieldTree distance(kBand);
  for (LeafPointer& leaf : band.leaves) distance.addLeaf(leaf.release());
  tbb::parallel_for(std::size_t{0}, blocks.low.size(), [&](std::size_t n) {
    const openvdb::Coord& low = blocks.low[n];
    blocks.leaves[n] = combine(low, phi, distance.probeConstLeaf(low), absorbed);
  });
  observer.check();
  return blocks;
}

constexpr std::int64_t points_of(const Tile& tile) {
  return std::int64_t{tile.edge} * tile.edge * tile.edge;
}

// Adds blocks where the tile, which is outside, meets cells of the region: there its points are not
// all alike. What meets none stays a tile.
void split_tile(const Tile& tile, const CellRegion& region, Blocks& blocks) {
  if (region.count(tile) == 0) return;
  if (tile.edge == kLeafEdge) {
    blocks.low.push_back(tile.low);
    blocks.leaves.push_back(std::make_unique<FieldLeaf>(tile.low, kBand, false));
    return;
  }
  const int half = tile.edge / 2;
  for (int k = 0; k < 8; ++k) {
    const openvdb::Coord low =
        tile.low.offsetBy((k >> 2) * half, ((k >> 1) & 1) * half, (k & 1) * half);
    split_tile({low, half}, region, blocks);
  }
}

// The points of the blocks that are not solid, beyond the interior cells and in them.
struct OutsidePoints {
  std::vector<LeafMask> beyond_cells;
  std::vector<LeafMask> in_cells;
  std::int64_t solid_beyond_cells = 0;
};

OutsidePoints find_outside(const Blocks& blocks, const CellRegion& interior) {
  OutsidePoints outside;
  outside.beyond_cells.resize(blocks.low.size());
  outside.in_cells.resize(blocks.low.size());
  std::vector<std::int64_t> solid(blocks.low.size(), 0);
  tbb::parallel_for(std::size_t{0}, blocks.low.size(), [&](std::size_t block) {
    for (std::uint32_t n = 0; n < FieldLeaf::SIZE; ++n) {
      const bool in_cell = interior.contains(blocks.low[block] + FieldLeaf::offsetToLocalCoord(n));
      if (blocks.leaves[block]->getValue(n) > 0) {
        LeafMask& mask = (in_cell ? outside.in_cells : outside.beyond_cells)[block];
        add_point(mask, n);
      } else if (!in_cell) {
        ++solid[block];
      }
    }
  });
  outside.solid_beyond_cells = std::accumulate(solid.begin(), solid.end(), std::int64_t{0});
  return outside;
}

// How far, in grid steps, a point outside may lie within the interior cells: what the facets of the
// decimated proxy cut off the slab's outside. With three or more no closed point comes next to
// a tile that is outside, not even across a corner.
constexpr int kOpenSteps = 4;

constexpr float kLargestStored = kBand - 0x1p-15F;

}  // namespace

UnionField compute_union_field(const SparseField& phi, const TetComplex& complex,
                               const CellLabels& initial, const CellLabels& label,
                               const Frame& frame, Observer& observer) {
  const FieldTree& phi_tree = phi.grid().tree;
  const CellRegion absorbed(complex, absorbed_cells(initial, label), frame);
  const CellRegion interior(complex, label, frame);
  Blocks blocks = combine(phi_tree, absorbed, frame, observer);

  // Between the blocks neither field changes its sign.
  auto grid = std::make_shared<SparseField::Grid>();
  std::int64_t beyond = 0;
  for (const Tile& tile : tiles_between(blocks.low, frame.extent)) {
    if (phi_tree.getValue(tile.low) < 0 || absorbed.contains(tile.low)) {
      add_inside_tile(grid->tree, tile);
      beyond += points_of(tile) - interior.count(tile);
    } else {
      split_tile(tile, interior, blocks);
    }
  }
  observer.check();

  const OutsidePoints outside = find_outside(blocks, interior);
  std::vector<LeafMask> open = outside.beyond_cells;
  walk_leaves(blocks.low, grid->tree, outside.in_cells, kOpenSteps, open, observer);
  std::vector<std::int64_t> left_out(blocks.low.size(), 0);
  std::vector<std::int64_t> closed(blocks.low.size(), 0);
  tbb::parallel_for(std::size_t{0}, blocks.low.size(), [&](std::size_t block) {
    FieldLeaf& leaf = *blocks.leaves[block];
    for (std::uint32_t n = 0; n < FieldLeaf::SIZE; ++n) {
      if (!has_point(outside.in_cells[block], n)) continue;
      const bool stays = has_point(open[block], n);
      ++(stays ? left_out : closed)[block];
      // Stored even beyond the band: what stays and what does not may be neighbours there.
      const float value = std::min(leaf.getValue(n), kLargestStored);
      leaf.setValueOn(n, stays ? value : -value);
    }
  });
  for (LeafPointer& leaf : blocks.leaves) grid->tree.addLeaf(leaf.release());

  const auto sum = [](const std::vector<std::int64_t>& counts) {
    return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::int64_t{0}));
  };
  UnionField result;
  result.field = SparseField(std::move(grid));
  const double volume = frame.spacing * frame.spacing * frame.spacing;
  result.departures.beyond = static_cast<double>(beyond + outside.solid_beyond_cells) * volume;
  result.departures.left_out = sum(left_out) * volume;
  result.departures.closed = sum(closed) * volume;
  return result;
}

}  // namespace cellocut
