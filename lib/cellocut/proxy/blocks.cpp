#include "cellocut/proxy/blocks.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace cellocut {

namespace {

constexpr std::size_t kChunks = 16;  // of the things, each counted by itself

std::size_t chunk_begin(std::size_t chunk, std::size_t count) { return chunk * count / kChunks; }

// The block of every point, numbered in the order of the points.
std::vector<std::uint32_t> number_blocks(const std::vector<Point3>& points, std::size_t& count) {
  std::vector<std::uint64_t> key(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    for (const double x : points[i]) {
      key[i] = (key[i] << 20) | static_cast<std::uint64_t>(x / kBlockEdge);
    }
  });
  std::unordered_map<std::uint64_t, std::uint32_t> number;
  std::vector<std::uint32_t> block(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    block[i] =
        i > 0 && key[i] == key[i - 1]
            ? block[i - 1]
            : number.try_emplace(key[i], static_cast<std::uint32_t>(number.size())).first->second;
  }
  count = number.size();
  return block;
}

}  // namespace

Groups group(const std::vector<std::uint32_t>& group_of, std::size_t count) {
  // Where each chunk of things writes within each group.
  std::vector<std::vector<std::size_t>> next(kChunks, std::vector<std::size_t>(count, 0));
  const auto for_each_in_chunk = [&](const auto& visit) {
    tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
      const std::size_t end = chunk_begin(chunk + 1, group_of.size());
      for (std::size_t i = chunk_begin(chunk, group_of.size()); i < end; ++i) {
        if (group_of[i] != Groups::kNone) visit(next[chunk][group_of[i]], i);
      }
    });
  };
  for_each_in_chunk([](std::size_t& here, std::size_t) { ++here; });
  Groups groups;
  groups.first.assign(count + 1, 0);
  std::size_t sum = 0;
  for (std::size_t g = 0; g < count; ++g) {
    groups.first[g] = sum;
    for (std::vector<std::size_t>& chunk : next) {
      const std::size_t in_chunk = chunk[g];
      chunk[g] = sum;
      sum += in_chunk;
    }
  }
  groups.first[count] = sum;
  groups.item.resize(sum);
  for_each_in_chunk([&](std::size_t& here, std::size_t i) {
    groups.item[here++] = static_cast<std::uint32_t>(i);
  });
  return groups;
}

Point3 Blocks::corner(const Point3& inside) {
  Point3 corner;
  for (int axis = 0; axis < 3; ++axis) {
    corner[axis] = std::floor(inside[axis] / kBlockEdge) * kBlockEdge;
  }
  return corner;
}

Blocks make_blocks(const std::vector<Point3>& points) {
  Blocks blocks;
  std::size_t count = 0;
  blocks.of_point = number_blocks(points, count);
  blocks.points = group(blocks.of_point, count);
  blocks.rank.resize(points.size());
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t b) {
    std::uint32_t rank = 0;
    for (const std::uint32_t point : blocks.points[b]) blocks.rank[point] = rank++;
  });
  return blocks;
}

}  // namespace cellocut
