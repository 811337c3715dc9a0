#include "cellocut/field/band.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace cellocut {

namespace {

// Covers the rounding of distances in index coordinates (below 1e-9 for grids of up to 1e5 steps).
constexpr double kSlack = 1e-7;

// Rounds to odd multiples of 2^-15, for |x| < 2^37 (the first sum has 2^-14 for its last place). An
// input that is scaled or moved has distances that differ in their last bits; so rounded they are
// the same, and with them all that follows. None is zero: no grid point lies on the zero set.
double to_quantum(double x) {
  constexpr double kShift = 0x1.8p38;
  return ((x - 0x1p-15) + kShift) - kShift + 0x1p-15;
}

using Candidates = std::vector<std::uint32_t>;

// Holds a triangle.
struct Ball {
  Point3 centre;
  double radius;
};

class Descent {
 public:
  Descent(const std::vector<DistanceTriangle>& triangles, double offset, Observer& observer)
      : triangles_(triangles), offset_(offset), observer_(observer) {
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

  Band take() {
    Band band;
    for (Band& part : parts_) {
      std::move(part.leaves.begin(), part.leaves.end(), std::back_inserter(band.leaves));
      band.inside.insert(band.inside.end(), part.inside.begin(), part.inside.end());
      band.outside.insert(band.outside.end(), part.outside.begin(), part.outside.end());
    }
    return band;
  }

 private:
  // Scratch space for the parts of one edge length.
  struct Workspace {
    std::vector<Eight> squared;  // distances of a candidate from the centres of the parts
    Candidates narrowed;
  };

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
      const double reach = std::min(closest + radius, offset_ + kBand) + balls_[t].radius + kSlack;
      const Point3 offset = balls_[t].centre - centre;
      const Point3 beyond{std::max(std::abs(offset[0]) - half, 0.0),
                          std::max(std::abs(offset[1]) - half, 0.0),
                          std::max(std::abs(offset[2]) - half, 0.0)};
      if (squared_norm(beyond) > reach * reach) continue;
      double bound = norm(offset) - balls_[t].radius;
      if (balls_[t].radius > 0.25 * radius) {
        bound = std::sqrt(triangles_[t].squared_distance(centre));
        if (bound > closest + 2 * radius + kSlack) continue;
        closest = std::min(closest, bound);
      }
      lower = std::min(lower, bound);
      narrowed.push_back(t);
    }
    if (narrowed.empty() || lower - offset_ > radius + kBand + kSlack) return Place::outside;
    if (closest - offset_ < -(radius + kBand + kSlack)) return Place::inside;
    return Place::band;
  }

  void visit(const openvdb::Coord& low, int edge, const Candidates& candidates) {
    Candidates narrowed;
    switch (narrow(low, edge, candidates, narrowed)) {
      case Place::outside:
        parts_.local().outside.push_back({low, edge});
        return;
      case Place::inside:
        parts_.local().inside.push_back({low, edge});
        return;
      case Place::band:
        break;
    }
    if (edge == kLeafEdge) {
      auto leaf = std::make_unique<FieldLeaf>(low, kBand, false);
      fill(*leaf, low, kLeafEdge, narrowed, workspaces_.local().data());
      parts_.local().leaves.push_back(std::move(leaf));
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

  // Fills the cube of `edge` grid points at `low`, part by eighth part: those that the band does
  // not reach at once, the others from the candidates that can be closest to one of their points.
  void fill(FieldLeaf& leaf, const openvdb::Coord& low, int edge, const Candidates& candidates,
            Workspace* workspace) const {
    const int half = edge / 2;
    const EightPoints centres = centres_of_parts(low, half);
    std::vector<Eight>& squared = workspace->squared;
    squared.resize(candidates.size());
    Eight closest;
    closest.fill(std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      triangles_[candidates[i]].squared_distances(centres, squared[i]);
      for (std::size_t k = 0; k < 8; ++k) closest[k] = std::min(closest[k], squared[i][k]);
    }
    const double radius = std::sqrt(3.0) * 0.5 * (half - 1);
    for (int k = 0; k < 8; ++k) {
      const openvdb::Coord part =
          low.offsetBy((k & 1) * half, ((k >> 1) & 1) * half, (k >> 2) * half);
      const double distance = std::sqrt(closest[k]);
      if (half == 1) {
        set(leaf, part, distance);
      } else if (distance - offset_ > radius + kBand + kSlack) {
        continue;  // the leaf was made with +kBand
      } else if (distance - offset_ < -(radius + kBand + kSlack)) {
        fill_inside(leaf, part, half);
      } else {
        const double reach = std::min(distance + 2 * radius, offset_ + kBand + radius) + kSlack;
        Candidates& narrowed = workspace->narrowed;
        narrowed.clear();
        for (std::size_t i = 0; i < candidates.size(); ++i) {
          if (squared[i][k] <= reach * reach) narrowed.push_back(candidates[i]);
        }
        fill(leaf, part, half, narrowed, workspace + 1);
      }
    }
  }

  static EightPoints centres_of_parts(const openvdb::Coord& low, int edge) {
    const double middle = 0.5 * (edge - 1);
    EightPoints centres;
    for (int k = 0; k < 8; ++k) {
      centres.x[k] = low.x() + (k & 1) * edge + middle;
      centres.y[k] = low.y() + ((k >> 1) & 1) * edge + middle;
      centres.z[k] = low.z() + (k >> 2) * edge + middle;
    }
    return centres;
  }

  void set(FieldLeaf& leaf, const openvdb::Coord& at, double distance) const {
    const auto phi = static_cast<float>(to_quantum(distance - offset_));
    if (std::fabs(phi) < kBand) {
      leaf.setValueOn(at, phi);
    } else if (phi < 0) {
      leaf.setValueOff(at, -kBand);
    }
  }

  static void fill_inside(FieldLeaf& leaf, const openvdb::Coord& low, int edge) {
    for (int x = 0; x < edge; ++x) {
      for (int y = 0; y < edge; ++y) {
        for (int z = 0; z < edge; ++z) leaf.setValueOff(low.offsetBy(x, y, z), -kBand);
      }
    }
  }

  const std::vector<DistanceTriangle>& triangles_;
  std::vector<Ball> balls_;  // one per triangle
  double offset_;
  Observer& observer_;
  // One per thread; the levels within a leaf are three.
  tbb::enumerable_thread_specific<Band> parts_;
  tbb::enumerable_thread_specific<std::array<Workspace, 3>> workspaces_;
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
  Descent descent(triangles, offset, observer);
  descent.run(extent);
  return descent.take();
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
