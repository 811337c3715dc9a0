#include "cellocut/image/view_agreement.h"

#include <cmath>
#include <numbers>

namespace cellocut {

namespace {

// The mean of a function over the pixels that both cover.
template <class Measure>
std::optional<double> mean_over_common(const View& a, const View& b, const Measure& measure) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!a.covers(i) || !b.covers(i)) continue;
    sum += measure(i);
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

Point3 normal_at(const View& view, std::size_t i) {
  return {view.normals[i][0], view.normals[i][1], view.normals[i][2]};
}

}  // namespace

std::optional<double> silhouette_iou(const View& a, const View& b) {
  std::size_t both = 0;
  std::size_t either = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both += a.covers(i) && b.covers(i) ? 1 : 0;
    either += a.covers(i) || b.covers(i) ? 1 : 0;
  }
  if (either == 0) return std::nullopt;
  return static_cast<double>(both) / static_cast<double>(either);
}

std::optional<double> depth_error(const View& a, const View& b) {
  return mean_over_common(
      a, b, [&](std::size_t i) { return std::fabs(static_cast<double>(a.depth[i]) - b.depth[i]); });
}

std::optional<double> normal_error(const View& a, const View& b) {
  return mean_over_common(a, b, [&](std::size_t i) {
    const Point3 m = normal_at(a, i);
    const Point3 n = normal_at(b, i);
    // Unlike the arc cosine, exact for small angles.
    return std::atan2(norm(cross(m, n)), dot(m, n)) * 180 / std::numbers::pi;
  });
}

}  // namespace cellocut
