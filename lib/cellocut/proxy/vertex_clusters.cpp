#include "cellocut/proxy/vertex_clusters.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>

namespace cellocut {

namespace {

VertexClusters::BlockFaces group_faces(const TriangleSoup& surface, const Blocks& blocks) {
  const std::size_t count = surface.triangles.size();
  std::vector<std::uint32_t> first(count);
  std::array<std::vector<std::uint32_t>, 2> others;
  for (std::vector<std::uint32_t>& other : others) other.resize(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t f) {
    const Triangle& t = surface.triangles[f];
    const std::uint32_t a = blocks.of_point[t[0]];
    const std::uint32_t b = blocks.of_point[t[1]];
    const std::uint32_t c = blocks.of_point[t[2]];
    first[f] = a;
    others[0][f] = b != a ? b : Groups::kNone;
    others[1][f] = c != a && c != b ? c : Groups::kNone;
  });
  VertexClusters::BlockFaces faces;
  faces.own = group(first, blocks.count());
  // A face has at most one entry in each block, so the order in a block needs no care.
  const Groups second = group(others[0], blocks.count());
  const Groups third = group(others[1], blocks.count());
  for (std::size_t b = 0; b < blocks.count(); ++b) {
    for (const Groups* part : {&second, &third}) {
      faces.across.item.insert(faces.across.item.end(), (*part)[b].begin(), (*part)[b].end());
    }
    faces.across.first.push_back(faces.across.item.size());
  }
  return faces;
}

ClusterTree tree_of_block(const TriangleSoup& surface, const Blocks& blocks,
                          const VertexClusters::BlockFaces& faces, std::size_t block,
                          double error) {
  const std::span<const std::uint32_t> points = blocks.points[block];
  const Point3 origin = Blocks::corner(surface.points[points.front()]);
  std::vector<ClusterLeaf> leaves(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    leaves[i].at = surface.points[points[i]] - origin;
  }
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(3 * points.size());
  for (const Groups* group : {&faces.own, &faces.across}) {
    for (const std::uint32_t face : (*group)[block]) {
      const Triangle& t = surface.triangles[face];
      std::array<Point3, 3> p;
      for (int k = 0; k < 3; ++k) p[k] = surface.points[t[k]] - origin;
      const Point3 twice_area = cross(p[1] - p[0], p[2] - p[0]);
      const Quadric quadric = plane_quadric(p[0], twice_area, norm(twice_area) / 6);  // a third
      for (int k = 0; k < 3; ++k) {
        if (blocks.of_point[t[k]] != block) continue;
        const std::uint32_t a = blocks.rank[t[k]];
        leaves[a].quadric += quadric;
        leaves[a].normal = leaves[a].normal + twice_area;
        // The other face at the edge runs along it from the other end.
        const std::uint32_t next = t[(k + 1) % 3];
        if (blocks.of_point[next] == block && a < blocks.rank[next]) {
          edges.push_back({a, blocks.rank[next]});
        }
      }
    }
  }
  for (ClusterLeaf& leaf : leaves) {
    const double length = norm(leaf.normal);
    if (length > 0) leaf.normal = (1 / length) * leaf.normal;
  }
  return grow_cluster_tree(std::move(leaves), edges, error);
}

// Costs in classes of half a percent.
constexpr int kClassShift = 15;
constexpr std::size_t kClasses = std::size_t{1} << (32 - kClassShift);
std::uint32_t class_of(float cost) { return std::bit_cast<std::uint32_t>(cost) >> kClassShift; }

// Which clusters are made: all of a lower class, and of the last class the first of every tree.
struct Bound {
  std::uint32_t last_class = 0;
  std::vector<std::uint32_t> end;  // per tree: the first node of that class that is not made

  [[nodiscard]] bool makes(std::size_t tree, std::uint32_t node, float cost) const {
    const std::uint32_t c = class_of(cost);
    return c < last_class || (c == last_class && node < end[tree]);
  }
};

// Such that as many vertices go as there are to remove, or all that clusters can take.
Bound find_bound(const std::vector<ClusterTree>& trees, std::int64_t remove) {
  std::vector<std::int64_t> gone(kClasses, 0);  // vertices, by the class in which they go
  for (const ClusterTree& tree : trees) {
    for (std::size_t i = 0; i < tree.size(); ++i) {
      if (tree.parent[i] != ClusterTree::kNone) ++gone[class_of(tree.cost[tree.parent[i]])];
      if (i >= tree.leaves) --gone[class_of(tree.cost[i])];
    }
  }
  Bound bound;
  while (bound.last_class + 1 < kClasses && gone[bound.last_class] <= remove) {
    remove -= gone[bound.last_class++];
  }
  for (const ClusterTree& tree : trees) {
    std::vector<std::uint32_t> members(tree.size(), 0);
    for (const std::uint32_t parent : tree.parent) {
      if (parent != ClusterTree::kNone) ++members[parent];
    }
    std::uint32_t end = 0;
    for (auto i = static_cast<std::uint32_t>(tree.leaves); i < tree.size() && remove > 0; ++i) {
      end = i + 1;
      if (class_of(tree.cost[i]) == bound.last_class) remove -= members[i] - 1;
    }
    bound.end.push_back(end);
  }
  return bound;
}

}  // namespace

