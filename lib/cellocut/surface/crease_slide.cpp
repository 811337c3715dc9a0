#include "cellocut/surface/crease_slide.h"

#include <cmath>

namespace cellocut {

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;
// Cosine of the least angle between two sides that counts as a crease, 20 degrees.
constexpr double kLeastAngle = 0.94;
constexpr double kLongest = 2;     // way, in offsets
constexpr double kStep = 0.25;     // in offsets
constexpr double kShare = 0.9;     // of the way to the bottom
constexpr double kMostTurn = 0.7;  // cosine of how far the side may turn in a step

}  // namespace

CreaseSlide::CreaseSlide(const TriangleSoup& surface, const std::vector<PullTarget>& targets,
                         const NearestTriangle& input, double offset, double distance)
    : surface_(surface),
      targets_(targets),
      input_(input),
      offset_(offset),
      distance_(distance),
      partner_(targets.size(), kNone) {
  for (const Triangle& t : surface.triangles) {
    for (int k = 0; k < 3; ++k) consider(t[k], t[(k + 1) % 3]);
  }
}

// In a closed oriented surface every edge is seen from both of its ends. Of several partners the
// one whose side is at the largest angle is taken.
void CreaseSlide::consider(std::uint32_t vertex, std::uint32_t other) {
  const Point3& a = targets_[vertex].direction;
  const Point3& b = targets_[other].direction;
  if (squared_norm(a) == 0 || squared_norm(b) == 0) return;
  const double cosine = dot(a, b);
  if (cosine > kLeastAngle || cosine < -kLeastAngle) return;
  if (dot(surface_.points[other] - surface_.points[vertex], b - a) >= 0) return;  // convex
  if (partner_[vertex] == kNone || cosine < dot(a, targets_[partner_[vertex]].direction)) {
    partner_[vertex] = other;
  }
}

Point3 CreaseSlide::operator()(std::uint32_t vertex, const Point3& to) const {
  if (partner_[vertex] == kNone) return to;
  const double whole = slide(vertex, to, kLongest * offset_).length;
  return slide(vertex, to, kShare * whole).place;
}

// Goes down the vertex's side, away from where the other side faces, until another part of the
// input comes near, the side turns away, or `limit` is reached.
CreaseSlide::End CreaseSlide::slide(std::uint32_t vertex, const Point3& from, double limit) const {
  const Point3& facing = targets_[partner_[vertex]].direction;
  Point3 side = targets_[vertex].direction;
  End end{from, 0};
  while (end.length < limit) {
    const Point3 down = dot(side, facing) * side - facing;
    const double length = std::sqrt(squared_norm(down));
    if (!(length > 0.05)) break;  // the other side faces this one: there is no bottom
    const double step = std::fmin(kStep * offset_, limit - end.length);
    const Point3 next = end.place + (step / length) * down;
    const NearestPoint nearest = input_(next, offset_);
    if (!nearest.found() || !(nearest.distance > 0)) break;
    const Point3 next_side = (1 / nearest.distance) * (next - nearest.point);
    if (dot(next_side, side) < kMostTurn) break;
    const Point3 place = nearest.point + distance_ * next_side;
    if (input_.may_separate(end.place, place)) break;
    if (input_(place, 2 * distance_).distance < 0.5 * distance_) break;
    end.place = place;
    end.length += step;
    side = next_side;
  }
  return end;
}

}  // namespace cellocut
