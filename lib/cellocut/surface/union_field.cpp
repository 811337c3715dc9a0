#include "cellocut/surface/union_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "cellocut/field/band.h"
#include "cellocut/field/grid_components.h"
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

}  // namespace

UnionField compute_union_field(const SparseField& phi, const TetComplex& complex,
                               const CellLabels& initial, const CellLabels& label,
                               const Frame& frame, Observer& observer) {
  const FieldTree& phi_tree = phi.grid().tree;
  const CellRegion absorbed(complex, absorbed_cells(initial, label), frame);
  const CellRegion interior(complex, label, frame);
  Band band;
  if (!absorbed.boundary().empty()) {
    const TriangleSet set = make_triangle_set(absorbed.boundary(), frame);
    band = find_band(set.triangles, frame.extent, 0.0, observer);
  }
  FieldTree distance(kBand);
  const std::vector<openvdb::Coord> blocks = merge_blocks(phi_tree, band.leaves);
  for (LeafPointer& leaf : band.leaves) distance.addLeaf(leaf.release());
  std::vector<LeafPointer> leaves(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t n) {
    leaves[n] = combine(blocks[n], phi_tree, distance.probeConstLeaf(blocks[n]), absorbed);
  });
  distance.clear();
  observer.check();

  // Between the blocks neither field changes its sign.
  const auto tile_inside = [&](const Tile& tile) {
    return phi_tree.getValue(tile.low) < 0 || absorbed.contains(tile.low);
  };
  GridComponents outside(blocks, tiles_between(blocks, frame.extent));
  outside.join(
      [&](std::size_t leaf, std::uint32_t offset) { return leaves[leaf]->getValue(offset) > 0; },
      [&](const Tile& tile) { return !tile_inside(tile); },
      [](const openvdb::Coord&, int) { return true; }, observer);

  // Which components hold a point that is not in an interior cell, and how the solid departs from
  // the cells.
  const std::vector<Tile>& tiles = outside.tiles();
  std::vector<std::int64_t> tile_interior(tiles.size());
  tbb::parallel_for(std::size_t{0}, tiles.size(),
                    [&](std::size_t n) { tile_interior[n] = interior.count(tiles[n]); });
  struct LeafCounts {
    std::int64_t beyond = 0;    // solid, not in an interior cell
    std::int64_t left_out = 0;  // not solid, in an interior cell
    std::vector<std::uint32_t> open;
  };
  std::vector<LeafCounts> counts(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t leaf) {
    LeafCounts& count = counts[leaf];
    for (std::uint32_t n = 0; n < FieldLeaf::SIZE; ++n) {
      const bool in_cell = interior.contains(blocks[leaf] + FieldLeaf::offsetToLocalCoord(n));
      const std::uint32_t component = outside.of_point(leaf, n);
      if (component == GridComponents::kNone) {
        count.beyond += in_cell ? 0 : 1;
      } else if (in_cell) {
        ++count.left_out;
      } else if (count.open.empty() || count.open.back() != component) {
        count.open.push_back(component);
      }
    }
  });
  std::vector<std::uint8_t> open(outside.node_count(), 0);
  std::int64_t beyond = 0;
  std::int64_t left_out = 0;
  for (const LeafCounts& count : counts) {
    beyond += count.beyond;
    left_out += count.left_out;
    for (const std::uint32_t component : count.open) open[component] = 1;
  }
  for (std::size_t n = 0; n < tiles.size(); ++n) {
    const std::int64_t points = std::int64_t{tiles[n].edge} * tiles[n].edge * tiles[n].edge;
    const std::uint32_t component = outside.of_tile(n);
    if (component == GridComponents::kNone) {
      beyond += points - tile_interior[n];
    } else {
      left_out += tile_interior[n];
      if (tile_interior[n] < points) open[component] = 1;
    }
  }

  // Close the others.
  UnionField result;
  std::vector<std::int64_t> pocket_points(blocks.size(), 0);
  const auto is_pocket = [&](std::uint32_t component) {
    return component != GridComponents::kNone && open[component] == 0;
  };
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t leaf) {
    for (std::uint32_t n = 0; n < FieldLeaf::SIZE; ++n) {
      if (!is_pocket(outside.of_point(leaf, n))) continue;
      store(*leaves[leaf], n, -leaves[leaf]->getValue(n));
      ++pocket_points[leaf];
    }
  });
  std::int64_t closed_points =
      std::accumulate(pocket_points.begin(), pocket_points.end(), std::int64_t{0});
  auto grid = std::make_shared<SparseField::Grid>();
  for (std::size_t n = 0; n < tiles.size(); ++n) {
    if (tile_inside(tiles[n])) add_inside_tile(grid->tree, tiles[n]);
    if (!is_pocket(outside.of_tile(n))) continue;
    add_inside_tile(grid->tree, tiles[n]);
    closed_points += std::int64_t{tiles[n].edge} * tiles[n].edge * tiles[n].edge;
  }
  for (LeafPointer& leaf : leaves) grid->tree.addLeaf(leaf.release());
  for (std::uint32_t node = 0; node < outside.node_count(); ++node) {
    if (outside.names_component(node) && is_pocket(node)) ++result.departures.pockets;
  }
  const double volume = frame.spacing * frame.spacing * frame.spacing;
  result.field = SparseField(std::move(grid));
  result.departures.beyond = static_cast<double>(beyond) * volume;
  result.departures.left_out = static_cast<double>(left_out - closed_points) * volume;
  result.departures.pocket_volume = static_cast<double>(closed_points) * volume;
  return result;
}

}  // namespace cellocut
