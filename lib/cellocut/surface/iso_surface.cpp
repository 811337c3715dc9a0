#include "cellocut/surface/iso_surface.h"

#include <tbb/parallel_for.h>

#include <bit>
#include <cstring>
#include <unordered_map>

#include "cellocut/base/errors.h"
#include "cellocut/base/lanes.h"
#include "cellocut/field/sparse_grid.h"
#include "cellocut/surface/cube_table.h"

namespace cellocut {

namespace {

constexpr int kEdge = kLeafEdge;    // 8 grid points along a block
constexpr int kPadded = kEdge + 1;  // with the first layer of the next block
constexpr std::uint32_t kNoBlock = 0xFFFFFFFFU;

// Bit n stands for grid point (n >> 6, (n >> 3) & 7, n & 7) of a block: a word for each x, in it
// eight bits for each y.
class BlockMask {
 public:
  // The eight points from (x, y, 0) on, of which none has been set before.
  void set_row(int x, int y, unsigned bits) { words_[x] |= std::uint64_t{bits} << (kEdge * y); }
  // To be called once all bits are set, before count and for_each.
  void number() {
    for (int x = 0; x < kEdge; ++x) {
      before_[x + 1] = static_cast<std::uint16_t>(before_[x] + std::popcount(words_[x]));
    }
  }
  [[nodiscard]] int count() const { return before_[kEdge]; }

  // Calls visit(x, y, z, how many bits are before it) for each bit with x < `layers`, in order.
  template <class Visit>
  void for_each(int layers, const Visit& visit) const {
    for (int x = 0; x < layers; ++x) {
      int rank = before_[x];
      for (std::uint64_t left = words_[x]; left != 0; left &= left - 1) {
        const int n = std::countr_zero(left);
        visit(x, n / kEdge, n % kEdge, rank++);
      }
    }
  }

 private:
  std::array<std::uint64_t, kEdge> words_{};
  std::array<std::uint16_t, kEdge + 1> before_{};  // bits in the words before
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

// The points of a block and of the layer beyond it, in arrays.
constexpr int padded(int x, int y, int z) { return (x * kPadded + y) * kPadded + z; }
constexpr int kPaddedPoints = kPadded * kPadded * kPadded;

// Values of a block and of the layer beyond it. Rows of points along z are bits.
class PaddedValues {
 public:
  PaddedValues(const std::vector<Block>& blocks, const Block& block) {
    for (int n = 0; n < 8; ++n) {
      if (block.next[n] == kNoBlock) continue;
      const FieldLeaf& leaf = *blocks[block.next[n]].leaf;
      const int x0 = (n & 1) * kEdge;
      const int y0 = ((n >> 1) & 1) * kEdge;
      const int z0 = (n >> 2) * kEdge;
      for (int x = 0; x < (x0 == 0 ? kEdge : 1); ++x) {
        const auto on = leaf.valueMask().getWord<std::uint64_t>(static_cast<openvdb::Index>(x));
        for (int y = 0; y < (y0 == 0 ? kEdge : 1); ++y) {
          const float* values = leaf.buffer().data() + (x * kEdge + y) * kEdge;
          const auto stored = static_cast<std::uint16_t>(on >> (kEdge * y) & 0xFFU);
          if (z0 == 0) {
            set_row(x0 + x, y0 + y, stored, values);
          } else {
            set_last(x0 + x, y0 + y, stored & 1U, values[0]);
          }
        }
      }
    }
  }

  [[nodiscard]] float operator()(int x, int y, int z) const { return value_[padded(x, y, z)]; }

  // By bits of z, which edges of the grid along the axis, from (x, y, z) on, the zero set cuts.
  [[nodiscard]] unsigned cut_edges(int x, int y, int axis) const {
    const unsigned stored = stored_[x][y];
    const unsigned inside = inside_[x][y];
    const int x1 = x + (axis == 0 ? 1 : 0);
    const int y1 = y + (axis == 1 ? 1 : 0);
    const int shift = axis == 2 ? 1 : 0;
    return stored & (stored_[x1][y1] >> shift) & (inside ^ (inside_[x1][y1] >> shift)) & 0xFFU;
  }

  // Calls visit(x, y, z, sign pattern) for each cell that the zero set passes through, in the order
  // of the points: it has all corners in the band.
  template <class Visit>
  void for_each_cut_cell(const Visit& visit) const {
    for (int x = 0; x < kEdge; ++x) {
      for (int y = 0; y < kEdge; ++y) {
        unsigned stored =
            stored_[x][y] & stored_[x + 1][y] & stored_[x][y + 1] & stored_[x + 1][y + 1];
        const std::array<unsigned, 4> rows{inside_[x][y], inside_[x + 1][y], inside_[x][y + 1],
                                           inside_[x + 1][y + 1]};
        const unsigned any = rows[0] | rows[1] | rows[2] | rows[3];
        const unsigned all = rows[0] & rows[1] & rows[2] & rows[3];
        unsigned left = stored & (stored >> 1U) & (any | any >> 1U) & ~(all & all >> 1U) & 0xFFU;
        for (; left != 0; left &= left - 1) {
          const int z = std::countr_zero(left);
          unsigned pattern = 0;
          for (unsigned c = 0; c < 4; ++c) {
            const unsigned pair = rows[c] >> static_cast<unsigned>(z);
            pattern |= (pair & 1U) << c | (pair >> 1U & 1U) << (c + 4);
          }
          visit(x, y, z, pattern);
        }
      }
    }
  }

