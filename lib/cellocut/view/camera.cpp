#include "cellocut/view/camera.h"

#include <cmath>
#include <numbers>

#include "cellocut/base/errors.h"

namespace cellocut {

ViewFrame view_frame(const TriangleSoup& mesh) {
  if (mesh.empty()) throw InputError("no faces");
  const Box3 box = bounding_box(mesh);
  const ViewFrame frame{.centre = 0.5 * (box.low + box.high), .unit = box.longest_edge()};
  if (!(frame.unit > 0)) throw InputError("the mesh has no extent");
  if (!is_finite(frame.centre) || !std::isfinite(frame.unit)) {
    throw InputError("the coordinates are too large");
  }
  return frame;
}

Ray view_ray(const Camera& camera, double x, double y, double distance) {
  const double s = (2 * x - 1) * kHalfPicture;
  const double t = (1 - 2 * y) * kHalfPicture;
  const Point3 aside = s * camera.right + t * camera.up;
  if (camera.angle == 0) return {aside + distance * camera.back, -1.0 * camera.back};
  // The picture lies in the near face of the cube, `focal` in front of the eye.
  const double focal = kHalfPicture / std::tan(camera.angle / 360 * std::numbers::pi);
  return {(0.5 + focal) * camera.back, (1 / focal) * aside - camera.back};
}

std::array<Camera, 6> canonical_views(UpAxis up, double angle) {
  const Point3 vertical = up == UpAxis::y ? Point3{0, 1, 0} : Point3{0, 0, 1};
  // Towards the viewer of the front: what the view from above has below.
  const Point3 front = up == UpAxis::y ? Point3{0, 0, 1} : Point3{0, -1, 0};
  const std::array<const char*, 6> names{"posx", "negx", "posy", "negy", "posz", "negz"};
  std::array<Camera, 6> cameras;
  for (int k = 0; k < 6; ++k) {
    Camera& camera = cameras[k];
    camera.name = names[k];
    camera.angle = angle;
    camera.back = {0, 0, 0};
    camera.back[k / 2] = k % 2 == 0 ? 1 : -1;
    const double along = dot(camera.back, vertical);
    camera.up = along == 0 ? vertical : -along * front;
    camera.right = cross(camera.up, camera.back);
  }
  return cameras;
}

}  // namespace cellocut
