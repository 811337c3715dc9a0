// Items grouped by a small integer key, in compressed rows.
#pragma once

#include <tbb/parallel_for.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace cellocut {

inline constexpr std::uint32_t kNoBucket = UINT32_MAX;

class Buckets {
 public:
  // Puts item i of [0, items) into bucket key_of(i) of [0, buckets), or into none for kNoBucket.
  // The order of the items *within* a bucket depends on the schedule: whoever uses it sorts, or
  // computes what no order can change. O(items + buckets); parallel. Precondition: fewer than 2^32
  // items; key_of may be called at once from several threads.
  template <class KeyOf>
  Buckets(std::size_t buckets, std::size_t items, const KeyOf& key_of)
      : Buckets(of_groups(buckets, items, [&](std::size_t i, const auto& put) {
          const std::uint32_t key = key_of(i);
          if (key != kNoBucket) put(key, i);
        })) {}

  // The same where items come in groups: put_group(g, put) calls put(bucket, item) for each item of
  // group g of [0, groups).
  template <class PutGroup>
  static Buckets of_groups(std::size_t buckets, std::size_t groups, const PutGroup& put_group) {
    Buckets result;
    std::vector<std::uint32_t>& begin = result.begin_;
    begin.assign(buckets + 1, 0);
    tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t g) {
      put_group(g, [&](std::uint32_t key, std::size_t) { fetch_increment(begin[key]); });
    });
    std::uint32_t end = 0;
    for (std::uint32_t& entry : begin) {
      end += entry;
      entry = end;
    }
    result.items_ = std::make_unique_for_overwrite<std::uint32_t[]>(end);
    // Filling from the back turns each end into the begin of its bucket.
    tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t g) {
      put_group(g, [&](std::uint32_t key, std::size_t item) {
        result.items_[fetch_decrement(begin[key]) - 1] = static_cast<std::uint32_t>(item);
      });
    });
    return result;
  }

  [[nodiscard]] std::size_t size() const { return begin_.size() - 1; }
  // How many items lie in the buckets before this one.
  [[nodiscard]] std::size_t begin(std::size_t bucket) const { return begin_[bucket]; }
  [[nodiscard]] std::span<std::uint32_t> operator[](std::size_t bucket) {
    return {items_.get() + begin_[bucket], items_.get() + begin_[bucket + 1]};
  }
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t bucket) const {
    return {items_.get() + begin_[bucket], items_.get() + begin_[bucket + 1]};
  }

 private:
  Buckets() = default;

  static void fetch_increment(std::uint32_t& value) {
    std::atomic_ref(value).fetch_add(1, std::memory_order_relaxed);
  }
  static std::uint32_t fetch_decrement(std::uint32_t& value) {
    return std::atomic_ref(value).fetch_sub(1, std::memory_order_relaxed);
  }

  std::vector<std::uint32_t> begin_;
  std::unique_ptr<std::uint32_t[]> items_;  // memory that the threads touch first
};

}  // namespace cellocut
