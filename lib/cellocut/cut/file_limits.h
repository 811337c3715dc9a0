// What a problem file may demand before it is believed. Internal to the problem files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "cellocut/cut/cut_problem.h"

namespace cellocut::cut_io {

// DIMACS ids are 32-bit and start at 1, source and sink among them.
inline constexpr std::uint64_t kMostIds = std::numeric_limits<std::uint32_t>::max();
inline constexpr std::uint64_t kMostNodes = kMostIds - 2;

// Nodes may be isolated, so no record has to stand for them and a file of thirty bytes could ask
// for the memory of billions. Most have an arc, though, which takes eight bytes at least.
constexpr bool plausible_node_count(std::uint64_t nodes, std::size_t bytes) {
  constexpr std::uint64_t kFree = std::uint64_t{1} << 20;
  return nodes <= kFree + bytes;
}

// The sum of the capacities read so far, kept below the bound of CutProblem::validate, so that no
// sum formed while reading can overflow and the error can name the place.
class CapacitySum {
 public:
  // False where the sum reaches kCapacityLimit. Precondition: capacity >= 0.
  [[nodiscard]] bool add(std::int64_t capacity) {
    if (capacity >= kCapacityLimit - sum_) return false;
    sum_ += capacity;
    return true;
  }

 private:
  std::int64_t sum_ = 0;
};

inline constexpr const char* kSumTooLarge =
    "the capacities up to here sum to 2^62 or more and would overflow";

}  // namespace cellocut::cut_io
