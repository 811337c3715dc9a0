#include "cellocut/measure/nearest_triangle.h"

#include <embree3/rtcore.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

// Single precision in the hierarchy: relative to the coordinates, a few units in the last place.
constexpr double kRounding = 1e-6;

Point3 nearest_on_segment(const Point3& p, const Point3& a, const Point3& b) {
  const Point3 edge = b - a;
  const double squared = squared_norm(edge);
  const double t = squared > 0 ? std::clamp(dot(p - a, edge) / squared, 0.0, 1.0) : 0.0;
  return a + t * edge;
}

bool is_finite(const Point3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

}  // namespace

Point3 nearest_on_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
  const Point3 normal = cross(b - a, c - a);
  const double squared = squared_norm(normal);
  // Inside the prism over the triangle: the foot of the perpendicular.
  if (squared > 0 && dot(cross(normal, b - a), p - a) >= 0 &&
      dot(cross(normal, c - b), p - b) >= 0 && dot(cross(normal, a - c), p - c) >= 0) {
    return p - (dot(p - a, normal) / squared) * normal;
  }
  Point3 best = nearest_on_segment(p, a, b);
  double least = squared_norm(p - best);
  for (const Point3& q : {nearest_on_segment(p, b, c), nearest_on_segment(p, c, a)}) {
    const double distance = squared_norm(p - q);
    if (distance < least) {
      least = distance;
      best = q;
    }
  }
  return best;
}

// Coordinates are shifted and scaled so that the soup's box lies in [-1/2, 1/2]^3.
struct NearestTriangle::Scene {
  std::vector<std::array<Point3, 3>> corners;
  std::vector<std::uint32_t> face;  // corners[i] are those of this face of the soup
  Point3 centre{};
  double unit = 1;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  explicit Scene(const TriangleSoup& soup);
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  // The order of the corners and of the triangles is that of their coordinates: what is nearest, to
  // the last bit, does not depend on the order in the file.
  void sort_triangles() {
    std::vector<std::uint32_t> order(face.size());
    std::iota(order.begin(), order.end(), 0U);
    tbb::parallel_sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
      return corners[a] != corners[b] ? corners[a] < corners[b] : a < b;
    });
    std::vector<std::array<Point3, 3>> sorted_corners(order.size());
    std::vector<std::uint32_t> sorted_face(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
      sorted_corners[i] = corners[order[i]];
      sorted_face[i] = face[order[i]];
    }
    corners = std::move(sorted_corners);
    face = std::move(sorted_face);
  }

  [[nodiscard]] Point3 to_scene(const Point3& p) const {
    return {(p[0] - centre[0]) / unit, (p[1] - centre[1]) / unit, (p[2] - centre[2]) / unit};
  }

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto* self = static_cast<const Scene*>(arguments->geometryUserPtr);
    const std::array<Point3, 3>& t = self->corners[arguments->primID];
    const auto low = [&t](int axis) {
      return static_cast<float>(std::min({t[0][axis], t[1][axis], t[2][axis]}) - kRounding);
    };
    const auto high = [&t](int axis) {
      return static_cast<float>(std::max({t[0][axis], t[1][axis], t[2][axis]}) + kRounding);
    };
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = low(0);
    box.lower_y = low(1);
    box.lower_z = low(2);
    box.upper_x = high(0);
    box.upper_y = high(1);
    box.upper_z = high(2);
  }

  struct Query {
    const Scene* scene;
    Point3 p;  // in the scene's coordinates
    double slack;
    double squared = std::numeric_limits<double>::infinity();
    std::uint32_t primitive = NearestPoint::kNone;
    Point3 point{};

    [[nodiscard]] float radius() const {
      return static_cast<float>(std::sqrt(squared) * (1 + kRounding) + slack);
    }
  };

  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const std::uint32_t primitive = arguments->primID;
    const std::array<Point3, 3>& t = query.scene->corners[primitive];
    const Point3 point = nearest_on_triangle(query.p, t[0], t[1], t[2]);
    const double squared = squared_norm(query.p - point);
    const bool nearer = squared < query.squared;
    if (!nearer && !(squared == query.squared && primitive < query.primitive)) return false;
    query.squared = squared;
    query.primitive = primitive;
    query.point = point;
    if (!nearer) return false;
    arguments->query->radius = std::min(arguments->query->radius, query.radius());
    return true;
  }
};

NearestTriangle::Scene::Scene(const TriangleSoup& soup) {
  for (std::uint32_t f = 0; f < soup.triangles.size(); ++f) {
    const Triangle& t = soup.triangles[f];
    if (!is_finite(soup.points[t[0]]) || !is_finite(soup.points[t[1]]) ||
        !is_finite(soup.points[t[2]])) {
      continue;
    }
    corners.push_back({soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]});
    std::sort(corners.back().begin(), corners.back().end());
    face.push_back(f);
  }
  if (corners.empty()) return;
  sort_triangles();
  Box3 box{corners[0][0], corners[0][0]};
  for (const std::array<Point3, 3>& t : corners) {
    for (const Point3& p : t) {
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], p[axis]);
        box.high[axis] = std::max(box.high[axis], p[axis]);
      }
    }
  }
  centre = 0.5 * (box.low + box.high);
  unit = box.longest_edge() > 0 ? box.longest_edge() : 1.0;
  for (std::array<Point3, 3>& t : corners) {
    for (Point3& p : t) p = to_scene(p);
  }

  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw Error("Embree cannot be started");
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(corners.size()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* arguments) { bounds(arguments); }, nullptr);
  rtcSetGeometryPointQueryFunction(
      geometry, [](RTCPointQueryFunctionArguments* arguments) { return visit(arguments); });
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    throw LimitError("Embree cannot build its hierarchy: out of memory");
  }
}

NearestTriangle::NearestTriangle(const TriangleSoup& soup)
    : scene_(std::make_unique<Scene>(soup)) {}
NearestTriangle::~NearestTriangle() = default;
NearestTriangle::NearestTriangle(NearestTriangle&&) noexcept = default;
NearestTriangle& NearestTriangle::operator=(NearestTriangle&&) noexcept = default;

NearestPoint NearestTriangle::operator()(const Point3& p, double limit) const {
  const Scene& s = *scene_;
  NearestPoint result;
  if (s.scene == nullptr || !is_finite(p)) return result;
  const Point3 q = s.to_scene(p);
  const double size = std::max({std::fabs(q[0]), std::fabs(q[1]), std::fabs(q[2]), 1.0});
  Scene::Query query{.scene = &s, .p = q, .slack = kRounding * size};
  const double scaled_limit = limit / s.unit;
  query.squared = scaled_limit * scaled_limit;
  RTCPointQuery embree_query{static_cast<float>(q[0]), static_cast<float>(q[1]),
                             static_cast<float>(q[2]), 0.0F, query.radius()};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(s.scene, &embree_query, &context, nullptr, &query);
  if (query.primitive == NearestPoint::kNone) return result;
  result.face = s.face[query.primitive];
  result.point = s.centre + s.unit * query.point;
  result.distance = std::sqrt(query.squared) * s.unit;
  return result;
}

}  // namespace cellocut
