#include "cellocut/field/grid_components.h"

namespace cellocut {

namespace {

std::uint64_t block_key(const openvdb::Coord& at, int edge) {
  const auto cell = [edge](int x) { return static_cast<std::uint64_t>(x / edge) & 0x3FFFF; };
  const auto level = static_cast<std::uint64_t>(__builtin_ctz(static_cast<unsigned>(edge)));
  return (level << 54) | (cell(at.x()) << 36) | (cell(at.y()) << 18) | cell(at.z());
}

}  // namespace

GridComponents::GridComponents(std::vector<openvdb::Coord> leaves, std::vector<Tile> tiles)
    : leaves_(std::move(leaves)), tiles_(std::move(tiles)) {
  block_.reserve(leaves_.size() + tiles_.size());
  for (std::uint32_t n = 0; n < leaves_.size(); ++n) block_[block_key(leaves_[n], kLeafEdge)] = n;
  for (std::uint32_t n = 0; n < tiles_.size(); ++n) {
    block_[block_key(tiles_[n].low, tiles_[n].edge)] =
        static_cast<std::uint32_t>(leaves_.size()) + n;
    largest_tile_ = std::max(largest_tile_, tiles_[n].edge);
  }
}

std::uint32_t GridComponents::node_at(const openvdb::Coord& at) const {
  if (at.x() < 0 || at.y() < 0 || at.z() < 0) return kNone;
  for (int edge = kLeafEdge; edge <= std::max(largest_tile_, kLeafEdge); edge *= 2) {
    const auto found = block_.find(block_key(at, edge));
    if (found == block_.end()) continue;
    if (found->second >= leaves_.size()) {
      const std::size_t tile = found->second - leaves_.size();
      return tile_member_[tile] != 0 ? tile_node(tile) : kNone;
    }
    const std::uint16_t local = local_[found->second][FieldLeaf::coordToOffset(at)];
    return local == kNoLocal ? kNone : first_node_[found->second] + local;
  }
  return kNone;
}

// With what begins or ends at the corners of its sides, if that is as large or larger; smaller
// neighbours join from their own side.
void GridComponents::join_tile(std::size_t tile) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int step : {-1, tiles_[tile].edge}) {
      const std::uint32_t node = node_at(beyond(tiles_[tile].low, axis, step));
      if (is_tile(node)) unite(tile_node(tile), node);
    }
  }
}

}  // namespace cellocut
