#include "cellocut/surface/pull.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cellocut/surface/retreat.h"

namespace cellocut {

namespace {

// Where a supported vertex goes: to `distance` from its nearest point on the input.
struct Target {
  Point3 nearest{};    // on the input
  Point3 direction{};  // from there to the vertex, of length 1; 0 where it stays
};

// In a concave corner of the input the surface before the pull has a sharp crease, at `offset` from
// both faces; the vertices next to it are up to a grid step away from it, as the grid has it. They
// go to different faces, and the edge of the bevel that is left between them would have teeth. So
// they are shifted along their faces to the crease, up to a tenth of their distance from it.
class CreaseShift {
 public:
  CreaseShift(const TriangleSoup& surface, const std::vector<Target>& targets, double offset)
      : surface_(surface), targets_(targets), offset_(offset), partner_(targets.size(), kNone) {
    for (const Triangle& t : surface.triangles) {
      for (int k = 0; k < 3; ++k) consider(t[k], t[(k + 1) % 3]);
    }
  }

  // The way that the vertex is shifted, 0 where it is not at a crease.
  [[nodiscard]] Point3 operator()(std::uint32_t v) const {
    if (partner_[v] == kNone) return {};
    const Target& own = targets_[v];
    const Target& other = targets_[partner_[v]];
    const double beyond = dot(surface_.points[v] - other.nearest, other.direction) - offset_;
    // In the plane of its own face, at right angles to the crease.
    const double cosine = dot(own.direction, other.direction);
    const Point3 across = other.direction - cosine * own.direction;
    const double way = -0.9 * beyond / (1 - cosine * cosine);
    return beyond > 0 && std::fabs(way) < 2 * offset_ ? way * across : Point3{};
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  // Cosine of the least angle between two faces that counts as a crease, 20 degrees.
  static constexpr double kLeastAngle = 0.94;

  // In a closed oriented surface every edge is seen from both of its ends. Of several partners the
  // one whose face is at the largest angle is taken.
  void consider(std::uint32_t v, std::uint32_t other) {
    const Point3& a = targets_[v].direction;
    const Point3& b = targets_[other].direction;
    if (squared_norm(a) == 0 || squared_norm(b) == 0) return;
    const double cosine = dot(a, b);
    if (cosine > kLeastAngle || cosine < -kLeastAngle) return;
    if (dot(surface_.points[other] - surface_.points[v], b - a) >= 0) return;  // convex
    if (partner_[v] == kNone || cosine < dot(a, targets_[partner_[v]].direction)) {
      partner_[v] = other;
    }
  }

  const TriangleSoup& surface_;
  const std::vector<Target>& targets_;
  double offset_;
  std::vector<std::uint32_t> partner_;
};

}  // namespace

Quantiles quantiles_of(std::vector<double> values) {
  if (values.empty()) return {};
  const auto at = [&values](double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
  };
  return {at(0.5), at(0.95), at(1.0)};
}

PullReport pull_to_input(TriangleSoup& surface, const std::vector<std::uint8_t>& supported,
                         const NearestTriangle& input, double expected, double distance,
                         Observer& observer) {
  const std::size_t count = surface.points.size();
  PullReport report;
  report.distance = distance;
  report.vertices = static_cast<std::int64_t>(count);

  std::vector<Target> targets(count);
  std::vector<double> offset(count, 0);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    if (supported[v] == 0) return;
    const Point3& from = surface.points[v];
    NearestPoint nearest = input(from, 1.25 * expected);
    if (!nearest.found()) nearest = input(from);
    offset[v] = nearest.distance;
    if (!(nearest.distance > distance)) return;
    targets[v] = {nearest.point, (1 / nearest.distance) * (from - nearest.point)};
    offset[v] = distance;
  });
  std::vector<Point3> to(count);
  for (std::size_t v = 0; v < count; ++v) {
    const Target& target = targets[v];
    to[v] = squared_norm(target.direction) == 0 ? surface.points[v]
                                                : target.nearest + distance * target.direction;
  }
  const CreaseShift shift(surface, targets, expected);
  std::vector<Point3> beyond(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    beyond[v] = to[v];
    const Point3 way = shift(static_cast<std::uint32_t>(v));
    if (squared_norm(way) == 0) return;
    // Where the face bends the vertex would leave its distance, or even its side.
    const double left = input(to[v] + way, 2 * distance).distance;
    if (left >= 0.5 * distance && left <= 2 * distance) beyond[v] = to[v] + way;
  });
  observer.check();
  Retreat moved = move_vertices(surface.points, to, beyond, surface.triangles, observer);
  surface.points = std::move(moved.points);
  report.bad_faces_at_first = moved.bad_faces_at_first;
  report.rounds = moved.rounds;

  std::vector<double> offsets;
  for (std::size_t v = 0; v < count; ++v) {
    if (supported[v] == 0) continue;
    ++report.supported;
    const bool shifted = beyond[v] != to[v] && moved.fell_short[v] == 0;
    if (shifted) ++report.shifted;
    if (moved.halvings[v] == Retreat::kStayed) ++report.went_back;
    if (moved.halvings[v] > 0 && moved.halvings[v] < Retreat::kStayed) ++report.stopped_early;
    const bool as_asked = moved.halvings[v] == 0 && !shifted;
    offsets.push_back(as_asked ? offset[v] : input(surface.points[v]).distance);
  }
  report.offset = quantiles_of(std::move(offsets));
  return report;
}

}  // namespace cellocut
