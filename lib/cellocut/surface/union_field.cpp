#include "cellocut/surface/union_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>

#include "cellocut/base/lanes.h"
#include "cellocut/field/band.h"
#include "cellocut/field/leaf_walk.h"
#include "cellocut/surface/cell_region.h"

namespace cellocut {

namespace {

using LeafPointer = std::unique_ptr<FieldLeaf>;

CellLabels absorbed_cells(const CellLabels& initial, const CellLabels& label) {
  CellLabels absorbed(label.size(), kExterior);
  for (std::size_t c = 0; c < label.size(); ++c) {
    if (initial[c] == kExterior && label[c] == kInterior) absorbed[c] = kInterior;
  }
  return absorbed;
}

// The blocks that the band of either field reaches, by their first points.
std::vector<openvdb::Coord> merge_blocks(const FieldTree& phi, const std::vector<BandLeaf>& band) {
  std::vector<openvdb::Coord> blocks;
  for (auto leaf = phi.cbeginLeaf(); leaf; ++leaf) blocks.push_back(leaf->origin());
  for (const BandLeaf& leaf : band) blocks.push_back(leaf.low);
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  return blocks;
}

constexpr std::int64_t points_of(const Tile& tile) {
  return std::int64_t{tile.edge} * tile.edge * tile.edge;
}

// Adds blocks where the tile, which is outside, meets cells of the region: there its points are not
// all alike. What meets none stays a tile.
void split_tile(const Tile& tile, const CellRegion& region, std::vector<openvdb::Coord>& blocks) {
  if (region.count(tile) == 0) return;
  if (tile.edge == kLeafEdge) {
    blocks.push_back(tile.low);
    return;
  }
  const int half = tile.edge / 2;
  for (int k = 0; k < 8; ++k) {
    const openvdb::Coord low =
        tile.low.offsetBy((k >> 2) * half, ((k >> 1) & 1) * half, (k & 1) * half);
    split_tile({low, half}, region, blocks);
  }
}

// phi in one block.
class BlockPhi {
 public:
  BlockPhi(const FieldTree& phi, const openvdb::Coord& low)
      : leaf_(phi.probeConstLeaf(low)), tile_(leaf_ == nullptr ? phi.getValue(low) : 0.0F) {}
  float operator[](std::uint32_t n) const {
    return leaf_ == nullptr ? tile_ : leaf_->buffer().data()[n];
  }
  [[nodiscard]] LeafMask positive() const {
    LeafMask mask{};
    if (leaf_ == nullptr) {
      if (tile_ > 0) mask.fill(~std::uint64_t{0});
      return mask;
    }
    const float* values = leaf_->buffer().data();
    for (std::uint32_t n = 0; n < FieldLeaf::SIZE; n += 4) {
      mask[n / 64] |= std::uint64_t{bits_of(four_at(values + n) > 0)} << (n % 64);
    }
    return mask;
  }

 private:
  const FieldLeaf* leaf_;
  float tile_;
};

using Masks = std::vector<LeafMask>;

// What the points of the blocks are, by block.
struct Points {
  Masks absorbed;   // in the absorbed region
  Masks in_cells;   // in an interior cell
  Masks outside;    // neither in the slab nor in the absorbed region
  Masks open;       // those of `outside` that stay so
  Masks near_open;  // those, and points at most three grid edges from one

  explicit Points(std::size_t blocks)
      : absorbed(blocks), in_cells(blocks), outside(blocks), open(blocks) {}
};

template <class Combine>
Masks combined(const Masks& a, const Masks& b, const Combine& combine) {
  Masks masks(a.size());
  for (std::size_t block = 0; block < masks.size(); ++block) {
    for (int x = 0; x < kLeafEdge; ++x) masks[block][x] = combine(a[block][x], b[block][x]);
  }
  return masks;
}

double count_points(const Masks& masks) {
  std::int64_t count = 0;
  for (const LeafMask& mask : masks) {
    for (const std::uint64_t word : mask) count += std::popcount(word);
  }
  return static_cast<double>(count);
}

// How far, in grid steps, a point outside may lie within the interior cells: what the facets of the
// decimated proxy cut off the slab's outside. With three or more no closed point comes next to
// a tile that is outside, not even across a corner.
constexpr int kOpenSteps = 4;

// `tiles`: negative where what lies between the blocks is inside.
Points classify(const std::vector<openvdb::Coord>& blocks, const FieldTree& phi,
                const CellRegion& absorbed, const CellRegion& interior, const FieldTree& tiles,
                Observer& observer) {
  Points points(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    points.absorbed[block] = absorbed.points_of_leaf(blocks[block]);
    points.in_cells[block] = interior.points_of_leaf(blocks[block]);
    points.outside[block] = BlockPhi(phi, blocks[block]).positive();
    for (int x = 0; x < kLeafEdge; ++x) points.outside[block][x] &= ~points.absorbed[block][x];
  });
  const Masks through = combined(points.outside, points.in_cells, std::bit_and<>());
  points.open = combined(points.outside, through, std::bit_xor<>());
  walk_leaves(blocks, tiles, through, kOpenSteps, points.open, observer);
  LeafMask all{};
  all.fill(~std::uint64_t{0});
  points.near_open = points.open;
  walk_leaves(blocks, tiles, Masks(blocks.size(), all), 3, points.near_open, observer);
  return points;
}

// More than the rounding of stored distances.
constexpr float kRounding = 0x1p-12F;
constexpr float kLargestStored = kBand - 0x1p-15F;

// The combined field in one block.
class Combination {
 public:
  Combination(const openvdb::Coord& low, const FieldTree& phi, const Points& points,
              std::size_t block)
      : low_(low), phi_(phi, low), points_(points), block_(block) {}

