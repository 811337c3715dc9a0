#include "cellocut/field/band.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace cellocut {

namespace {

using Candidates = LeafDistances::Candidates;

// Holds a triangle.
struct Ball {
  Point3 centre;
  double radius;
};

template <class Item>
std::vector<Item> joined(tbb::enumerable_thread_specific<std::vector<Item>>& parts) {
  std::vector<Item> all;
  for (std::vector<Item>& part : parts)
    std::move(part.begin(), part.end(), std::back_inserter(all));
  return all;
}

// Calls at_leaf(low, candidates) for each leaf that the band reaches, with all triangles that can
// be closest to one of its points; from several threads.
template <class AtLeaf>
class Descent {
 public:
  Descent(const std::vector<DistanceTriangle>& triangles, double offset, const AtLeaf& at_leaf,
          Observer& observer)
      : triangles_(triangles), offset_(offset), at_leaf_(at_leaf), observer_(observer) {
    balls_.reserve(triangles.size());
    for (const DistanceTriangle& t : triangles) balls_.push_back({t.centre(), t.radius()});
  }

  void run(int extent) {
    int edge = kLeafEdge;
    while (edge < extent) edge *= 2;
    Candidates all(triangles_.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    visit(openvdb::Coord(0, 0, 0), edge, all);
  }

  // The cubes that the band does not reach; to be taken once.
  [[nodiscard]] std::vector<Tile> take_inside() { return joined(inside_); }
  [[nodiscard]] std::vector<Tile> take_outside() { return joined(outside_); }

 private:
  enum class Place { band, inside, outside };

  // Whether the band reaches the grid points low .. low + edge - 1, and if so which of the
  // candidates can be closest to one of them. Balls around the triangles decide most; distances are
  // taken for the first bound and for triangles that are large against the node.
  Place narrow(const openvdb::Coord& low, int edge, const Candidates& candidates,
               Candidates& narrowed) const {
    const double half = 0.5 * (edge - 1);
    const Point3 centre{low.x() + half, low.y() + half, low.z() + half};
    const double radius = std::sqrt(3.0) * half;

    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t seed = candidates.front();
    for (const std::uint32_t t : candidates) {
      const double squared = squared_norm(centre - balls_[t].centre);
      if (squared < nearest) {
        nearest = squared;
        seed = t;
      }
    }
    // Bounds of the distance from the centre: it lies in [lower, closest].
    double closest = std::sqrt(triangles_[seed].squared_distance(centre));
    double lower = closest;
    narrowed.clear();
    for (const std::uint32_t t : candidates) {
      // No point of the node is further from the triangles than closest + radius, and none that is
      // further than the band reaches needs to know its distance.
      const double reach =
          std::min(closest + radius, offset_ + kBand) + balls_[t].radius + kDistanceSlack;
      const Point3 offset = balls_[t].centre - centre;
      const Point3 beyond{std::max(std::abs(offset[0]) - half, 0.0),
                          std::max(std::abs(offset[1]) - half, 0.0),
                          std::max(std::abs(offset[2]) - half, 0.0)};
      if (squared_norm(beyond) > reach * reach) continue;
      double bound = norm(offset) - balls_[t].radius;
      if (balls_[t].radius > 0.25 * radius) {
        bound = std::sqrt(triangles_[t].squared_distance(centre));
        if (bound > closest + 2 * radius + kDistanceSlack) continue;
        closest = std::min(closest, bound);
      }
      lower = std::min(lower, bound);
      narrowed.push_back(t);
    }
    if (narrowed.empty() || lower - offset_ > radius + kBand + kDistanceSlack)
      return Place::outside;
    if (closest - offset_ < -(radius + kBand + kDistanceSlack)) return Place::inside;
    return Place::band;
  }

  void visit(const openvdb::Coord& low, int edge, const Candidates& candidates) {
    Candidates narrowed;
    switch (narrow(low, edge, candidates, narrowed)) {
      case Place::outside:
        outside_.local().push_back({low, edge});
        return;
      case Place::inside:
        inside_.local().push_back({low, edge});
        return;
      case Place::band:
        break;
    }
    if (edge == kLeafEdge) {
      at_leaf_(low, std::move(narrowed));
      return;
    }
    observer_.check();
    const int half = edge / 2;
    const auto child = [&](int k) {
      visit(low.offsetBy((k & 1) * half, ((k >> 1) & 1) * half, (k >> 2) * half), half, narrowed);
    };
    if (edge > 2 * kLeafEdge) {
      tbb::parallel_for(0, 8, child);
    } else {
      for (int k = 0; k < 8; ++k) child(k);
    }
  }

  const std::vector<DistanceTriangle>& triangles_;
  std::vector<Ball> balls_;  // one per triangle
  double offset_;
  const AtLeaf& at_leaf_;
  Observer& observer_;
  tbb::enumerable_thread_specific<std::vector<Tile>> inside_;
  tbb::enumerable_thread_specific<std::vector<Tile>> outside_;
};

using CoordIterator = std::vector<openvdb::Coord>::iterator;

// Splits the cube into eight as long as it holds a leaf; what holds none is a tile.
void split(const openvdb::Coord& low, int edge, CoordIterator begin, CoordIterator end,
           std::vector<Tile>& tiles) {
  if (begin == end) {
    tiles.push_back({low, edge});
    return;
  }
  if (edge == kLeafEdge) return;
  const int half = edge / 2;
  CoordIterator from = begin;
  for (int k = 0; k < 8; ++k) {
    const openvdb::Coord child =
        low.offsetBy((k & 1) * half, ((k >> 1) & 1) * half, (k >> 2) * half);
    const auto within = [&](const openvdb::Coord& leaf) {
      for (int axis = 0; axis < 3; ++axis) {
        if (leaf[axis] < child[axis] || leaf[axis] >= child[axis] + half) return false;
      }
      return true;
    };
    const CoordIterator to = std::partition(from, end, within);
    split(child, half, from, to, tiles);
    from = to;
  }
}

}  // namespace

Band find_band(const std::vector<DistanceTriangle>& triangles, int extent, double offset,
               Observer& observer) {
  tbb::enumerable_thread_specific<std::vector<std::unique_ptr<FieldLeaf>>> leaves;
  LeafDistances distances(triangles, offset);
  const auto fill = [&](const openvdb::Coord& low, const Candidates& candidates) {
    auto leaf = std::make_unique<FieldLeaf>(low, kBand, false);
    distances.fill(*leaf, candidates);
    leaves.local().push_back(std::move(leaf));
  };
  Descent descent(triangles, offset, fill, observer);
  descent.run(extent);
  return {joined(leaves), descent.take_inside(), descent.take_outside()};
}

std::vector<BandLeaf> list_band(const std::vector<DistanceTriangle>& triangles, int extent,
                                Observer& observer) {
  tbb::enumerable_thread_specific<std::vector<BandLeaf>> leaves;
  const auto list = [&](const openvdb::Coord& low, Candidates&& candidates) {
    leaves.local().push_back({low, std::move(candidates)});
  };
  Descent descent(triangles, 0.0, list, observer);
  descent.run(extent);
  std::vector<BandLeaf> all = joined(leaves);
  std::sort(all.begin(), all.end(),
            [](const BandLeaf& a, const BandLeaf& b) { return a.low < b.low; });
  return all;
}

std::vector<Tile> tiles_between(std::vector<openvdb::Coord> leaves, int extent) {
  int edge = kLeafEdge;
  while (edge < extent) edge *= 2;
  std::vector<Tile> tiles;
  split(openvdb::Coord(0, 0, 0), edge, leaves.begin(), leaves.end(), tiles);
  return tiles;
}

void add_inside_tile(FieldTree& tree, const Tile& tile) {
  // A tile of the tree has the size of a leaf or of the node above it.
  constexpr int kUpper = FieldTree::RootNodeType::ChildNodeType::ChildNodeType::DIM;  // 128
  const int step = tile.edge >= kUpper ? kUpper : kLeafEdge;
  const openvdb::Index level = tile.edge >= kUpper ? 2 : 1;
  for (int x = 0; x < tile.edge; x += step) {
    for (int y = 0; y < tile.edge; y += step) {
      for (int z = 0; z < tile.edge; z += step) {
        tree.addTile(level, tile.low.offsetBy(x, y, z), -kBand, false);
      }
    }
  }
}

}  // namespace cellocut
