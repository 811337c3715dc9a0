// Connected components of grid points: over the blocks of a sparse grid point by point, over the
// space between them cube by cube. Internal to the fields (OpenVDB types).
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/field/band.h"

namespace cellocut {

class GridComponents {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  // Leaves (by their first points) and tiles have to be disjoint.
  GridComponents(std::vector<openvdb::Coord> leaves, std::vector<Tile> tiles);

  // Joins what is connected along grid edges. `member(leaf, offset)` says whether a point of a leaf
  // belongs to any component, `tile_member(tile)` the same for all points of a tile, and
  // `joined(at, axis)` whether a member and the next one along the axis are connected (asked only
  // where at least one of the two is in a leaf; a tile is connected in itself and to tiles beside
  // it). Parallel in the leaves; `member` and `joined` are called from any thread.
  template <class Member, class TileMember, class Joined>
  void join(const Member& member, const TileMember& tile_member, const Joined& joined,
            Observer& observer);

  // The component of a point of a leaf, or of a tile; kNone where it belongs to none. Components
  // are named by one of their nodes. Only after join().
  [[nodiscard]] std::uint32_t of_point(std::size_t leaf, std::uint32_t offset) const {
    const std::uint16_t local = local_[leaf][offset];
    return local == kNoLocal ? kNone : parent_[first_node_[leaf] + local];
  }
  [[nodiscard]] std::uint32_t of_tile(std::size_t tile) const {
    return tile_member_[tile] != 0 ? parent_[tile_node(tile)] : kNone;
  }
  // The component at a grid point with coordinates >= 0.
  [[nodiscard]] std::uint32_t at(const openvdb::Coord& point) const {
    const std::uint32_t node = node_at(point);
    return node == kNone ? kNone : parent_[node];
  }
  [[nodiscard]] const std::vector<Tile>& tiles() const { return tiles_; }

 private:
  static constexpr std::uint32_t kLeafPoints = FieldLeaf::SIZE;
  static constexpr std::uint16_t kNoLocal = 0xFFFFU;
  using Local = std::array<std::uint16_t, kLeafPoints>;

  static openvdb::Coord beyond(openvdb::Coord at, int axis, int step) {
    at[axis] += step;
    return at;
  }

  [[nodiscard]] std::uint32_t tile_node(std::size_t tile) const {
    return first_node_.back() + static_cast<std::uint32_t>(tile);
  }
  // The node of a grid point: a local component of its leaf or a tile; kNone where it is neither.
  [[nodiscard]] std::uint32_t node_at(const openvdb::Coord& at) const;
  [[nodiscard]] bool is_tile(std::uint32_t node) const {
    return node != kNone && node >= first_node_.back();
  }
  void join_tile(std::size_t tile);

  // Numbers the components of a leaf by itself; returns how many there are.
  template <class Member, class Joined>
  std::uint32_t number_leaf(std::size_t leaf, const Member& member, const Joined& joined);

  void unite(std::uint32_t a, std::uint32_t b) {
    if (a == kNone || b == kNone) return;
    const auto root = [this](std::uint32_t x) {
      while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
      return x;
    };
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

  std::vector<openvdb::Coord> leaves_;
  std::vector<Tile> tiles_;
  std::unordered_map<std::uint64_t, std::uint32_t> block_;  // leaves, then tiles
  int largest_tile_ = 0;
  std::vector<Local> local_;
  std::vector<std::uint32_t> first_node_;  // per leaf; the last: the first tile's
  std::vector<std::uint8_t> tile_member_;
  std::vector<std::uint32_t> parent_;  // after join(): of every node its component
};

template <class Member, class Joined>
std::uint32_t GridComponents::number_leaf(std::size_t leaf, const Member& member,
                                          const Joined& joined) {
  Local parent;
  for (std::uint32_t n = 0; n < kLeafPoints; ++n) {
    parent[n] = member(leaf, n) ? static_cast<std::uint16_t>(n) : kNoLocal;
  }
  const auto root = [&parent](std::uint16_t n) {
    while (parent[n] != n) n = parent[n] = parent[parent[n]];
    return n;
  };
  for (std::uint32_t n = 0; n < kLeafPoints; ++n) {
    if (parent[n] == kNoLocal) continue;
    const openvdb::Coord at = FieldLeaf::offsetToLocalCoord(n);
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] == kLeafEdge - 1) continue;
      const std::uint32_t next = FieldLeaf::coordToOffset(beyond(at, axis, 1));
      if (parent[next] == kNoLocal || !joined(leaves_[leaf] + at, axis)) continue;
      const std::uint16_t a = root(static_cast<std::uint16_t>(n));
      const std::uint16_t b = root(static_cast<std::uint16_t>(next));
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  // Roots come before the points below them, so they have their numbers by then.
  Local& local = local_[leaf];
  std::uint16_t count = 0;
  for (std::uint32_t n = 0; n < kLeafPoints; ++n) {
    if (parent[n] == kNoLocal) {
      local[n] = kNoLocal;
    } else {
      local[n] = parent[n] == n ? count++ : local[root(static_cast<std::uint16_t>(n))];
    }
  }
  return count;
}

template <class Member, class TileMember, class Joined>
void GridComponents::join(const Member& member, const TileMember& tile_member, const Joined& joined,
                          Observer& observer) {
  std::vector<std::uint32_t> count(leaves_.size());
  local_.resize(leaves_.size());
  tbb::parallel_for(std::size_t{0}, leaves_.size(),
                    [&](std::size_t leaf) { count[leaf] = number_leaf(leaf, member, joined); });
  observer.check();
  first_node_.assign(leaves_.size() + 1, 0);
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    first_node_[leaf + 1] = first_node_[leaf] + count[leaf];
  }
  tile_member_.resize(tiles_.size());
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    tile_member_[tile] = tile_member(tiles_[tile]) ? 1 : 0;
  }
  parent_.resize(first_node_.back() + tiles_.size());
  std::iota(parent_.begin(), parent_.end(), 0U);

  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    if (leaf % 1024 == 0) observer.check();
    if (count[leaf] == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      for (int u = 0; u < kLeafEdge; ++u) {
        for (int v = 0; v < kLeafEdge; ++v) {
          openvdb::Coord first = leaves_[leaf];
          first[(axis + 1) % 3] += u;
          first[(axis + 2) % 3] += v;
          const openvdb::Coord last = beyond(first, axis, kLeafEdge - 1);
          // A leaf before this one joins by itself; a tile there does not.
          const std::uint16_t first_local = local_[leaf][FieldLeaf::coordToOffset(first)];
          const openvdb::Coord before = beyond(first, axis, -1);
          if (first_local != kNoLocal && before[axis] >= 0) {
            const std::uint32_t node = node_at(before);
            if (is_tile(node) && joined(before, axis)) {
              unite(first_node_[leaf] + first_local, node);
            }
          }
          const std::uint16_t last_local = local_[leaf][FieldLeaf::coordToOffset(last)];
          if (last_local == kNoLocal) continue;
          const std::uint32_t node = node_at(beyond(last, axis, 1));
          if (node != kNone && joined(last, axis)) unite(first_node_[leaf] + last_local, node);
        }
      }
    }
  }
  for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
    if (tile_member_[tile] != 0) join_tile(tile);
  }
  // Parents come before their children.
  for (std::uint32_t& parent : parent_) parent = parent_[parent];
}

}  // namespace cellocut