  // How far from the region's boundary a point must know to be, that the zero set of min(phi,
  // signed distance to the region) be exact, once points are closed. It passes only through cells
  // of the grid that have an open point, so what is not near one need not know: most of the
  // boundary of what a solid has absorbed lies behind its slab. Outside the region the minimum is
  // phi unless the distance is less, and negative in the slab.
  [[nodiscard]] LeafReach reach() const {
    LeafReach reach;
    for (std::uint32_t n = 0; n < FieldLeaf::SIZE; ++n) {
      if (!has_point(points_.near_open[block_], n)) {
        reach[n] = -1;
      } else if (has_point(points_.absorbed[block_], n)) {
        reach[n] = kBand;
      } else {
        reach[n] = phi_[n] < 0 ? -1 : std::min(phi_[n] + kRounding, kBand);
      }
    }
    return reach;
  }

  // `distance` from the region's boundary, where it is within the reach.
  [[nodiscard]] LeafPointer leaf(const FieldLeaf& distance) const {
    auto leaf = std::make_unique<FieldLeaf>(low_, kBand, false);
    float* values = leaf->buffer().data();
    const float* distances = distance.buffer().data();
    FieldLeaf::NodeMaskType stored;
    for (std::uint32_t x = 0; x < kLeafEdge; ++x) {
      const std::uint64_t absorbed = points_.absorbed[block_][x];
      const std::uint64_t open = points_.open[block_][x];
      // Stored even beyond the band: what stays and what does not may be neighbours there.
      const std::uint64_t chosen = points_.outside[block_][x] & points_.in_cells[block_][x];
      std::uint64_t in_band = 0;
      for (std::uint32_t bit = 0; bit < 64; ++bit) {
        const std::uint32_t n = 64 * x + bit;
        const auto is = [bit](std::uint64_t word) { return (word >> bit & 1U) != 0; };
        const float value = std::min(phi_[n], is(absorbed) ? -distances[n] : distances[n]);
        if (is(chosen)) {
          const float size = std::min(value, kLargestStored);
          values[n] = is(open) ? size : -size;
        } else {
          values[n] = std::clamp(value, -kBand, kBand);
          in_band |= std::uint64_t{std::fabs(value) < kBand ? 1U : 0U} << bit;
        }
      }
      stored.getWord<std::uint64_t>(x) = in_band | chosen;
    }
    leaf->setValueMask(stored);
    return leaf;
  }

 private:
  const openvdb::Coord& low_;
  BlockPhi phi_;
  const Points& points_;
  std::size_t block_;
};

}  // namespace

UnionField compute_union_field(const SparseField& phi, const TetComplex& complex,
                               const CellLabels& initial, const CellLabels& label,
                               const Frame& frame, Observer& observer) {
  const FieldTree& phi_tree = phi.grid().tree;
  const CellRegion absorbed(complex, absorbed_cells(initial, label), frame);
  const CellRegion interior(complex, label, frame);
  TriangleSet boundary;
  std::vector<BandLeaf> band;
  if (!absorbed.boundary().empty()) {
    boundary = make_triangle_set(absorbed.boundary(), frame);
    band = list_band(boundary.triangles, frame.extent, observer);
  }
  std::vector<openvdb::Coord> blocks = merge_blocks(phi_tree, band);

  // Between the blocks neither field changes its sign.
  auto grid = std::make_shared<SparseField::Grid>();
  double beyond = 0;
  for (const Tile& tile : tiles_between(blocks, frame.extent)) {
    if (phi_tree.getValue(tile.low) < 0 || absorbed.contains(tile.low)) {
      add_inside_tile(grid->tree, tile);
      beyond += static_cast<double>(points_of(tile) - interior.count(tile));
    } else {
      split_tile(tile, interior, blocks);
    }
  }
  observer.check();

  const Points points = classify(blocks, phi_tree, absorbed, interior, grid->tree, observer);
  LeafDistances distances(boundary.triangles, 0.0);
  std::vector<LeafPointer> leaves(blocks.size());
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    const Combination combination(blocks[block], phi_tree, points, block);
    FieldLeaf distance(blocks[block], kBand, false);
    const auto near = std::lower_bound(
        band.begin(), band.end(), blocks[block],
        [](const BandLeaf& leaf, const openvdb::Coord& low) { return leaf.low < low; });
    if (near != band.end() && near->low == blocks[block]) {
      const LeafReach reach = combination.reach();
      if (std::any_of(reach.begin(), reach.end(), [](float x) { return x >= 0; })) {
        distances.fill(distance, near->candidates, &reach);
      }
    }
    leaves[block] = combination.leaf(distance);
  });
  observer.check();
  for (LeafPointer& leaf : leaves) grid->tree.addLeaf(leaf.release());

  UnionField result;
  result.field = SparseField(std::move(grid));
  const auto solid_beyond = [](std::uint64_t outside, std::uint64_t in_cells) {
    return ~outside & ~in_cells;
  };
  const Masks outside_in_cells = combined(points.outside, points.in_cells, std::bit_and<>());
  const Masks stays = combined(outside_in_cells, points.open, std::bit_and<>());
  const double volume = frame.spacing * frame.spacing * frame.spacing;
  beyond += count_points(combined(points.outside, points.in_cells, solid_beyond));
  result.departures.beyond = beyond * volume;
  result.departures.left_out = count_points(stays) * volume;
  result.departures.closed = (count_points(outside_in_cells) - count_points(stays)) * volume;
  return result;
}

}  // namespace cellocut
