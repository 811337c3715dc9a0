#include "cellocut/view/ray_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "cellocut/base/errors.h"
#include "cellocut/measure/sampling.h"

namespace cellocut {

namespace {

// Beyond this many units from the frame, single precision places nothing any more.
constexpr double kFarthest = 1e6;
// How far Embree's distances may be off: some units in the last place of single precision, of the
// coordinates and of the distance.
float slack(float distance) { return 1e-6F + 1e-5F * std::fabs(distance); }
// Distances are compared as multiples of this, so that coincident faces are at the same.
constexpr double kSameDistance = 1e-9;

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
  // Along the ray to the plane of the face; `found`, Embree's answer, where rounding makes that no
  // better (a face seen edge-on).
  [[nodiscard]] double distance_to(std::uint32_t face, const Ray& ray, float found) const {
    const double slope = dot(normals[face], ray.direction);
    const double distance = dot(normals[face], points[faces[face][0]] - ray.origin) / slope;
    return std::fabs(distance - found) <= slack(found) ? distance : found;
  }
};

namespace {

void check(RTCDevice device) {
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    throw LimitError("Embree cannot build its hierarchy: out of memory");
  }
}

RTCRay embree_ray(const Ray& ray, float farthest) {
  RTCRay result{};
  result.org_x = static_cast<float>(ray.origin[0]);
  result.org_y = static_cast<float>(ray.origin[1]);
  result.org_z = static_cast<float>(ray.origin[2]);
  result.dir_x = static_cast<float>(ray.direction[0]);
  result.dir_y = static_cast<float>(ray.direction[1]);
  result.dir_z = static_cast<float>(ray.direction[2]);
  result.tnear = 0;
  result.tfar = farthest;
  result.mask = 0xFFFFFFFFU;
  return result;
}

}  // namespace

void RayScene::Scene::build() {
  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw Error("Embree cannot be started");
  scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST |
                                                     RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* places = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), points.size()));
  auto* corners = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              3 * sizeof(std::uint32_t), faces.size()));
  if (places == nullptr || corners == nullptr) {
    rtcReleaseGeometry(geometry);
    throw LimitError("Embree cannot build its hierarchy: out of memory");
  }
  for (const Point3& p : points) {
    places = std::transform(p.begin(), p.end(), places,
                            [](double value) { return static_cast<float>(value); });
  }
  for (const Triangle& t : faces) corners = std::copy(t.begin(), t.end(), corners);
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
  RTCIntersectContext plain;
  rtcInitIntersectContext(&plain);
  RTCRayHit nearest{};
  nearest.ray = embree_ray(ray, std::numeric_limits<float>::infinity());
  nearest.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->scene, &plain, &nearest);
  if (nearest.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  // Which of several faces Embree found depends on its search: all that lie about as near are
  // looked at again.
  struct Search {
    RTCIntersectContext context;  // first: its address is what the filter is given
    const Scene* scene;
    const Ray* ray;
    std::tuple<double, bool, std::uint32_t> best;  // distance in steps, back seen, face
    double distance;
    static void look_at(const RTCFilterFunctionNArguments* a) {
      auto& search = *reinterpret_cast<Search*>(a->context);
      const auto* found = reinterpret_cast<const RTCRay*>(a->ray);
      const auto* hit = reinterpret_cast<const RTCHit*>(a->hit);
      const double distance = search.scene->distance_to(hit->primID, *search.ray, found->tfar);
      const bool back = dot(search.scene->normals[hit->primID], search.ray->direction) > 0;
      const std::tuple key{std::floor(distance / kSameDistance), back, hit->primID};
      if (key < search.best) {
        search.best = key;
        search.distance = distance;
      }
      a->valid[0] = 0;  // go on
    }
  };
  Search search{.context = {},
                .scene = scene_.get(),
                .ray = &ray,
                .best = {std::numeric_limits<double>::infinity(), true, 0},
                .distance = 0};
  rtcInitIntersectContext(&search.context);
  search.context.filter = &Search::look_at;
  RTCRayHit candidates{};
  candidates.ray = embree_ray(ray, nearest.ray.tfar + slack(nearest.ray.tfar));
  candidates.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_->scene, &search.context, &candidates);
  if (std::isinf(std::get<0>(search.best))) return std::nullopt;  // at the origin itself
  const std::uint32_t face = std::get<2>(search.best);
  return Hit{.face = scene_->source[face],
             .distance = search.distance,
             .normal = scene_->normals[face],
             .front = !std::get<1>(search.best)};
}

bool RayScene::is_blocked(const Ray& ray, double distance) const {
  if (scene_->scene == nullptr) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay shadow = embree_ray(ray, static_cast<float>(distance));
  rtcOccluded1(scene_->scene, &context, &shadow);
  return shadow.tfar < 0;
}

}  // namespace cellocut
