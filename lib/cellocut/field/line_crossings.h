// Where the grid lines along one axis pass through triangles.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "cellocut/field/frame.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

class LineCrossings {
 public:
  // Lines along `axis`; they are named by their grid indices j and k along axis + 1 and axis + 2
  // (mod 3), both in [0, frame.extent). `mesh` is in input units. Coverage is decided by exact
  // predicates and a half-open rule: faces that share an edge leave no line between them and claim
  // none twice.
  LineCrossings(const TriangleSoup& mesh, const Frame& frame, int axis);

  // Whether an odd number of crossings on the line lie below `at`: inside, where the mesh bounds a
  // region.
  [[nodiscard]] bool inside(double at, int j, int k) const {
    const std::size_t line = line_number(j, k);
    std::size_t below = first_[line];
    while (below < first_[line + 1] && crossing_[below] < at) ++below;
    return ((below - first_[line]) & 1) != 0;
  }

  // The same for the grid points low, low + 1 and so on, by bits; count <= 32.
  [[nodiscard]] std::uint32_t inside_row(int low, int count, int j, int k) const {
    const std::size_t line = line_number(j, k);
    const std::uint32_t all = count < 32 ? (1U << count) - 1 : ~0U;
    std::uint32_t mask = 0;
    for (std::size_t n = first_[line]; n < first_[line + 1]; ++n) {
      if (crossing_[n] < low) {
        mask = ~mask;
        continue;
      }
      const double first = std::floor(crossing_[n]) + 1 - low;  // that lies beyond the crossing
      if (first >= count) break;
      mask ^= ~0U << static_cast<unsigned>(first);
    }
    return mask & all;
  }

  // How many grid points in [low, high) of the line are inside.
  [[nodiscard]] std::int64_t count_inside(int low, int high, int j, int k) const {
    const std::size_t line = line_number(j, k);
    std::int64_t count = 0;
    for (std::size_t n = first_[line]; n + 1 < first_[line + 1]; n += 2) {
      const auto from =
          std::max<std::int64_t>(low, static_cast<std::int64_t>(std::floor(crossing_[n])) + 1);
      const auto to =
          std::min<std::int64_t>(high - 1, static_cast<std::int64_t>(std::floor(crossing_[n + 1])));
      count += std::max<std::int64_t>(0, to - from + 1);
    }
    return count;
  }

  // Whether there is a crossing in [low, high).
  [[nodiscard]] bool crossed(double low, double high, int j, int k) const {
    const std::size_t line = line_number(j, k);
    for (std::size_t n = first_[line]; n < first_[line + 1]; ++n) {
      if (crossing_[n] >= low) return crossing_[n] < high;
    }
    return false;
  }

 private:
  [[nodiscard]] std::size_t line_number(int j, int k) const {
    return static_cast<std::size_t>(k) * extent_ + j;
  }

  int extent_;
  std::vector<std::size_t> first_;  // per line, into crossing_
  std::vector<double> crossing_;    // ascending on each line
};

}  // namespace cellocut
