#include "cellocut/view/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "cellocut/base/errors.h"
#include "cellocut/base/line_coverage.h"
#include "cellocut/measure/embree_scene.h"
#include "cellocut/measure/sampling.h"

namespace cellocut {

namespace {

// Beyond this many units from the frame, single precision places nothing any more.
constexpr double kFarthest = 1e6;
// Distances are compared as multiples of this, so that coincident faces are at the same.
constexpr double kSameDistance = 1e-9;

// A ray in doubles, and as seen along itself. Sheared, not turned: which axis the ray runs along
// most is all that decides between the three ways to look along it (Woop, Benthin and Wald,
// "Watertight ray/triangle intersection", 2013).
struct Line {
  Point3 origin;
  Point3 direction;
  int along = 0;
  double shear_y = 0;
  double shear_z = 0;

  explicit Line(const Ray& ray) : origin(ray.origin), direction(ray.direction) {
    for (int axis = 1; axis < 3; ++axis) {
      if (std::fabs(direction[axis]) > std::fabs(direction[along])) along = axis;
    }
    shear_y = direction[(along + 1) % 3] / direction[along];
    shear_z = direction[(along + 2) % 3] / direction[along];
  }

  // A function of the line and the point alone: a corner lies in the same place for every face at
  // it.
  [[nodiscard]] Flat flat(const Point3& p) const {
    const Point3 q = p - origin;
    return {q[(along + 1) % 3] - shear_y * q[along], q[(along + 2) % 3] - shear_z * q[along]};
  }
  [[nodiscard]] double depth(const Point3& p) const {
    return (p[along] - origin[along]) / direction[along];
  }
};

}  // namespace

struct RayScene::Scene {
  std::vector<Point3> points;  // in the frame
  std::vector<Triangle> faces;
  std::vector<Point3> normals;
  std::vector<std::uint32_t> source;  // the face of the mesh that each of Embree's stands for
  double radius = 0;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Scene() = default;
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  void build();

  // Room for the rounding of boxes, and of rays that begin at most a little outside the mesh.
  [[nodiscard]] double margin() const { return 2e-6 * std::max(1.0, radius); }

  // Where the line passes through the face, in lengths of its direction; infinite where it does
  // not.
  [[nodiscard]] double distance_to(std::uint32_t face, const Line& line) const {
    const Point3& a = points[faces[face][0]];
    const Point3& b = points[faces[face][1]];
    const Point3& c = points[faces[face][2]];
    if (!line_passes(line.flat(a), line.flat(b), line.flat(c), {0, 0})) {
      return std::numeric_limits<double>::infinity();
    }
    const auto [low, high] = std::minmax({line.depth(a), line.depth(b), line.depth(c)});
    const double slope = dot(normals[face], line.direction);
    if (slope == 0) return low;
    return std::clamp(dot(normals[face], a - line.origin) / slope, low, high);
  }

  static void bounds(const RTCBoundsFunctionArguments* a);
  static void intersect(const RTCIntersectFunctionNArguments* a);
  static void occlude(const RTCOccludedFunctionNArguments* a);
};

namespace {

// What a search along a ray knows; its first member's address is what Embree hands on.
struct Search {
  RTCIntersectContext context{};
  Line line;
  // The nearest so far: distance in steps, back seen, face.
  std::tuple<double, bool, std::uint32_t> best{std::numeric_limits<double>::infinity(), true, 0};
  double distance = std::numeric_limits<double>::infinity();  // of it, or up to which to look
  double skipped = 0;  // from the line's origin to that of Embree's ray

  explicit Search(const Ray& ray) : line(ray) { rtcInitIntersectContext(&context); }
};

void check(RTCDevice device) {
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    throw LimitError("Embree cannot build its hierarchy: out of memory");
  }
}

// The ray for Embree's boxes, in single precision. It begins where the line enters a sphere around
// the mesh, so that coordinates are no larger than the mesh's; `skipped` says how far that is.
RTCRay embree_ray(const Ray& ray, double radius, double& skipped) {
  const double length = norm(ray.direction);
  const double nearest = -dot(ray.origin, ray.direction) / (length * length);
  skipped = std::max(0.0, nearest - 1.1 * radius / length);
  const Point3 start = ray.origin + skipped * ray.direction;
  RTCRay result{};
  result.org_x = static_cast<float>(start[0]);
  result.org_y = static_cast<float>(start[1]);
  result.org_z = static_cast<float>(start[2]);
  result.dir_x = static_cast<float>(ray.direction[0]);
  result.dir_y = static_cast<float>(ray.direction[1]);
  result.dir_z = static_cast<float>(ray.direction[2]);
  result.tnear = 0;
  result.tfar = std::numeric_limits<float>::infinity();
  result.mask = 0xFFFFFFFFU;
  return result;
}

}  // namespace

