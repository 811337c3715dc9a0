#include "cellocut/proxy/decimation.h"

#include <meshoptimizer.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace cellocut {

namespace {

constexpr int kBlockEdge = 64;        // units along a block: some 50,000 faces of an iso-surface
constexpr double kThinningShare = 2;  // blocks keep this many times what is to be kept in the end

// A part of the surface with points of its own.
struct Part {
  std::vector<float> positions;
  std::vector<unsigned int> corners;
  std::vector<std::uint32_t> origin;  // the point of the surface

  void add_point(const TriangleSoup& surface, std::uint32_t point) {
    for (const double x : surface.points[point]) positions.push_back(static_cast<float>(x));
    origin.push_back(point);
  }
};

// The faces that are left, as corners into the surface.
std::vector<Triangle> simplify(const Part& part, double kept_share, double error,
                               unsigned int options) {
  const std::size_t points = part.origin.size();
  const std::size_t stride = 3 * sizeof(float);
  const std::size_t faces_before = part.corners.size() / 3;
  const double kept = kept_share * static_cast<double>(faces_before);
  const std::size_t target = 3 * static_cast<std::size_t>(std::ceil(kept));
  const float scale = meshopt_simplifyScale(part.positions.data(), points, stride);
  std::vector<unsigned int> left(part.corners.size());
  left.resize(meshopt_simplify(left.data(), part.corners.data(), part.corners.size(),
                               part.positions.data(), points, stride, target,
                               static_cast<float>(error) / scale, options, nullptr));
  std::vector<Triangle> faces(left.size() / 3);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) faces[f][k] = part.origin[left[3 * f + k]];
  }
  return faces;
}

// Things in groups, each group in the order of the things.
struct Groups {
  std::vector<std::size_t> first;   // of every group, and the end
  std::vector<std::uint32_t> item;  // group after group
};

Groups group(const std::vector<std::uint32_t>& group_of, std::size_t count) {
  Groups groups;
  groups.first.assign(count + 1, 0);
  for (const std::uint32_t g : group_of) ++groups.first[g + 1];
  for (std::size_t g = 0; g < count; ++g) groups.first[g + 1] += groups.first[g];
  groups.item.resize(group_of.size());
  std::vector<std::size_t> next(groups.first.begin(), groups.first.end() - 1);
  for (std::uint32_t i = 0; i < group_of.size(); ++i) groups.item[next[group_of[i]]++] = i;
  return groups;
}

// The block of every point, numbered in the order of the points.
std::vector<std::uint32_t> assign_blocks(const std::vector<Point3>& points, std::size_t& count) {
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

// Every block by itself, borders locked.
std::vector<Triangle> thin_blocks(const TriangleSoup& surface, double kept_share, double error) {
  std::size_t count = 0;
  const std::vector<std::uint32_t> block_of_point = assign_blocks(surface.points, count);
  const Groups points = group(block_of_point, count);
  std::vector<std::uint32_t> rank(surface.points.size());  // of a point in its block
  std::vector<std::uint32_t> block_of_face(surface.triangles.size());
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t i = points.first[b]; i < points.first[b + 1]; ++i) {
      rank[points.item[i]] = static_cast<std::uint32_t>(i - points.first[b]);
    }
  }
  tbb::parallel_for(std::size_t{0}, block_of_face.size(), [&](std::size_t f) {
    block_of_face[f] = block_of_point[surface.triangles[f][0]];
  });
  const Groups faces = group(block_of_face, count);

  std::vector<std::vector<Triangle>> left(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t b) {
    Part part;
    for (std::size_t i = points.first[b]; i < points.first[b + 1]; ++i) {
      part.add_point(surface, points.item[i]);
    }
    std::unordered_map<std::uint32_t, std::uint32_t> beyond;  // points of other blocks
    part.corners.reserve(3 * (faces.first[b + 1] - faces.first[b]));
    for (std::size_t i = faces.first[b]; i < faces.first[b + 1]; ++i) {
      for (const std::uint32_t v : surface.triangles[faces.item[i]]) {
        if (block_of_point[v] == b) {
          part.corners.push_back(rank[v]);
          continue;
        }
        const auto [entry, fresh] =
            beyond.try_emplace(v, static_cast<std::uint32_t>(part.origin.size()));
        if (fresh) part.add_point(surface, v);
        part.corners.push_back(entry->second);
      }
    }
    left[b] = simplify(part, kept_share, error, meshopt_SimplifyLockBorder);
  });
  std::vector<Triangle> all;
  for (const std::vector<Triangle>& part : left) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// The points that faces use, in their order.
Part whole(const TriangleSoup& surface, const std::vector<Triangle>& faces) {
  constexpr std::uint32_t kUnused = 0xFFFFFFFFU;
  std::vector<std::uint32_t> number(surface.points.size(), kUnused);
  Part part;
  part.corners.reserve(3 * faces.size());
  for (const Triangle& t : faces) {
    for (const std::uint32_t v : t) {
      if (number[v] == kUnused) {
        number[v] = static_cast<std::uint32_t>(part.origin.size());
        part.add_point(surface, v);
      }
      part.corners.push_back(number[v]);
    }
  }
  return part;
}

}  // namespace

std::vector<Triangle> decimate(const TriangleSoup& surface, double removed_share, double error) {
  const double kept_share = 1 - removed_share;
  if (removed_share <= 0) return surface.triangles;
  const double thinned_share = std::min(1.0, kThinningShare * kept_share);
  const std::vector<Triangle> thinned =
      thinned_share < 1 ? thin_blocks(surface, thinned_share, error) : surface.triangles;
  const double kept = kept_share * static_cast<double>(surface.triangles.size());
  return simplify(whole(surface, thinned),
                  std::min(1.0, kept / static_cast<double>(thinned.size())), error, 0);
}

}  // namespace cellocut
