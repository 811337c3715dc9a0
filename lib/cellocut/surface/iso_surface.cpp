#include "cellocut/surface/iso_surface.h"

#include <tbb/parallel_for.h>

#include <bit>
#include <unordered_map>

#include "cellocut/base/errors.h"
#include "cellocut/field/sparse_grid.h"
#include "cellocut/surface/cube_table.h"

namespace cellocut {

namespace {

constexpr int kEdge = kLeafEdge;    // 8 grid points along a block
constexpr int kPadded = kEdge + 1;  // with the first layer of the next block
constexpr int kPoints = kEdge * kEdge * kEdge;
constexpr std::uint32_t kNoBlock = 0xFFFFFFFFU;

// Bit n stands for grid point (n >> 6, (n >> 3) & 7, n & 7) of a block.
class BlockMask {
 public:
  void set(int n) { words_[n >> 6] |= std::uint64_t{1} << (n & 63); }
  // To be called once all bits are set, before count_before and count.
  void number() {
    for (int w = 0; w < 8; ++w) {
      before_[w + 1] = static_cast<std::uint16_t>(before_[w] + std::popcount(words_[w]));
    }
  }
  [[nodiscard]] int count_before(int n) const {
    const std::uint64_t below = (std::uint64_t{1} << (n & 63)) - 1;
    return before_[n >> 6] + std::popcount(words_[n >> 6] & below);
  }
  [[nodiscard]] bool test(int n) const { return ((words_[n >> 6] >> (n & 63)) & 1) != 0; }
  [[nodiscard]] int count() const { return before_[8]; }

 private:
  std::array<std::uint64_t, 8> words_{};
  std::array<std::uint16_t, 9> before_{};  // bits in the words before
};

// A block and what it owns: the vertices on grid edges that start in it, in the order x-edges,
// y-edges, z-edges, then the inner points of its cells.
struct Block {
  const FieldLeaf* leaf = nullptr;
  openvdb::Coord low;
  // The blocks that begin at low + 8 * (n & 1, (n >> 1) & 1, n >> 2); [0] is this one.
  std::array<std::uint32_t, 8> next{};
  std::array<BlockMask, 3> cut;
  std::uint32_t first_vertex = 0;
  std::uint32_t inner_points = 0;
  std::size_t first_triangle = 0;
  std::size_t triangles = 0;

  [[nodiscard]] int edge_vertices() const {
    return cut[0].count() + cut[1].count() + cut[2].count();
  }
};

constexpr int point_number(int x, int y, int z) { return (x * kEdge + y) * kEdge + z; }

// Values of a block and of the layer beyond it; `stored` is false where the band does not reach.
struct PaddedValues {
  std::array<float, kPadded * kPadded * kPadded> value;
  std::array<bool, kPadded * kPadded * kPadded> stored;

  static constexpr int at(int x, int y, int z) { return (x * kPadded + y) * kPadded + z; }

  PaddedValues(const std::vector<Block>& blocks, const Block& block) {
    stored.fill(false);
    for (int n = 0; n < 8; ++n) {
      if (block.next[n] == kNoBlock) continue;
      const FieldLeaf& leaf = *blocks[block.next[n]].leaf;
      const int x0 = (n & 1) * kEdge;
      const int y0 = ((n >> 1) & 1) * kEdge;
      const int z0 = (n >> 2) * kEdge;
      for (int x = x0; x < (x0 == 0 ? kEdge : kPadded); ++x) {
        for (int y = y0; y < (y0 == 0 ? kEdge : kPadded); ++y) {
          for (int z = z0; z < (z0 == 0 ? kEdge : kPadded); ++z) {
            const auto offset = static_cast<openvdb::Index>(point_number(x - x0, y - y0, z - z0));
            value[at(x, y, z)] = leaf.getValue(offset);
            stored[at(x, y, z)] = leaf.isValueOn(offset);
          }
        }
      }
    }
  }

  // The sign pattern of the cell at (x, y, z), or 0 where the zero set does not pass through it: a
  // cell that it does pass through has all corners in the band.
  [[nodiscard]] int pattern(int x, int y, int z) const {
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
      const int n = at(x + (c & 1), y + ((c >> 1) & 1), z + (c >> 2));
      if (!stored[n]) return 0;
      if (value[n] < 0) inside |= 1 << c;
    }
    return inside;
  }
};

template <class Visit>
void for_each_point(const Visit& visit) {
  for (int x = 0; x < kEdge; ++x) {
    for (int y = 0; y < kEdge; ++y) {
      for (int z = 0; z < kEdge; ++z) visit(x, y, z);
    }
  }
}

std::vector<Block> list_blocks(const FieldTree& tree) {
  std::vector<Block> blocks;
  blocks.reserve(tree.leafCount());
  std::unordered_map<const FieldLeaf*, std::uint32_t> number;
  number.reserve(tree.leafCount());
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
    number.emplace(&*leaf, static_cast<std::uint32_t>(blocks.size()));
    blocks.emplace_back();
    blocks.back().leaf = &*leaf;
    blocks.back().low = leaf->origin();
  }
  tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
    for (int n = 0; n < 8; ++n) {
      const FieldLeaf* leaf = tree.probeConstLeaf(
          blocks[b].low.offsetBy((n & 1) * kEdge, ((n >> 1) & 1) * kEdge, (n >> 2) * kEdge));
      blocks[b].next[n] = leaf == nullptr ? kNoBlock : number.at(leaf);
    }
  });
  return blocks;
}

