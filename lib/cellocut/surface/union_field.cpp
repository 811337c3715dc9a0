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

// The parts outside against the cells.
struct Comparison {
  std::vector<std::uint8_t> open;  // by component: holds a point that is in no interior cell
  std::int64_t beyond = 0;         // points of the solid in no interior cell
  std::int64_t left_out = 0;       // points outside in an interior cell
};

Comparison compare_with_cells(const Blocks& blocks, const GridComponents& outside,
                              const CellRegion& interior) {
  struct Counts {
    std::int64_t beyond = 0;
    std::int64_t left_out = 0;
    std::vector<std::uint32_t> open;
  };
  std::vector<Counts> counts(blocks.low.size());
  tbb::parallel_for(std::size_t{0}, blocks.low.size(), [&](std::size_t block) {
    Counts& count = counts[block];
    for (std::uint32_t n = 0; n < FieldLeaf::SIZE; ++n) {
      const bool in_cell = interior.contains(blocks.low[block] + FieldLeaf::offsetToLocalCoord(n));
      const std::uint32_t component = outside.of_point(block, n);
      if (component == GridComponents::kNone) {
        count.beyond += in_cell ? 0 : 1;
      } else if (in_cell) {
        ++count.left_out;
      } else if (count.open.empty() || count.open.back() != component) {
        count.open.push_back(component);
      }
    }
  });
  const std::vector<Tile>& tiles = outside.tiles();
  std::vector<std::int64_t> in_cells(tiles.size());
  tbb::parallel_for(std::size_t{0}, tiles.size(),
                    [&](std::size_t n) { in_cells[n] = interior.count(tiles[n]); });

  Comparison result;
  result.open.assign(outside.node_count(), 0);
  for (const Counts& count : counts) {
    result.beyond += count.beyond;
    result.left_out += count.left_out;
    for (const std::uint32_t component : count.open) result.open[component] = 1;
  }
  for (std::size_t n = 0; n < tiles.size(); ++n) {
    const std::uint32_t component = outside.of_tile(n);
    if (component == GridComponents::kNone) {
      result.beyond += points_of(tiles[n]) - in_cells[n];
    } else {
      result.left_out += in_cells[n];
      if (in_cells[n] < points_of(tiles[n])) result.open[component] = 1;
    }
  }
  return result;
}

}  // namespace

UnionField compute_union_field(const SparseField& phi, const TetComplex& complex,
                               const CellLabels& initial, const CellLabels& label,
                               const Frame& frame, Observer& observer) {
  const FieldTree& phi_tree = phi.grid().tree;
  const CellRegion absorbed(complex, absorbed_cells(initial, label), frame);
  const CellRegion interior(complex, label, frame);
  Blocks blocks = combine(phi_tree, absorbed, frame, observer);

  // Between the blocks neither field changes its sign.
  const auto is_solid = [&](const Tile& tile) {
    return phi_tree.getValue(tile.low) < 0 || absorbed.contains(tile.low);
  };
  GridComponents outside(blocks.low, tiles_between(blocks.low, frame.extent));
  outside.join(
      [&](std::size_t n, std::uint32_t offset) { return blocks.leaves[n]->getValue(offset) > 0; },
      [&](const Tile& tile) { return !is_solid(tile); },
      [](const openvdb::Coord&, int) { return true; }, observer);
  const Comparison cells = compare_with_cells(blocks, outside, interior);
  const auto is_pocket = [&](std::uint32_t component) {
    return component != GridComponents::kNone && cells.open[component] == 0;
  };

  // Close the pockets.
  std::vector<std::int64_t> closed(blocks.low.size(), 0);
  tbb::parallel_for(std::size_t{0}, blocks.low.size(), [&](std::size_t block) {
    FieldLeaf& leaf = *blocks.leaves[block];
    for (std::uint32_t n = 0; n < FieldLeaf::SIZE; ++n) {
      if (!is_pocket(outside.of_point(block, n))) continue;
      store(leaf, n, -leaf.getValue(n));
      ++closed[block];
    }
  });
  std::int64_t pocket_points = std::accumulate(closed.begin(), closed.end(), std::int64_t{0});
  auto grid = std::make_shared<SparseField::Grid>();
  for (std::size_t n = 0; n < outside.tiles().size(); ++n) {
    const Tile& tile = outside.tiles()[n];
    const bool pocket = is_pocket(outside.of_tile(n));
    if (pocket) pocket_points += points_of(tile);
    if (pocket || is_solid(tile)) add_inside_tile(grid->tree, tile);
  }
  for (LeafPointer& leaf : blocks.leaves) grid->tree.addLeaf(leaf.release());

  UnionField result;
  result.field = SparseField(std::move(grid));
  const double volume = frame.spacing * frame.spacing * frame.spacing;
  result.departures.beyond = static_cast<double>(cells.beyond) * volume;
  result.departures.left_out = static_cast<double>(cells.left_out - pocket_points) * volume;
  result.departures.pocket_volume = static_cast<double>(pocket_points) * volume;
  for (std::uint32_t node = 0; node < outside.node_count(); ++node) {
    if (outside.names_component(node) && is_pocket(node)) ++result.departures.pockets;
  }
  return result;
}

}  // namespace cellocut
