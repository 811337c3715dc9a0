#include "cellocut/view/clay.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cellocut {

namespace {

constexpr LinearColour kFront{0.60, 0.56, 0.50};
constexpr LinearColour kBack{0.60, 0.13, 0.05};
constexpr double kSky = 0.50;
constexpr double kKey = 0.75;
constexpr double kFill = 0.10;
constexpr double kReach = 0.5;        // of what dims the sky, in the frame
constexpr double kLift = 2e-4;        // above the surface, where the look at the sky begins
constexpr double kDarkestSky = 0.15;  // of a point that sees none of it: light finds its way

// In the camera's axes: right, up, towards the viewer; of unit length.
Point3 unit(const Point3& v) { return (1 / norm(v)) * v; }

using Sky = std::array<Point3, kSkyDirections>;

Sky make_sky() {
  Sky sky;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kSkyDirections; ++i) {
    const double height = 1 - (2.0 * i + 1) / kSkyDirections;
    const double radius = std::sqrt(1 - height * height);
    sky[i] = {radius * std::cos(golden * i), height, radius * std::sin(golden * i)};
  }
  return sky;
}

// The share of the sky that is seen, by cosine. The mean cosine over the upper half of all
// directions is 1/4.
double open_sky(const RayScene& scene, const Camera& camera, const Point3& from,
                const Point3& normal, int sample, int samples) {
  static const Sky directions = make_sky();
  double seen = 0;
  int asked = 0;
  for (int i = sample % samples; i < kSkyDirections; i += samples) {
    ++asked;
    const Point3& d = directions[i];
    const Point3 direction = d[0] * camera.right + d[1] * camera.up + d[2] * camera.back;
    const double cosine = dot(normal, direction);
    if (cosine <= 0 || scene.is_blocked({from, direction}, kReach)) continue;
    seen += cosine;
  }
  return asked == 0 ? 1 : 4 * seen / asked;
}

}  // namespace

LinearColour clay_colour(const RayScene& scene, const Camera& camera, const Ray& ray,
                         const RayScene::Hit& hit, int sample, int samples) {
  static const Point3 key_direction = unit({-0.45, 0.65, 0.75});
  static const Point3 fill_direction = unit({0.8, 0.05, 0.5});
  const Point3 normal = hit.front ? hit.normal : -1.0 * hit.normal;
  const Point3 seen{dot(normal, camera.right), dot(normal, camera.up), dot(normal, camera.back)};
  const Point3 from = ray.origin + hit.distance * ray.direction + kLift * normal;
  const double open = open_sky(scene, camera, from, normal, sample, samples);
  const double sky = kSky * (kDarkestSky + (1 - kDarkestSky) * open) * (0.8 + 0.2 * seen[1]);
  const double key =
      kKey * std::max(0.0, dot(seen, key_direction)) * (0.4 + 0.6 * std::min(open, 1.0));
  const double fill = kFill * std::max(0.0, dot(seen, fill_direction));
  LinearColour colour = hit.front ? kFront : kBack;
  for (double& channel : colour) channel *= sky + key + fill;
  return colour;
}

std::array<std::uint8_t, 3> to_srgb(const LinearColour& colour) {
  std::array<std::uint8_t, 3> result{};
  for (int k = 0; k < 3; ++k) {
    const double c = std::clamp(colour[k], 0.0, 1.0);
    const double curve = c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    result[k] = static_cast<std::uint8_t>(std::lround(255 * curve));
  }
  return result;
}

}  // namespace cellocut