 private:
  void set_row(int x, int y, std::uint16_t stored, const float* values) {
    std::memcpy(&value_[padded(x, y, 0)], values, kEdge * sizeof(float));
    stored_[x][y] |= stored;
    inside_[x][y] |= static_cast<std::uint16_t>(bits_of(four_at(values) < 0) |
                                                bits_of(four_at(values + 4) < 0) << 4U);
  }
  void set_last(int x, int y, unsigned stored, float value) {
    value_[padded(x, y, kEdge)] = value;
    stored_[x][y] |= static_cast<std::uint16_t>(stored << kEdge);
    inside_[x][y] |= static_cast<std::uint16_t>((value < 0 ? 1U : 0U) << kEdge);
  }

  std::array<float, kPaddedPoints> value_;
  std::array<std::array<std::uint16_t, kPadded>, kPadded> stored_{};  // in the band
  std::array<std::array<std::uint16_t, kPadded>, kPadded> inside_{};
};

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
  for (int x = 0; x < kEdge; ++x) {
    for (int y = 0; y < kEdge; ++y) {
      for (int axis = 0; axis < 3; ++axis) {
        block.cut[axis].set_row(x, y, values.cut_edges(x, y, axis));
      }
    }
  }
  for (BlockMask& cut : block.cut) cut.number();
  const std::array<CubeCase, 256>& table = cube_table();
  values.for_each_cut_cell([&](int /*x*/, int /*y*/, int /*z*/, unsigned pattern) {
    block.triangles += table[pattern].triangles.size();
    block.inner_points += table[pattern].inner_loop.empty() ? 0 : 1;
  });
}

// The numbers of the vertices on the edges of the block's cells, which other blocks may own.
class EdgeVertices {
 public:
  EdgeVertices(const std::vector<Block>& blocks, const Block& block) {
    number_.fill(kNone);
    for (int n = 0; n < 8; ++n) {
      if (block.next[n] == kNoBlock) continue;
      const bool in_x = (n & 1) == 0;
      const bool in_y = (n & 2) == 0;
      const bool in_z = (n & 4) == 0;
      const Block& owner = blocks[block.next[n]];
      std::uint32_t first = owner.first_vertex;
      for (int axis = 0; axis < 3; ++axis) {
        owner.cut[axis].for_each(in_x ? kEdge : 1, [&](int x, int y, int z, int rank) {
          if ((y > 0 && !in_y) || (z > 0 && !in_z)) return;
          const int point =
              padded(x + (in_x ? 0 : kEdge), y + (in_y ? 0 : kEdge), z + (in_z ? 0 : kEdge));
          number_[axis * kPaddedPoints + point] = first + static_cast<std::uint32_t>(rank);
        });
        first += static_cast<std::uint32_t>(owner.cut[axis].count());
      }
    }
  }

  // On an edge of the cell at (x, y, z).
  [[nodiscard]] std::uint32_t operator()(int x, int y, int z, int edge) const {
    const int corner = edge_low_corner(edge);
    const std::uint32_t number =
        number_[edge_axis(edge) * kPaddedPoints +
                padded(x + (corner & 1), y + ((corner >> 1) & 1), z + (corner >> 2))];
    if (number == kNone) throw Error("iso-surface: the field is not a distance field");
    return number;
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::array<std::uint32_t, 3 * kPaddedPoints> number_;  // by axis and the edge's first point
};

void place_vertices(const std::vector<Block>& blocks, const Block& block, TriangleSoup& surface) {
  const PaddedValues values(blocks, block);
  std::uint32_t vertex = block.first_vertex;
  for (int axis = 0; axis < 3; ++axis) {
    block.cut[axis].for_each(kEdge, [&](int x, int y, int z, int /*rank*/) {
      const double here = values(x, y, z);
      const double there =
          values(x + (axis == 0 ? 1 : 0), y + (axis == 1 ? 1 : 0), z + (axis == 2 ? 1 : 0));
      const double t = here / (here - there);
      Point3 p{static_cast<double>(block.low.x() + x), static_cast<double>(block.low.y() + y),
               static_cast<double>(block.low.z() + z)};
      p[axis] += std::clamp(t, kClearance, 1 - kClearance);
      surface.points[vertex++] = p;
    });
  }
}

void place_triangles(const std::vector<Block>& blocks, const Block& block, TriangleSoup& surface) {
  if (block.triangles == 0) return;
  const PaddedValues values(blocks, block);
  const EdgeVertices vertex(blocks, block);
  const std::array<CubeCase, 256>& table = cube_table();
  std::size_t triangle = block.first_triangle;
  std::uint32_t inner = block.first_vertex + static_cast<std::uint32_t>(block.edge_vertices());
  values.for_each_cut_cell([&](int x, int y, int z, unsigned pattern) {
    const CubeCase& cube = table[pattern];
    for (const std::array<std::uint8_t, 3>& corners : cube.triangles) {
      Triangle& face = surface.triangles[triangle++];
      for (int k = 0; k < 3; ++k) {
        face[k] = corners[k] == kInnerPoint ? inner : vertex(x, y, z, corners[k]);
      }
    }
    if (cube.inner_loop.empty()) return;
    Point3 sum{};
    for (const std::uint8_t edge : cube.inner_loop) {
      sum = sum + surface.points[vertex(x, y, z, edge)];
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