void RayScene::Scene::bounds(const RTCBoundsFunctionArguments* a) {
  const auto& self = *static_cast<const Scene*>(a->geometryUserPtr);
  const Triangle& t = self.faces[a->primID];
  Box3 box{self.points[t[0]], self.points[t[0]]};
  box.include(self.points[t[1]]);
  box.include(self.points[t[2]]);
  set_embree_bounds(*a->bounds_o, box, self.margin());
}

void RayScene::Scene::intersect(const RTCIntersectFunctionNArguments* a) {
  const auto& self = *static_cast<const Scene*>(a->geometryUserPtr);
  auto& search = *reinterpret_cast<Search*>(a->context);
  const double distance = self.distance_to(a->primID, search.line);
  if (!(distance > 0) || std::isinf(distance)) return;
  const bool back = dot(self.normals[a->primID], search.line.direction) > 0;
  const std::tuple key{std::floor(distance / kSameDistance), back, a->primID};
  if (key >= search.best) return;
  search.best = key;
  search.distance = distance;
  // Boxes that begin a little behind are still looked into.
  const double length = norm(search.line.direction);
  const double far = distance - search.skipped + 4 * self.margin() / length;
  reinterpret_cast<RTCRayHit*>(a->rayhit)->ray.tfar =
      std::nextafter(static_cast<float>(far), std::numeric_limits<float>::infinity());
}

void RayScene::Scene::occlude(const RTCOccludedFunctionNArguments* a) {
  const auto& self = *static_cast<const Scene*>(a->geometryUserPtr);
  const auto& search = *reinterpret_cast<const Search*>(a->context);
  const double distance = self.distance_to(a->primID, search.line);
  if (!(distance > 0) || distance > search.distance) return;
  reinterpret_cast<RTCRay*>(a->ray)->tfar = -std::numeric_limits<float>::infinity();
}

void RayScene::Scene::build() {
  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw LimitError("Embree cannot be started: too little memory");
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(faces.size()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(geometry, &Scene::bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, &Scene::intersect);
  rtcSetGeometryOccludedFunction(geometry, &Scene::occlude);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);
  check(device);
}

RayScene::RayScene(const TriangleSoup& mesh, const ViewFrame& frame)
    : scene_(std::make_unique<Scene>()) {
  scene_->points.reserve(mesh.points.size());
  for (const Point3& p : mesh.points) scene_->points.push_back(frame(p));
  TriangleSoup framed{.points = std::move(scene_->points), .triangles = mesh.triangles};
  const std::vector<Point3> normals = unit_normals(framed);
  scene_->points = std::move(framed.points);
  for (std::uint32_t f = 0; f < normals.size(); ++f) {
    if (squared_norm(normals[f]) == 0) continue;
    scene_->faces.push_back(mesh.triangles[f]);
    scene_->normals.push_back(normals[f]);
    scene_->source.push_back(f);
    for (const std::uint32_t corner : mesh.triangles[f]) {
      scene_->radius = std::max(scene_->radius, norm(scene_->points[corner]));
    }
  }
  if (scene_->radius > kFarthest) {
    throw InputError(
        "the mesh is over a million times larger than the frame it is seen in, or as "
        "far away");
  }
  if (!scene_->faces.empty()) scene_->build();
}

RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

double RayScene::radius() const { return scene_->radius; }

std::optional<RayScene::Hit> RayScene::first_hit(const Ray& ray) const {
  if (scene_->scene == nullptr) return std::nullopt;
  Search search(ray);
  RTCRayHit found{};
  found.ray = embree_ray(ray, scene_->radius, search.skipped);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->scene, &search.context, &found);
  if (std::isinf(search.distance)) return std::nullopt;
  const std::uint32_t face = std::get<2>(search.best);
  return Hit{.face = scene_->source[face],
             .distance = search.distance,
             .normal = scene_->normals[face],
             .front = !std::get<1>(search.best)};
}

bool RayScene::is_blocked(const Ray& ray, double distance) const {
  if (scene_->scene == nullptr) return false;
  Search search(ray);
  search.distance = distance;
  RTCRay shadow = embree_ray(ray, scene_->radius, search.skipped);
  rtcOccluded1(scene_->scene, &search.context, &shadow);
  return shadow.tfar < 0;
}

}  // namespace cellocut