void count_block(const std::vector<Block>& blocks, Block& block) {
  const PaddedValues values(blocks, block);
  for_each_point([&](int x, int y, int z) {
    const int here = PaddedValues::at(x, y, z);
    if (!values.stored[here]) return;
    for (int axis = 0; axis < 3; ++axis) {
      const int there = PaddedValues::at(x + (axis == 0 ? 1 : 0), y + (axis == 1 ? 1 : 0),
                                         z + (axis == 2 ? 1 : 0));
      if (values.stored[there] && (values.value[here] < 0) != (values.value[there] < 0)) {
        block.cut[axis].set(point_number(x, y, z));
      }
    }
    const CubeCase& cube = cube_table()[values.pattern(x, y, z)];
    block.triangles += cube.triangles.size();
    block.inner_points += cube.inner_loop.empty() ? 0 : 1;
  });
  for (BlockMask& cut : block.cut) cut.number();
}

// Number of the vertex on an edge of the cell at (x, y, z), which another block may own.
std::uint32_t edge_vertex(const std::vector<Block>& blocks, const Block& block, int x, int y, int z,
                          int edge) {
  const int corner = edge_low_corner(edge);
  x += corner & 1;
  y += (corner >> 1) & 1;
  z += corner >> 2;
  const int n = (x / kEdge) | ((y / kEdge) << 1) | ((z / kEdge) << 2);
  if (block.next[n] == kNoBlock) throw Error("iso-surface: the field is not a distance field");
  const Block& owner = blocks[block.next[n]];
  const int axis = edge_axis(edge);
  const int point = point_number(x % kEdge, y % kEdge, z % kEdge);
  if (!owner.cut[axis].test(point)) throw Error("iso-surface: the field is not a distance field");
  int rank = owner.cut[axis].count_before(point);
  for (int a = 0; a < axis; ++a) rank += owner.cut[a].count();
  return owner.first_vertex + static_cast<std::uint32_t>(rank);
}

void place_vertices(const std::vector<Block>& blocks, const Block& block, TriangleSoup& surface) {
  const PaddedValues values(blocks, block);
  std::uint32_t vertex = block.first_vertex;
  for (int axis = 0; axis < 3; ++axis) {
    for_each_point([&](int x, int y, int z) {
      if (!block.cut[axis].test(point_number(x, y, z))) return;
      const double here = values.value[PaddedValues::at(x, y, z)];
      const double there = values.value[PaddedValues::at(
          x + (axis == 0 ? 1 : 0), y + (axis == 1 ? 1 : 0), z + (axis == 2 ? 1 : 0))];
      const double t = here / (here - there);
      Point3 p{static_cast<double>(block.low.x() + x), static_cast<double>(block.low.y() + y),
               static_cast<double>(block.low.z() + z)};
      p[axis] += std::clamp(t, kClearance, 1 - kClearance);
      surface.points[vertex++] = p;
    });
  }
}

void place_triangles(const std::vector<Block>& blocks, const Block& block, TriangleSoup& surface) {
  const PaddedValues values(blocks, block);
  std::size_t triangle = block.first_triangle;
  std::uint32_t inner = block.first_vertex + static_cast<std::uint32_t>(block.edge_vertices());
  for_each_point([&](int x, int y, int z) {
    const int pattern = values.pattern(x, y, z);
    if (pattern == 0 || pattern == 255) return;
    const CubeCase& cube = cube_table()[pattern];
    for (const std::array<std::uint8_t, 3>& corners : cube.triangles) {
      Triangle& face = surface.triangles[triangle++];
      for (int k = 0; k < 3; ++k) {
        face[k] =
            corners[k] == kInnerPoint ? inner : edge_vertex(blocks, block, x, y, z, corners[k]);
      }
    }
    if (cube.inner_loop.empty()) return;
    Point3 sum{};
    for (const std::uint8_t edge : cube.inner_loop) {
      sum = sum + surface.points[edge_vertex(blocks, block, x, y, z, edge)];
    }
    surface.points[inner++] = (1.0 / static_cast<double>(cube.inner_loop.size())) * sum;
  });
}

}  // namespace

TriangleSoup extract_iso_surface(const SparseField& field) {
  TriangleSoup surface;
  if (field.empty()) return surface;
  std::vector<Block> blocks = list_blocks(field.grid().tree);
  tbb::parallel_for(std::size_t{0}, blocks.size(),
                    [&](std::size_t b) { count_block(blocks, blocks[b]); });
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  for (Block& block : blocks) {
    block.first_vertex = static_cast<std::uint32_t>(vertices);
    block.first_triangle = triangles;
    vertices += block.edge_vertices() + block.inner_points;
    triangles += block.triangles;
  }
  if (vertices > 0xFFFFFFFEU) throw LimitError("iso-surface: more than 2^32 vertices");
  surface.points.resize(vertices);
  surface.triangles.resize(triangles);
  tbb::parallel_for(std::size_t{0}, blocks.size(),
                    [&](std::size_t b) { place_vertices(blocks, blocks[b], surface); });
  tbb::parallel_for(std::size_t{0}, blocks.size(),
                    [&](std::size_t b) { place_triangles(blocks, blocks[b], surface); });
  return surface;
}

void to_input_units(TriangleSoup& surface, const Frame& frame) {
  tbb::parallel_for(std::size_t{0}, surface.points.size(),
                    [&](std::size_t i) { surface.points[i] = frame.to_input(surface.points[i]); });
}

void to_index_coordinates(TriangleSoup& surface, const Frame& frame) {
  tbb::parallel_for(std::size_t{0}, surface.points.size(),
                    [&](std::size_t i) { surface.points[i] = frame.to_index(surface.points[i]); });
}

}  // namespace cellocut
