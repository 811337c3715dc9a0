#include "support/cut_families.h"

#include <cmath>
#include <numeric>
#include <random>

namespace cellocut::testing {

namespace {

constexpr std::int64_t kLargest = 1000;

// Integers that are the same everywhere (standard distributions are not).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(engine_() % bound); }
  std::int64_t capacity() { return 1 + below(kLargest); }

 private:
  std::mt19937_64 engine_;
};

CutProblem unconnected(std::size_t nodes) {
  CutProblem problem;
  problem.to_source.assign(nodes, 0);
  problem.to_sink.assign(nodes, 0);
  return problem;
}

void join(CutProblem& problem, std::uint32_t from, std::uint32_t to, Random& random) {
  problem.edges.push_back({from, to, random.capacity(), random.capacity()});
}

}  // namespace

CutProblem long_grid(std::uint32_t width, std::uint32_t length, std::uint64_t seed) {
  Random random(seed);
  CutProblem problem = unconnected(std::size_t{width} * length);
  for (std::uint32_t y = 0; y < length; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const std::uint32_t i = y * width + x;
      if (x + 1 < width) join(problem, i, i + 1, random);
      if (y + 1 < length) join(problem, i, i + width, random);
    }
  }
  for (std::uint32_t x = 0; x < width; ++x) {
    problem.to_source[x] = 2 * kLargest;
    problem.to_sink[std::size_t{length - 1} * width + x] = 2 * kLargest;
  }
  return problem;
}

CutProblem random_grid(std::uint32_t side, std::uint64_t seed) {
  Random random(seed);
  const std::uint32_t nodes = side * side * side;
  CutProblem problem = unconnected(nodes);
  for (std::uint32_t i = 0; i < nodes; ++i) {
    if (i % side + 1 < side) join(problem, i, i + 1, random);
    if (i / side % side + 1 < side) join(problem, i, i + side, random);
    if (i / side / side + 1 < side) join(problem, i, i + side * side, random);
    if (random.below(10) == 0) {
      (random.below(2) == 0 ? problem.to_source : problem.to_sink)[i] = 5 * random.capacity();
    }
  }
  return problem;
}

CutProblem layered_frames(std::uint32_t side, std::uint32_t depth, std::uint64_t seed) {
  Random random(seed);
  const std::uint32_t frame = side * side;
  const std::int64_t within = kLargest * frame;
  CutProblem problem = unconnected(std::size_t{frame} * depth);
  std::vector<std::uint32_t> next(frame);
  for (std::uint32_t d = 0; d < depth; ++d) {
    const std::uint32_t first = d * frame;
    for (std::uint32_t k = 0; k < frame; ++k) {
      if (k % side + 1 < side) problem.edges.push_back({first + k, first + k + 1, within, within});
      if (k + side < frame) problem.edges.push_back({first + k, first + k + side, within, within});
    }
    if (d + 1 == depth) break;
    std::iota(next.begin(), next.end(), first + frame);
    for (std::uint32_t k = frame; k > 1; --k) std::swap(next[k - 1], next[random.below(k)]);
    for (std::uint32_t k = 0; k < frame; ++k) {
      problem.edges.push_back({first + k, next[k], random.capacity(), 0});
    }
  }
  problem.to_source.front() = within;
  problem.to_sink.back() = within;
  return problem;
}

CutProblem random_levels(std::uint32_t width, std::uint32_t levels, std::uint64_t seed) {
  Random random(seed);
  CutProblem problem = unconnected(std::size_t{width} * levels);
  for (std::uint32_t level = 0; level + 1 < levels; ++level) {
    for (std::uint32_t k = 0; k < width; ++k) {
      for (int arc = 0; arc < 3; ++arc) {
        problem.edges.push_back(
            {level * width + k, (level + 1) * width + random.below(width), random.capacity(), 0});
      }
    }
  }
  for (std::uint32_t k = 0; k < width; ++k) {
    problem.to_source[k] = 3 * kLargest;
    problem.to_sink[std::size_t{levels - 1} * width + k] = 3 * kLargest;
  }
  return problem;
}

std::vector<FamilyMember> cut_families(std::uint32_t nodes, std::uint64_t seed) {
  const auto root = [nodes](double power, double share) {
    return std::max(3U, static_cast<std::uint32_t>(std::pow(share * nodes, power)));
  };
  const std::uint32_t narrow = root(1.0 / 3, 0.25);
  const std::uint32_t cube = root(1.0 / 3, 1);
  const std::uint32_t flat = root(1.0 / 4, 1);
  const std::uint32_t level = root(1.0 / 2, 1);
  return {{"long_grid", long_grid(narrow, nodes / narrow, seed)},
          {"random_grid", random_grid(cube, seed)},
          {"frames_long", layered_frames(flat, nodes / (flat * flat), seed)},
          {"frames_wide", layered_frames(root(2.0 / 5, 1), root(1.0 / 5, 1), seed)},
          {"levels_square", random_levels(level, nodes / level, seed)},
          {"levels_long", random_levels(narrow, nodes / narrow, seed)}};
}

}  // namespace cellocut::testing
