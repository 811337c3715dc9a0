#include "cellocut/view/thinning.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "cellocut/base/random_stream.h"

namespace cellocut {

namespace {

// Points of all indices in an order that looks random.
std::vector<std::uint32_t> shuffled(std::size_t count, std::uint64_t seed) {
  const RandomStream random(seed);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(count);
  for (std::uint32_t i = 0; i < count; ++i) order[i] = {random.bits(i), i};
  tbb::parallel_sort(order.begin(), order.end());
  std::vector<std::uint32_t> result(count);
  std::transform(order.begin(), order.end(), result.begin(),
                 [](const auto& o) { return o.second; });
  return result;
}

// The kept points by the cell of a grid of the spacing: those within it lie in a cell or beside it.
class KeptPoints {
 public:
  KeptPoints(const PointCloud& cloud, double spacing)
      : cloud_(cloud), spacing_(spacing), low_(bounding_box(cloud.points).low) {}

  // Keeps the point unless one is kept already that is near.
  bool keep(std::uint32_t index) {
    const Point3& p = cloud_.points[index];
    std::array<std::int64_t, 3> cell{};
    for (int axis = 0; axis < 3; ++axis) {
      cell[axis] = static_cast<std::int64_t>((p[axis] - low_[axis]) / spacing_) + 1;
    }
    if (crowded(index, key(cell))) return false;  // most are
    for (std::int64_t i = -1; i <= 1; ++i) {
      for (std::int64_t j = -1; j <= 1; ++j) {
        for (std::int64_t k = -1; k <= 1; ++k) {
          if ((i != 0 || j != 0 || k != 0) &&
              crowded(index, key({cell[0] + i, cell[1] + j, cell[2] + k}))) {
            return false;
          }
        }
      }
    }
    const auto [place, fresh] = last_.try_emplace(key(cell), kNone);
    next_.emplace_back(index, place->second);
    place->second = static_cast<std::uint32_t>(next_.size() - 1);
    return true;
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  static std::uint64_t key(const std::array<std::int64_t, 3>& cell) {
    constexpr unsigned kBits = 21;
    return (static_cast<std::uint64_t>(cell[0]) << (2 * kBits)) |
           (static_cast<std::uint64_t>(cell[1]) << kBits) | static_cast<std::uint64_t>(cell[2]);
  }

  [[nodiscard]] bool crowded(std::uint32_t index, std::uint64_t cell) const {
    const auto found = last_.find(cell);
    if (found == last_.end()) return false;
    for (std::uint32_t n = found->second; n != kNone; n = next_[n].second) {
      const std::uint32_t other = next_[n].first;
      if (squared_norm(cloud_.points[other] - cloud_.points[index]) < spacing_ * spacing_ &&
          dot(cloud_.normals[other], cloud_.normals[index]) > 0) {
        return true;
      }
    }
    return false;
  }

  struct Hash {
    std::size_t operator()(std::uint64_t key) const { return mix_bits(key); }
  };

  const PointCloud& cloud_;
  double spacing_;
  Point3 low_;
  std::unordered_map<std::uint64_t, std::uint32_t, Hash> last_;  // by cell, into next_
  std::vector<std::pair<std::uint32_t, std::uint32_t>> next_;    // point, the one before it there
};

std::vector<std::uint32_t> thin(const PointCloud& cloud, double spacing,
                                const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> kept;
  if (cloud.points.empty()) return kept;
  KeptPoints points(cloud, spacing);
  std::copy_if(order.begin(), order.end(), std::back_inserter(kept),
               [&points](std::uint32_t index) { return points.keep(index); });
  std::sort(kept.begin(), kept.end());
  return kept;
}

}  // namespace

std::vector<std::uint32_t> thin_to_spacing(const PointCloud& cloud, double spacing,
                                           std::uint64_t seed) {
  return thin(cloud, spacing, shuffled(cloud.points.size(), seed));
}

Thinning thin_to_count(const PointCloud& cloud, std::size_t count, std::uint64_t seed) {
  std::vector<std::uint32_t> order = shuffled(cloud.points.size(), seed);
  if (cloud.points.size() <= count) {
    std::sort(order.begin(), order.end());
    return {std::move(order), 0};
  }
  const double extent = std::max(bounding_box(cloud.points).longest_edge(), 1e-6);
  const auto goal = static_cast<double>(count);
  double spacing = std::max(extent / std::sqrt(goal), 1e-6 * extent);
  // On a surface the number goes with 1 / spacing^2: aim at 99 % of the goal, a little below where
  // it was missed from above.
  constexpr int kTries = 12;
  Thinning best;
  for (int tries = 0; tries < kTries; ++tries) {
    std::vector<std::uint32_t> kept = thin(cloud, spacing, order);
    const auto reached = static_cast<double>(kept.size());
    if (kept.size() <= count && kept.size() > best.kept.size()) best = {std::move(kept), spacing};
    if (reached >= 0.98 * goal && reached <= goal) break;
    spacing = std::max(spacing * std::sqrt(reached / (0.99 * goal)), 1e-6 * extent);
  }
  return best;
}

}  // namespace cellocut
