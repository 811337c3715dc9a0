#include "cellocut/surface/crease_slide.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <vector>

namespace cellocut {

namespace {

// Cosine of the least angle between two sides that counts as a crease, 20 degrees.
constexpr double kLeastAngle = 0.94;
constexpr double kLongest = 2;     // way, in offsets
constexpr double kStep = 0.25;     // in offsets
constexpr double kShare = 0.9;     // of the way to the bottom
constexpr double kMostTurn = 0.7;  // cosine of how far the side may turn in a step

}  // namespace

CreaseSlide::CreaseSlide(std::span<const Point3> points, const std::vector<Triangle>& triangles,
                         const Buckets& corners_at, std::span<const Point3> sides,
                         const NearestTriangle& input, double offset, double distance)
    : points_(points),
      triangles_(triangles),
      corners_at_(corners_at),
      sides_(sides),
      input_(input),
      offset_(offset),
      distance_(distance),
      at_crease_(std::make_unique<std::uint8_t[]>(points.size())) {
  const auto mark = [this](std::uint32_t vertex) {
    std::atomic_ref(at_crease_[vertex]).store(1, std::memory_order_relaxed);
  };
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles[f][k];
      const std::uint32_t to = triangles[f][(k + 1) % 3];
      if (from > to || !crosses_crease(from, to)) continue;  // the other face has it from `to`
      mark(from);
      mark(to);
    }
  });
}

// In a closed oriented surface each edge of a vertex leads out of it in one face. (The sum of all
// across creases, and not one of them: which is chosen among equals would be up to the last bit. In
// the order of the faces, as the sum depends on it.)
Point3 CreaseSlide::facing(std::uint32_t vertex) const {
  std::vector<std::uint32_t> across;  // corners
  for (const std::uint32_t corner : corners_at_[vertex]) {
    if (crosses_crease(vertex, next(corner))) across.push_back(corner);
  }
  std::sort(across.begin(), across.end());
  Point3 sum{};
  for (const std::uint32_t corner : across) sum = sum + sides_[next(corner)];
  return sum;
}

bool CreaseSlide::crosses_crease(std::uint32_t vertex, std::uint32_t other) const {
  const Point3& a = sides_[vertex];
  const Point3& b = sides_[other];
  if (squared_norm(a) == 0 || squared_norm(b) == 0) return false;
  const double cosine = dot(a, b);
  if (cosine > kLeastAngle || cosine < -kLeastAngle) return false;
  return dot(points_[other] - points_[vertex], b - a) < 0;  // else it is convex
}

Point3 CreaseSlide::operator()(std::uint32_t vertex, const Point3& to) const {
  if (at_crease_[vertex] == 0) return to;
  const Point3 across = facing(vertex);
  const double sum = std::sqrt(squared_norm(across));
  if (!(sum > 0.5)) return to;  // between sides that face each other
  const Point3 direction = (1 / sum) * across;
  const double step = kStep * offset_;
  // The whole way first.
  constexpr int kMostSteps = static_cast<int>(kLongest / kStep);
  std::array<Footing, kMostSteps + 1> way;
  way[0] = {to, sides_[vertex]};
  int steps = 0;
  while (steps < kMostSteps) {
    const std::optional<Footing> next = step_down(way[steps], direction, step);
    if (!next) break;
    way[++steps] = *next;
  }
  const double length = kShare * steps;  // in steps
  const int whole = static_cast<int>(length);
  if (length == whole) return way[whole].place;
  const std::optional<Footing> end = step_down(way[whole], direction, (length - whole) * step);
  return end ? end->place : way[whole].place;
}

// Goes a step along its side of the input, away from where the other side faces. None where there
// is no bottom, where another part of the input is near or in between, or where the side turns
// away.
std::optional<CreaseSlide::Footing> CreaseSlide::step_down(const Footing& from,
                                                           const Point3& facing,
                                                           double step) const {
  const Point3 down = dot(from.side, facing) * from.side - facing;
  const double length = std::sqrt(squared_norm(down));
  if (!(length > 0.05)) return std::nullopt;  // the other side faces this one
  const Point3 ahead = from.place + (step / length) * down;
  const NearestPoint nearest = input_(ahead, offset_);
  if (!nearest.found() || !(nearest.distance > 0)) return std::nullopt;
  const Point3 side = (1 / nearest.distance) * (ahead - nearest.point);
  if (dot(side, from.side) < kMostTurn) return std::nullopt;
  const Point3 place = nearest.point + distance_ * side;
  if (input_.may_separate(from.place, place)) return std::nullopt;
  if (input_(place, 0.5 * distance_).found()) return std::nullopt;
  return Footing{place, side};
}

}  // namespace cellocut
