#include "cellocut/validity/position_merge.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "cellocut/base/buckets.h"
#include "cellocut/base/point_hash.h"

namespace cellocut {

namespace {

// Well mixed in its highest bits.
std::uint64_t bucket_hash(const Point3& p) { return hash_of(p) * 0x9E3779B97F4A7C15U; }

}  // namespace

std::vector<std::uint32_t> merge_equal_positions(const std::vector<Point3>& points) {
  std::vector<std::uint32_t> first(points.size());
  const auto bits = static_cast<unsigned>(std::bit_width(points.size()));
  Buckets buckets(std::size_t{1} << bits, points.size(), [&](std::size_t i) {
    return is_finite(points[i]) ? static_cast<std::uint32_t>(bucket_hash(points[i]) >> (64U - bits))
                                : kNoBucket;
  });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size()), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      first[i] = static_cast<std::uint32_t>(i);
    }
  });
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, buckets.size()), [&](const auto& range) {
    for (std::size_t b = range.begin(); b < range.end(); ++b) {
      const auto bucket = buckets[b];
      if (bucket.size() < 2) continue;
      std::sort(bucket.begin(), bucket.end(), [&](std::uint32_t i, std::uint32_t j) {
        return points[i] != points[j] ? points[i] < points[j] : i < j;
      });
      for (std::size_t k = 1; k < bucket.size(); ++k) {
        if (points[bucket[k]] == points[bucket[k - 1]]) first[bucket[k]] = first[bucket[k - 1]];
      }
    }
  });
  return first;
}

}  // namespace cellocut
