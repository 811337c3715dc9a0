// The first of many that does not pass a test.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cstddef>

namespace cellocut {

// The lowest index below `count` for which is_bad(index) holds, or `count`. Where none is bad,
// is_bad has been called once for each; in parallel.
template <class IsBad>
std::size_t first_index(std::size_t count, const IsBad& is_bad) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 1024), count,
      [&](const auto& range, std::size_t first) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          if (is_bad(i)) return std::min(first, i);
        }
        return first;
      },
      [](std::size_t a, std::size_t b) { return std::min(a, b); });
}

}  // namespace cellocut
