#include "cellocut/surface/crease_slide.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

namespace cellocut {

namespace {

// Cosine of the least angle between two sides that counts as a crease, 20 degrees.
constexpr double kLeastAngle = 0.94;
constexpr double kLongest = 2;     // way, in offsets
constexpr double kStep = 0.25;     // in offsets
constexpr double kShare = 0.9;     // of the way to the bottom
constexpr double kMostTurn = 0.7;  // cosine of how far the side may turn in a step

}  // namespace

CreaseSlide::CreaseSlide(const TriangleSoup& surface, std::span<const PullTarget> targets,
                         const NearestTriangle& input, double offset, double distance)
    : surface_(surface),
      targets_(targets),
      input_(input),
      offset_(offset),
      distance_(distance),
      facing_(targets.size()) {
  // By bits, the edges of each face that lead across a crease. (Summed one after the other: few are
  // creases, and the sum depends on the order.)
  std::vector<std::uint8_t> creases(surface.triangles.size());
  tbb::parallel_for(std::size_t{0}, creases.size(), [&](std::size_t f) {
    const Triangle& t = surface.triangles[f];
    for (int k = 0; k < 3; ++k) {
      if (crosses_crease(t[k], t[(k + 1) % 3])) creases[f] |= 1U << k;
    }
  });
  for (std::size_t f = 0; f < creases.size(); ++f) {
    if (creases[f] == 0) continue;
    const Triangle& t = surface.triangles[f];
    for (int k = 0; k < 3; ++k) {
      if ((creases[f] >> k & 1) == 0) continue;
      facing_[t[k]] = facing_[t[k]] + targets[t[(k + 1) % 3]].direction;
    }
  }
}

// In a closed oriented surface every edge is seen from both of its ends. (The sum of all that a
// vertex has across creases, and not one of them: which is chosen among equals would be up to the
// last bit.)
bool CreaseSlide::crosses_crease(std::uint32_t vertex, std::uint32_t other) const {
  const Point3& a = targets_[vertex].direction;
  const Point3& b = targets_[other].direction;
  if (squared_norm(a) == 0 || squared_norm(b) == 0) return false;
  const double cosine = dot(a, b);
  if (cosine > kLeastAngle || cosine < -kLeastAngle) return false;
  return dot(surface_.points[other] - surface_.points[vertex], b - a) < 0;  // else it is convex
}

Point3 CreaseSlide::operator()(std::uint32_t vertex, const Point3& to) const {
  const double sum = std::sqrt(squared_norm(facing_[vertex]));
  if (!(sum > 0.5)) return to;  // not at a crease, or between sides that face each other
  const Point3 facing = (1 / sum) * facing_[vertex];
  const double step = kStep * offset_;
  // The whole way first.
  constexpr int kMostSteps = static_cast<int>(kLongest / kStep);
  std::array<Footing, kMostSteps + 1> way;
  way[0] = {to, targets_[vertex].direction};
  int steps = 0;
  while (steps < kMostSteps) {
    const std::optional<Footing> next = step_down(way[steps], facing, step);
    if (!next) break;
    way[++steps] = *next;
  }
  const double length = kShare * steps;  // in steps
  const int whole = static_cast<int>(length);
  if (length == whole) return way[whole].place;
  const std::optional<Footing> end = step_down(way[whole], facing, (length - whole) * step);
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
  if (input_(place, 2 * distance_).distance < 0.5 * distance_) return std::nullopt;
  return Footing{place, side};
}

}  // namespace cellocut
