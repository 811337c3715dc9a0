#include "cellocut/field/leaf_walk.h"

#include <tbb/parallel_for.h>

#include <unordered_map>

namespace cellocut {

namespace {

constexpr std::uint64_t kFirstOfRows = 0x0101010101010101U;  // z = 0
constexpr std::uint64_t kLastOfRows = kFirstOfRows << 7;     // z = 7
constexpr int kPlane = kLeafEdge * (kLeafEdge - 1);          // from y = 0 to y = 7

// The points next to those of `inner` along a grid edge. `beside`: the leaves (or what stands for
// them) before and after it along x, y, z.
LeafMask neighbours(const LeafMask& inner, const std::array<LeafMask, 6>& beside) {
  LeafMask found{};
  for (int x = 0; x < kLeafEdge; ++x) {
    const std::uint64_t here = inner[x];
    const std::uint64_t before = x > 0 ? inner[x - 1] : beside[0][kLeafEdge - 1];
    const std::uint64_t after = x + 1 < kLeafEdge ? inner[x + 1] : beside[1][0];
    found[x] = before | after;
    found[x] |= here << kLeafEdge | beside[2][x] >> kPlane;
    found[x] |= here >> kLeafEdge | beside[3][x] << kPlane;
    found[x] |= (here & ~kLastOfRows) << 1 | (beside[4][x] & kLastOfRows) >> (kLeafEdge - 1);
    found[x] |= (here & ~kFirstOfRows) >> 1 | (beside[5][x] & kFirstOfRows) << (kLeafEdge - 1);
  }
  return found;
}

constexpr std::uint32_t kEmptyBeside = 0xFFFFFFFFU;
constexpr std::uint32_t kFullBeside = 0xFFFFFFFEU;

// By leaf: the six beside it, or what it has there in place of a leaf.
std::vector<std::array<std::uint32_t, 6>> leaves_beside(const std::vector<openvdb::Coord>& leaves,
                                                        const FieldTree& elsewhere) {
  std::unordered_map<openvdb::Coord, std::uint32_t> at;
  at.reserve(leaves.size());
  for (std::uint32_t n = 0; n < leaves.size(); ++n) at[leaves[n]] = n;
  std::vector<std::array<std::uint32_t, 6>> beside(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    for (int side = 0; side < 6; ++side) {
      openvdb::Coord low = leaves[n];
      low[side / 2] += side % 2 == 0 ? -kLeafEdge : kLeafEdge;
      const auto found = at.find(low);
      if (found != at.end()) {
        beside[n][side] = found->second;
      } else {
        beside[n][side] = elsewhere.getValue(low) > 0 ? kFullBeside : kEmptyBeside;
      }
    }
  });
  return beside;
}

}  // namespace

void walk_leaves(const std::vector<openvdb::Coord>& leaves, const FieldTree& elsewhere,
                 const std::vector<LeafMask>& through, int steps, std::vector<LeafMask>& reached,
                 Observer& observer) {
  LeafMask full{};
  full.fill(~std::uint64_t{0});
  const auto beside = leaves_beside(leaves, elsewhere);
  std::vector<LeafMask> next(leaves.size());
  for (int step = 0; step < steps; ++step) {
    observer.check();
    tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
      std::array<LeafMask, 6> around{};
      for (int side = 0; side < 6; ++side) {
        const std::uint32_t other = beside[n][side];
        if (other == kFullBeside) {
          around[side] = full;
        } else if (other != kEmptyBeside) {
          around[side] = reached[other];
        }
      }
      const LeafMask found = neighbours(reached[n], around);
      for (int x = 0; x < kLeafEdge; ++x) next[n][x] = reached[n][x] | (found[x] & through[n][x]);
    });
    reached.swap(next);
  }
}

}  // namespace cellocut
