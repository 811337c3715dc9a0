// The vertices of a dense surface in clusters.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/proxy/blocks.h"
#include "cellocut/proxy/cluster_tree.h"

namespace cellocut {

// Clusters are found in blocks of space, each by itself and in parallel, as a hierarchy
// (cluster_tree.h); which of them are made is decided for all blocks at once. No cluster reaches
// beyond its block, and two sides of a sheet are in one only where the surface joins them. The same
// for any number of threads.
class VertexClusters {
 public:
  // The faces with a corner in a block.
  struct BlockFaces {
    Groups own;     // by the block of the first corner
    Groups across;  // by those of the others, where they are in another
  };

  // The hierarchy, of which nothing is made; no pair in it departs from its planes by more than
  // `error` in the root mean square. Keeps a reference. O(n). Errors: Cancelled.
  // Preconditions: a closed oriented manifold, points >= 0, one unit or so between neighbours.
  VertexClusters(const TriangleSoup& surface, double error, Observer& observer);

  // Makes the cheapest clusters, until this share of the vertices is gone or no cluster is left;
  // what was made before is forgotten. O(n). Precondition: removed_share in [0, 1).
  void make(double removed_share);

  // Puts what the clusters of these representatives were made from in their place; single vertices
  // stay. Returns whether there was a cluster. O(n) in the blocks concerned.
  bool undo(const std::vector<std::uint32_t>& representatives);

  // The faces whose corners fall into three clusters, with their representatives, which are
  // vertices of the surface, for corners: the lowest first, in ascending order, each once. The
  // result need not be manifold. O(n log n) at first; after undo(), O(n) in the blocks concerned
  // and O(k log k) for k faces.
  [[nodiscard]] std::vector<Triangle> faces();

 private:
  void find_nodes(std::size_t block);

  const TriangleSoup& surface_;
  Blocks blocks_;
  BlockFaces faces_;
  std::vector<ClusterTree> trees_;                 // per block
  std::vector<std::vector<std::uint8_t>> undone_;  // per block and node: not made
  std::vector<std::uint32_t> node_;                // per point, of its block's tree
  std::vector<std::uint32_t> representative_;      // per point, of its node
  std::vector<std::vector<Triangle>> left_;        // per block: what its own faces have become
  std::vector<std::uint8_t> changed_;              // per block: that is no longer so
};

}  // namespace cellocut
