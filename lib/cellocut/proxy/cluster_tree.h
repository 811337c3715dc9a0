// A hierarchy of clusters over the vertices of a piece of surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cellocut/base/point.h"
#include "cellocut/proxy/quadric.h"

namespace cellocut {

struct ClusterLeaf {
  Quadric quadric;
  Point3 at{};
  Point3 normal{};  // unit, or zero
};

// The nodes of a forest: first the leaves, then clusters, each after all that is in it.
struct ClusterTree {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  std::vector<std::uint32_t> parent;          // kNone: a root
  std::vector<std::uint32_t> representative;  // the leaf that stands for it
  // What it costs to let the representative stand for all: its squared distance from the planes of
  // the leaves, and a little of that from the last one merged, times the area; or the largest of a
  // cluster within, if that is more.
  std::vector<float> cost;
  std::size_t leaves = 0;

  [[nodiscard]] std::size_t size() const { return parent.size(); }
};

// First, clusters of leaves that edges join, that lie in one grid cell of two units and whose
// normals agree; then pairs, each the best partner of the other, over and over. (Merging pairs of
// reciprocal nearest neighbours makes the hierarchy that merging the cheapest pair first makes,
// where a merger brings nothing nearer: Bruynooghe 1977, Murtagh 1983. Here that holds nearly.)
// No cluster departs from its planes by more than `error` in the root mean square, but for those of
// the first step. Deterministic. About O(n), as a constant share of the clusters goes each time.
// Preconditions: every edge once; coordinates of the leaves in [0, 2048).
ClusterTree grow_cluster_tree(std::vector<ClusterLeaf> leaves,
                              const std::vector<std::array<std::uint32_t, 2>>& edges, double error);

}  // namespace cellocut
