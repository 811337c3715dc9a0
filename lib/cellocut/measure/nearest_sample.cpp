#include "cellocut/measure/nearest_sample.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

// Single precision in the hierarchy: relative to the coordinates, a few units in the last place.
constexpr double kRounding = 1e-6;

Box3 box_of(const std::vector<Point3>& points) {
  Box3 box{points[0], points[0]};
  for (const Point3& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], p[axis]);
      box.high[axis] = std::max(box.high[axis], p[axis]);
    }
  }
  return box;
}

}  // namespace

// Embree sees coordinates shifted and scaled so that the points' box lies in [-1/2, 1/2]^3.
struct NearestSample::Scene {
  std::vector<Point3> points;
  Point3 centre{};
  double unit = 1;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  explicit Scene(std::vector<Point3> given);
  ~Scene() { release(); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  void release() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  [[nodiscard]] Point3 to_scene(const Point3& p) const {
    return {(p[0] - centre[0]) / unit, (p[1] - centre[1]) / unit, (p[2] - centre[2]) / unit};
  }

  static void bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto* self = static_cast<const Scene*>(arguments->geometryUserPtr);
    const Point3 p = self->to_scene(self->points[arguments->primID]);
    RTCBounds& box = *arguments->bounds_o;
    box.lower_x = static_cast<float>(p[0] - kRounding);
    box.lower_y = static_cast<float>(p[1] - kRounding);
    box.lower_z = static_cast<float>(p[2] - kRounding);
    box.upper_x = static_cast<float>(p[0] + kRounding);
    box.upper_y = static_cast<float>(p[1] + kRounding);
    box.upper_z = static_cast<float>(p[2] + kRounding);
  }

  struct Query {
    const Scene* scene;
    Point3 p;      // in the units of the points
    double slack;  // in the scene's, for the rounding of p
    double squared = std::numeric_limits<double>::infinity();
    std::uint32_t index = kNone;
  };

  static bool visit(RTCPointQueryFunctionArguments* arguments) {
    auto& query = *static_cast<Query*>(arguments->userPtr);
    const std::uint32_t index = arguments->primID;
    const double squared = squared_norm(query.scene->points[index] - query.p);
    if (squared > query.squared || (squared == query.squared && index > query.index)) return false;
    query.index = index;
    if (squared == query.squared) return false;
    query.squared = squared;
    const double radius = std::sqrt(squared) / query.scene->unit * (1 + kRounding) + query.slack;
    arguments->query->radius = std::min(arguments->query->radius, static_cast<float>(radius));
    return true;
  }
};

NearestSample::Scene::Scene(std::vector<Point3> given) : points(std::move(given)) {
  if (points.empty()) return;
  const Box3 box = box_of(points);
  centre = 0.5 * (box.low + box.high);
  unit = box.longest_edge() > 0 ? box.longest_edge() : 1.0;

  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw Error("Embree cannot be started");
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(points.size()));
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
    release();
    throw LimitError("Embree cannot build its hierarchy: out of memory");
  }
}

NearestSample::NearestSample(std::vector<Point3> points)
    : scene_(std::make_unique<Scene>(std::move(points))) {}
NearestSample::~NearestSample() = default;
NearestSample::NearestSample(NearestSample&&) noexcept = default;
NearestSample& NearestSample::operator=(NearestSample&&) noexcept = default;

NearestSample::Result NearestSample::operator()(const Point3& p) const {
  const Scene& s = *scene_;
  if (s.scene == nullptr) return {};
  const Point3 q = s.to_scene(p);
  const double size = std::max({std::fabs(q[0]), std::fabs(q[1]), std::fabs(q[2]), 1.0});
  Scene::Query query{.scene = &s, .p = p, .slack = kRounding * size};
  RTCPointQuery embree_query{static_cast<float>(q[0]), static_cast<float>(q[1]),
                             static_cast<float>(q[2]), 0.0F,
                             std::numeric_limits<float>::infinity()};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(s.scene, &embree_query, &context, nullptr, &query);
  return {query.index, std::sqrt(query.squared)};
}

}  // namespace cellocut
