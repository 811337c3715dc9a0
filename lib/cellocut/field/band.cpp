#include "cellocut/field/band.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
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
      fill(*leaf, low, kLeafEdge / 2, narrowed);
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

  // Fills the eight sub-blocks of `edge` grid points inside one leaf.
  void fill(FieldLeaf& leaf, const openvdb::Coord& low, int edge,
            const Candidates& candidates) const {
    Candidates narrowed;
    for (int k = 0; k < 8; ++k) {
      const openvdb::Coord sub =
          low.offsetBy((k & 1) * edge, ((k >> 1) & 1) * edge, (k >> 2) * edge);
      switch (narrow(sub, edge, candidates, narrowed)) {
        case Place::outside:
          break;  // the leaf was made with +kBand
        case Place::inside:
          fill_inside(leaf, sub, edge);
          break;
        case Place::band:
          if (edge > 2) {
            fill(leaf, sub, edge / 2, narrowed);
          } else {
            evaluate(leaf, sub, edge, narrowed);
          }
          break;
      }
    }
  }

  static void fill_inside(FieldLeaf& leaf, const openvdb::Coord& low, int edge) {
    for (int x = 0; x < edge; ++x) {
      for (int y = 0; y < edge; ++y) {
        for (int z = 0; z < edge; ++z) leaf.setValueOff(low.offsetBy(x, y, z), -kBand);
      }
    }
  }

  void evaluate(FieldLeaf& leaf, const openvdb::Coord& low, int edge,
                const Candidates& candidates) const {
    // The closest at one grid point is often the closest at the next, and else a good bound.
    std::uint32_t winner = candidates.front();
    for (int x = 0; x < edge; ++x) {
      for (int y = 0; y < edge; ++y) {
        for (int z = 0; z < edge; ++z) {
          const openvdb::Coord at = low.offsetBy(x, y, z);
          const Point3 p{static_cast<double>(at.x()), static_cast<double>(at.y()),
                         static_cast<double>(at.z())};
          const auto phi =
              static_cast<float>(to_quantum(distance(p, candidates, winner) - offset_));
          if (std::fabs(phi) < kBand) {
            leaf.setValueOn(at, phi);
          } else if (phi < 0) {
            leaf.setValueOff(at, -kBand);
          }
        }
      }
    }
  }

  // The distance of p from the closest candidate, which becomes the winner; it is tried first.
  double distance(const Point3& p, const Candidates& candidates, std::uint32_t& winner) const {
    const std::uint32_t first = winner;
    double squared = triangles_[first].squared_distance(p);
    double distance = std::sqrt(squared);
    for (const std::uint32_t t : candidates) {
      const double reach = distance + balls_[t].radius + kSlack;
      if (t == first || squared_norm(p - balls_[t].centre) > reach * reach) continue;
      const double candidate = triangles_[t].squared_distance(p);
      if (candidate < squared) {
        squared = candidate;
        distance = std::sqrt(squared);
        winner = t;
      }
    }
    return distance;
  }

  const std::vector<DistanceTriangle>& triangles_;
  std::vector<Ball> balls_;  // one per triangle
  double offset_;
  Observer& observer_;
  tbb::enumerable_thread_specific<Band> parts_;  // one per thread
};

}  // namespace

Band find_band(const std::vector<DistanceTriangle>& triangles, int extent, double offset,
               Observer& observer) {
  Descent descent(triangles, offset, observer);
  descent.run(extent);
  return descent.take();
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
