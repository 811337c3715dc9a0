#include "cellocut/view/scan.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "cellocut/base/random_stream.h"
#include "cellocut/view/ray_scene.h"
#include "cellocut/view/thinning.h"

namespace cellocut {

namespace {

constexpr double kViewDistance = 3;      // of the viewpoints, in radii of the bounding sphere
constexpr double kGrazingCosine = 0.02;  // 1.1 degrees
constexpr double kGoldenAngle = std::numbers::pi * (3 - 2.2360679774997896964);

Point3 viewpoint_direction(std::size_t k, std::size_t count) {
  const double height = 1 - (2 * static_cast<double>(k) + 1) / static_cast<double>(count);
  const double around = kGoldenAngle * static_cast<double>(k);
  const double radius = std::sqrt(std::fmax(0.0, 1 - height * height));
  return {radius * std::cos(around), radius * std::sin(around), height};
}

// Two unit vectors at right angles to `direction` and to each other.
std::pair<Point3, Point3> sideways(const Point3& direction) {
  Point3 axis{0, 0, 0};
  int least = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::fabs(direction[k]) < std::fabs(direction[least])) least = k;
  }
  axis[least] = 1;
  const Point3 normal = cross(direction, axis);
  const Point3 right = (1 / norm(normal)) * normal;
  return {right, cross(direction, right)};
}

// What one viewpoint sees.
struct View {
  PointCloud cloud;  // in the frame
  std::uint64_t grazing = 0;
};

View look(const RayScene& scene, std::size_t k, const ScanOptions& options,
          const RandomStream& random) {
  View view;
  const Point3 direction = viewpoint_direction(k, options.viewpoints);
  const auto [right, up] = sideways(direction);
  const Point3 eye = kViewDistance * scene.radius() * direction;
  // Of the disc through the centre that hides the bounding sphere from the eye.
  const double disc = scene.radius() / std::sqrt(1 - 1 / (kViewDistance * kViewDistance));
  const double turned = 2 * std::numbers::pi * random(k);
  for (std::size_t i = 0; i < options.rays; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(options.rays);
    const double radius = disc * std::sqrt(share);
    const double angle = turned + kGoldenAngle * static_cast<double>(i);
    const Point3 target = radius * std::cos(angle) * right + radius * std::sin(angle) * up;
    const Point3 towards = target - eye;
    const Ray ray{eye, (1 / norm(towards)) * towards};
    const std::optional<RayScene::Hit> hit = scene.first_hit(ray);
    if (!hit) continue;
    if (std::fabs(dot(hit->normal, ray.direction)) < kGrazingCosine) {
      ++view.grazing;
      continue;
    }
    view.cloud.points.push_back(eye + hit->distance * ray.direction);
    view.cloud.normals.push_back((hit->front ? 1.0 : -1.0) * hit->normal);
  }
  return view;
}

void require(bool good, const char* what) {
  if (!good) throw UsageError(what);
}

}  // namespace

void ScanOptions::validate() const {
  require(viewpoints >= 1 && viewpoints <= 100'000, "viewpoints must be 1 to 100000");
  require(rays >= 1 && rays <= 10'000'000, "rays must be 1 to 10000000");
  require(viewpoints * rays <= 1'000'000'000, "viewpoints times rays must be at most 10^9");
  require(points >= 1 && points <= 100'000'000, "points must be 1 to 100000000");
  require(spacing == 0 || (spacing >= 1e-5 && spacing <= 1), "spacing must be 1e-5 to 1");
}

Scan scan_outside(const TriangleSoup& mesh, const ScanOptions& options, Observer& observer) {
  options.validate();
  observer.stage("rays");
  const ViewFrame frame = view_frame(mesh);
  const RayScene scene(mesh, frame);
  const RandomStream random(options.seed);
  std::vector<View> views(options.viewpoints);
  tbb::parallel_for(std::size_t{0}, options.viewpoints, [&](std::size_t k) {
    observer.check();
    views[k] = look(scene, k, options, random);
  });
  Scan scan{.cloud = {},
            .rays = options.viewpoints * options.rays,
            .hits = 0,
            .grazing = 0,
            .spacing = 0,
            .unit = frame.unit};
  PointCloud hits;
  for (View& view : views) {
    hits.points.insert(hits.points.end(), view.cloud.points.begin(), view.cloud.points.end());
    hits.normals.insert(hits.normals.end(), view.cloud.normals.begin(), view.cloud.normals.end());
    scan.grazing += view.grazing;
    view = View{};
  }
  scan.hits = hits.points.size() + scan.grazing;
  if (hits.points.empty()) throw InputError("nothing is seen from outside: no ray meets a face");
  observer.stage("thinning");
  observer.check();
  Thinning thinned;
  if (options.spacing > 0) {
    thinned = {thin_to_spacing(hits, options.spacing, options.seed), options.spacing};
  } else {
    thinned = thin_to_count(hits, options.points, options.seed);
  }
  scan.spacing = thinned.spacing;
  scan.cloud.points.reserve(thinned.kept.size());
  scan.cloud.normals.reserve(thinned.kept.size());
  for (const std::uint32_t i : thinned.kept) {
    scan.cloud.points.push_back(frame.centre + frame.unit * hits.points[i]);
    scan.cloud.normals.push_back(hits.normals[i]);
  }
  return scan;
}

}  // namespace cellocut
