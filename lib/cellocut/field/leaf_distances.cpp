#include "cellocut/field/leaf_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace cellocut {

namespace {

// Rounds to odd multiples of 2^-15, for |x| < 2^37 (the first sum has 2^-14 for its last place). An
// input that is scaled or moved has distances that differ in their last bits; so rounded they are
// the same, and with them all that follows. None is zero: no grid point lies on the zero set.
double to_quantum(double x) {
  constexpr double kShift = 0x1.8p38;
  return ((x - 0x1p-15) + kShift) - kShift + 0x1p-15;
}

EightPoints centres_of_parts(const openvdb::Coord& low, int edge) {
  const double middle = 0.5 * (edge - 1);
  EightPoints centres;
  for (int k = 0; k < 8; ++k) {
    centres.x[k] = low.x() + (k & 1) * edge + middle;
    centres.y[k] = low.y() + ((k >> 1) & 1) * edge + middle;
    centres.z[k] = low.z() + (k >> 2) * edge + middle;
  }
  return centres;
}

void fill_inside(FieldLeaf& leaf, const openvdb::Coord& low, int edge) {
  for (int x = 0; x < edge; ++x) {
    for (int y = 0; y < edge; ++y) {
      for (int z = 0; z < edge; ++z) leaf.setValueOff(low.offsetBy(x, y, z), -kBand);
    }
  }
}

}  // namespace

// The largest reach of the points in each part of a leaf.
class LeafDistances::PartReach {
 public:
  explicit PartReach(const LeafReach& points) : points_(points) {
    pairs_.fill(-1);
    halves_.fill(-1);
    for (std::uint32_t n = 0; n < FieldLeaf::SIZE; ++n) {
      const openvdb::Coord at = FieldLeaf::offsetToLocalCoord(n);
      float& pair = pairs_[index(at, 2)];
      pair = std::max(pair, points[n]);
      float& half = halves_[index(at, 4)];
      half = std::max(half, points[n]);
    }
  }

  // Of the cube of `edge` points (4, 2 or 1) at `low`.
  [[nodiscard]] double operator()(const openvdb::Coord& low, int edge) const {
    const std::size_t n = index(low, edge);
    return static_cast<double>(edge == 4 ? halves_[n] : (edge == 2 ? pairs_[n] : points_[n]));
  }

 private:
  static std::size_t index(const openvdb::Coord& at, int edge) {
    constexpr int kMask = kLeafEdge - 1;
    const int parts = kLeafEdge / edge;
    const int n = ((at.x() & kMask) / edge * parts + (at.y() & kMask) / edge) * parts +
                  (at.z() & kMask) / edge;
    return static_cast<std::size_t>(n);
  }

  std::array<float, 8> halves_{};  // of edge 4
  std::array<float, 64> pairs_{};  // of edge 2
  const LeafReach& points_;
};

void LeafDistances::fill(FieldLeaf& leaf, const Candidates& candidates, const LeafReach* reach) {
  std::optional<PartReach> part_reach;
  if (reach != nullptr) part_reach.emplace(*reach);
  fill_part(leaf, leaf.origin(), kLeafEdge, candidates, part_reach ? &*part_reach : nullptr,
            workspaces_.local().data());
}

// Fills the cube of `edge` grid points at `low`, part by eighth part: those that the band does not
// reach at once, the others from the candidates that can be closest to one of their points.
void LeafDistances::fill_part(FieldLeaf& leaf, const openvdb::Coord& low, int edge,
                              const Candidates& candidates, const PartReach* part_reach,
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
    const double band = part_reach == nullptr ? double{kBand} : (*part_reach)(part, half);
    if (band < 0) continue;
    const double distance = std::sqrt(closest[k]);
    if (half == 1) {
      set(leaf, part, distance);
    } else if (distance - offset_ > radius + band + kDistanceSlack) {
      continue;  // the leaf was made with +kBand
    } else if (distance - offset_ < -(radius + kBand + kDistanceSlack)) {
      fill_inside(leaf, part, half);
    } else {
      const double reach =
          std::min(distance + 2 * radius, offset_ + band + radius) + kDistanceSlack;
      Candidates& narrowed = workspace->narrowed;
      narrowed.clear();
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (squared[i][k] <= reach * reach) narrowed.push_back(candidates[i]);
      }
      fill_part(leaf, part, half, narrowed, part_reach, workspace + 1);
    }
  }
}

void LeafDistances::set(FieldLeaf& leaf, const openvdb::Coord& at, double distance) const {
  const auto phi = static_cast<float>(to_quantum(distance - offset_));
  if (std::fabs(phi) < kBand) {
    leaf.setValueOn(at, phi);
  } else if (phi < 0) {
    leaf.setValueOff(at, -kBand);
  }
}

}  // namespace cellocut
