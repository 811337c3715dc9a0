#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "cellocut/base/errors.h"
#include "viz/plane_section.h"
#include "viz/section.h"

namespace cellocut::viz {

namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

// The whole text as one finite number.
std::optional<double> number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::optional<Plane> axis_plane(std::string_view text, const Box3& box) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return {};
  const std::string_view axis_name = trimmed(text.substr(0, equals));
  if (axis_name != "x" && axis_name != "y" && axis_name != "z") return {};
  const int axis = axis_name.front() - 'x';
  std::string_view value = trimmed(text.substr(equals + 1));
  const bool per_cent = value.ends_with('%');
  if (per_cent) value.remove_suffix(1);
  std::optional<double> offset = number(value);
  if (!offset) return {};
  if (per_cent) offset = box.low[axis] + *offset / 100 * (box.high[axis] - box.low[axis]);
  Plane plane;
  plane.normal = {0, 0, 0};
  plane.normal[axis] = 1;
  plane.offset = *offset;
  return plane;
}

std::optional<Plane> general_plane(std::string_view text) {
  std::array<double, 4> values{};
  for (int i = 0; i < 4; ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (i == 3)) return {};
    const std::optional<double> value = number(text.substr(0, comma));
    if (!value) return {};
    values[i] = *value;
    if (i < 3) text.remove_prefix(comma + 1);
  }
  const Plane plane{{values[0], values[1], values[2]}, values[3]};
  // hypot neither overflows nor underflows, so only a zero normal is refused.
  if (std::hypot(values[0], values[1], values[2]) == 0) return {};
  return plane;
}

}  // namespace

Plane parse_plane(const std::string& text, const Box3& box) {
  if (const std::optional<Plane> plane = axis_plane(text, box)) return *plane;
  if (const std::optional<Plane> plane = general_plane(text)) return *plane;
  throw UsageError(
      "plane '" + text +
      "': give x=0.5 (or y, z), x=50% (per cent of the box), or nx,ny,nz,offset with a "
      "normal that is not zero");
}

PlaneFrame plane_frame(const Plane& plane) {
  const Point3& n = plane.normal;
  int axis = 0;
  if (std::abs(n[1]) > std::abs(n[axis])) axis = 1;
  if (std::abs(n[2]) > std::abs(n[axis])) axis = 2;
  // Towards the viewer: +x, -y or +z.
  const double length = std::hypot(n[0], n[1], n[2]);
  const double sign = (n[axis] > 0) == (axis != 1) ? 1 : -1;
  const Point3 viewer = (sign / length) * n;
  Point3 up = axis == 2 ? Point3{0, 1, 0} : Point3{0, 0, 1};
  up = up - dot(up, viewer) * viewer;
  up = (1 / norm(up)) * up;
  return {cross(up, viewer), up};
}

}  // namespace cellocut::viz