VertexClusters::VertexClusters(const TriangleSoup& surface, double error, Observer& observer)
    : surface_(surface),
      blocks_(make_blocks(surface.points)),
      faces_(group_faces(surface, blocks_)),
      trees_(blocks_.count()),
      undone_(blocks_.count()),
      node_(surface.points.size()),
      representative_(surface.points.size()),
      left_(blocks_.count()),
      changed_(blocks_.count(), 1) {
  tbb::parallel_for(std::size_t{0}, trees_.size(), [&](std::size_t b) {
    observer.check();
    trees_[b] = tree_of_block(surface, blocks_, faces_, b, error);
  });
}

void VertexClusters::make(double removed_share) {
  const auto remove = removed_share * static_cast<double>(surface_.points.size());
  const Bound bound = find_bound(trees_, static_cast<std::int64_t>(remove));
  tbb::parallel_for(std::size_t{0}, trees_.size(), [&](std::size_t b) {
    const ClusterTree& tree = trees_[b];
    undone_[b].assign(tree.size(), 0);
    for (auto i = static_cast<std::uint32_t>(tree.leaves); i < tree.size(); ++i) {
      undone_[b][i] = bound.makes(b, i, tree.cost[i]) ? 0 : 1;
    }
    find_nodes(b);
    changed_[b] = 1;
  });
}

// The highest cluster made, for every leaf.
void VertexClusters::find_nodes(std::size_t block) {
  const ClusterTree& tree = trees_[block];
  std::vector<std::uint32_t> highest(tree.size(), ClusterTree::kNone);
  for (auto i = static_cast<std::uint32_t>(tree.size()); i-- > 0;) {
    const std::uint32_t parent = tree.parent[i];
    if (parent != ClusterTree::kNone) highest[i] = highest[parent];
    if (highest[i] == ClusterTree::kNone && undone_[block][i] == 0) highest[i] = i;
  }
  for (std::size_t leaf = 0; leaf < tree.leaves; ++leaf) {
    const std::uint32_t point = blocks_.points[block][leaf];
    node_[point] = highest[leaf];
    representative_[point] = blocks_.points[block][tree.representative[highest[leaf]]];
  }
}

bool VertexClusters::undo(const std::vector<std::uint32_t>& representatives) {
  std::vector<std::uint8_t> touched(trees_.size(), 0);
  for (const std::uint32_t point : representatives) {
    const std::uint32_t block = blocks_.of_point[point];
    if (node_[point] < trees_[block].leaves) continue;
    undone_[block][node_[point]] = 1;
    touched[block] = 1;
  }
  tbb::parallel_for(std::size_t{0}, trees_.size(), [&](std::size_t b) {
    if (touched[b] != 0) find_nodes(b);
  });
  for (std::size_t b = 0; b < trees_.size(); ++b) {
    if (touched[b] == 0) continue;
    changed_[b] = 1;
    for (const std::uint32_t face : faces_.across[b]) {
      changed_[blocks_.of_point[surface_.triangles[face][0]]] = 1;
    }
  }
  return std::find(touched.begin(), touched.end(), 1) != touched.end();
}

std::vector<Triangle> VertexClusters::faces() {
  tbb::parallel_for(std::size_t{0}, left_.size(), [&](std::size_t b) {
    if (changed_[b] == 0) return;
    changed_[b] = 0;
    left_[b].clear();
    for (const std::uint32_t face : faces_.own[b]) {
      Triangle t = surface_.triangles[face];
      for (std::uint32_t& corner : t) corner = representative_[corner];
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      left_[b].push_back(t);
    }
  });
  std::vector<Triangle> all;
  for (const std::vector<Triangle>& part : left_) all.insert(all.end(), part.begin(), part.end());
  tbb::parallel_sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace cellocut
