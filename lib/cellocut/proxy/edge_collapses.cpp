#include "cellocut/proxy/edge_collapses.h"

#include <meshoptimizer.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "cellocut/proxy/blocks.h"

namespace cellocut {

namespace {

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

// Every block by itself, borders locked.
std::vector<Triangle> thin_blocks(const TriangleSoup& surface, double kept_share, double error) {
  const Blocks blocks = make_blocks(surface.points);
  std::vector<std::uint32_t> block_of_face(surface.triangles.size());
  tbb::parallel_for(std::size_t{0}, block_of_face.size(), [&](std::size_t f) {
    block_of_face[f] = blocks.of_point[surface.triangles[f][0]];
  });
  const Groups faces = group(block_of_face, blocks.count());

  std::vector<std::vector<Triangle>> left(blocks.count());
  tbb::parallel_for(std::size_t{0}, blocks.count(), [&](std::size_t b) {
    Part part;
    for (const std::uint32_t point : blocks.points[b]) part.add_point(surface, point);
    std::unordered_map<std::uint32_t, std::uint32_t> beyond;  // points of other blocks
    part.corners.reserve(3 * faces[b].size());
    for (const std::uint32_t face : faces[b]) {
      for (const std::uint32_t v : surface.triangles[face]) {
        if (blocks.of_point[v] == b) {
          part.corners.push_back(blocks.rank[v]);
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

std::vector<Triangle> collapse_edges(const TriangleSoup& surface, double removed_share,
                                     double error) {
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
