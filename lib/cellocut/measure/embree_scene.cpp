#include "cellocut/measure/embree_scene.h"

#include "cellocut/base/errors.h"

namespace cellocut {

void EmbreeScene::build(std::size_t count, void* data, Bounds bounds, Visit visit) {
  device_ = rtcNewDevice(nullptr);
  if (device_ == nullptr) throw LimitError("Embree cannot be started: too little memory");
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
  rtcSetGeometryUserData(geometry, data);
  rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
  rtcSetGeometryPointQueryFunction(geometry, visit);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) {
    throw LimitError("Embree cannot build its hierarchy: out of memory");
  }
}

void EmbreeScene::query(const Point3& p, float radius, void* data) const {
  if (scene_ == nullptr) return;
  RTCPointQuery query{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]),
                      0.0F, radius};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_, &query, &context, nullptr, data);
}

void EmbreeScene::release() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  if (device_ != nullptr) rtcReleaseDevice(device_);
}

}  // namespace cellocut
