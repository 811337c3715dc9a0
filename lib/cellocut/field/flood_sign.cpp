#include "cellocut/field/flood_sign.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <unordered_map>

#include "cellocut/field/band.h"
#include "cellocut/field/line_crossings.h"

namespace cellocut {

namespace {

constexpr std::uint32_t kNothing = 0xFFFFFFFFU;
constexpr std::uint32_t kLeafPoints = FieldLeaf::SIZE;

// Union-find over the grid points of all leaves and over the tiles between them.
class Flood {
 public:
  Flood(const Band& band, const TriangleSoup& mesh, const Frame& frame)
      : band_(band),
        extent_(frame.extent),
        crossings_{LineCrossings(mesh, frame, 0), LineCrossings(mesh, frame, 1),
                   LineCrossings(mesh, frame, 2)} {
    for (std::uint32_t n = 0; n < band.leaves.size(); ++n) {
      block_[key(band.leaves[n]->origin(), kLeafEdge)] = n;
    }
    const auto leaves = static_cast<std::uint32_t>(band.leaves.size());
    for (std::uint32_t n = 0; n < band.outside.size(); ++n) {
      block_[key(band.outside[n].low, band.outside[n].edge)] = leaves + n;
      largest_ = std::max(largest_, band.outside[n].edge);
    }
    parent_.resize(std::size_t{leaves} * kLeafPoints + band.outside.size());
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  void run(Observer& observer) {
    for (std::uint32_t n = 0; n < band_.leaves.size(); ++n) {
      if (n % 1024 == 0) observer.check();
      join_leaf(n);
    }
    for (const Tile& tile : band_.outside) join_tile(tile);
    outside_ = find(node_at(openvdb::Coord(0, 0, 0)));
  }

  [[nodiscard]] bool reached(const openvdb::Coord& at) { return find(node_at(at)) == outside_; }

 private:
  static std::uint64_t key(const openvdb::Coord& at, int edge) {
    const auto cell = [edge](int x) { return static_cast<std::uint64_t>(x / edge) & 0x3FFFF; };
    const auto level = static_cast<std::uint64_t>(__builtin_ctz(static_cast<unsigned>(edge)));
    return (level << 54) | (cell(at.x()) << 36) | (cell(at.y()) << 18) | cell(at.z());
  }

  // The node of a grid point: itself in a leaf, the tile that holds it elsewhere.
  [[nodiscard]] std::uint32_t node_at(const openvdb::Coord& at) const {
    if (at.x() < 0 || at.y() < 0 || at.z() < 0) return kNothing;
    const auto leaves = static_cast<std::uint32_t>(band_.leaves.size());
    for (int edge = kLeafEdge; edge <= std::max(largest_, kLeafEdge); edge *= 2) {
      const auto found = block_.find(key(at, edge));
      if (found == block_.end()) continue;
      if (found->second >= leaves) return leaves * kLeafPoints + (found->second - leaves);
      return found->second * kLeafPoints + FieldLeaf::coordToOffset(at);
    }
    return kNothing;
  }

  [[nodiscard]] bool is_tile(std::uint32_t node) const {
    return node != kNothing && node >= band_.leaves.size() * kLeafPoints;
  }

  void join_leaf(std::uint32_t n) {
    const FieldLeaf& leaf = *band_.leaves[n];
    for (std::uint32_t offset = 0; offset < kLeafPoints; ++offset) {
      const openvdb::Coord at = leaf.offsetToGlobalCoord(offset);
      for (int axis = 0; axis < 3; ++axis) {
        if ((at[axis] & (kLeafEdge - 1)) == 0) {
          // A tile before this leaf; a leaf there joins by itself.
          openvdb::Coord before = at;
          before[axis] -= 1;
          const std::uint32_t node = node_at(before);
          if (is_tile(node)) unite(n * kLeafPoints + offset, node);
        }
        // Leaves reach past the extent, where no line is named and no face is.
        const int j = at[(axis + 1) % 3];
        const int k = at[(axis + 2) % 3];
        if (j < extent_ && k < extent_ && crossings_[axis].crossed(at[axis], at[axis] + 1, j, k)) {
          continue;
        }
        openvdb::Coord beyond = at;
        beyond[axis] += 1;
        const bool same_leaf = (at[axis] & (kLeafEdge - 1)) != kLeafEdge - 1;
        unite(n * kLeafPoints + offset,
              same_leaf ? n * kLeafPoints + FieldLeaf::coordToOffset(beyond) : node_at(beyond));
      }
    }
  }

  // A tile and what begins or ends at the middle of its sides, if that is as large or larger;
  // smaller neighbours join from their own side. No face comes near a tile, so nothing is in the
  // way.
  void join_tile(const Tile& tile) {
    const std::uint32_t here = node_at(tile.low);
    for (int axis = 0; axis < 3; ++axis) {
      openvdb::Coord before = tile.low;
      before[axis] -= 1;
      openvdb::Coord beyond = tile.low;
      beyond[axis] += tile.edge;
      unite(here, node_at(before));
      unite(here, node_at(beyond));
    }
  }

  std::uint32_t find(std::uint32_t a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    if (a == kNothing || b == kNothing) return;
    parent_[find(a)] = find(b);
  }

  const Band& band_;
  int extent_;
  std::array<LineCrossings, 3> crossings_;
  std::unordered_map<std::uint64_t, std::uint32_t> block_;  // leaves, then outside tiles
  int largest_ = 0;
  std::vector<std::uint32_t> parent_;
  std::uint32_t outside_ = kNothing;
};

}  // namespace

SparseField compute_flood_signed_distance(const TriangleSoup& mesh, const Frame& frame,
                                          Observer& observer) {
  const TriangleSet set = make_triangle_set(mesh, frame);
  Band band = find_band(set.triangles, frame.extent, 0.0, observer);
  Flood flood(band, mesh, frame);
  flood.run(observer);
  auto grid = std::make_shared<SparseField::Grid>();
  for (const Tile& tile : band.outside) {
    if (!flood.reached(tile.low)) add_inside_tile(grid->tree, tile);
  }
  for (const std::unique_ptr<FieldLeaf>& leaf : band.leaves) {
    for (openvdb::Index offset = 0; offset < kLeafPoints; ++offset) {
      if (!flood.reached(leaf->offsetToGlobalCoord(offset))) {
        leaf->setValueOnly(offset, -leaf->getValue(offset));
      }
    }
  }
  for (std::unique_ptr<FieldLeaf>& leaf : band.leaves) grid->tree.addLeaf(leaf.release());
  return SparseField(std::move(grid));
}

}  // namespace cellocut
