// Where a mesh is seen from: six canonical views, and the frame that makes them the same for every
// mesh.
#pragma once

#include <array>
#include <string>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// The mesh's coordinates, shifted and scaled as one: a point p lies at (p - centre) / unit. Two
// meshes in one frame are seen by the same camera.
struct ViewFrame {
  Point3 centre{};
  double unit = 1;  // input units

  [[nodiscard]] Point3 operator()(const Point3& p) const {
    return {(p[0] - centre[0]) / unit, (p[1] - centre[1]) / unit, (p[2] - centre[2]) / unit};
  }
};

// The centre and the longest edge of the bounding box: the mesh lies in [-1/2, 1/2]^3.
// Errors: InputError where there is no face, no extent, or a box too large for its size to be
// finite. O(n).
ViewFrame view_frame(const TriangleSoup& mesh);

// The axis of the mesh that points up in the pictures.
enum class UpAxis { y, z };

// A pinhole or orthographic camera in front of a frame, and its square picture.
struct Camera {
  std::string name;  // posx, negx, ...: the side of the mesh that it stands on
  // Orthonormal, right-handed: to the right and up in the picture, and back towards the viewer.
  Point3 right{1, 0, 0};
  Point3 up{0, 1, 0};
  Point3 back{0, 0, 1};
  double angle = 0;  // of view, in degrees, in either direction; 0: orthographic
};

// Half the edge of the picture, in the frame: a margin of 5 % of the longest edge on every side.
// Orthographic views are that wide everywhere, perspective ones at the near face of the frame's
// cube, so that all of the cube is seen.
constexpr double kHalfPicture = 0.55;

struct Ray {
  Point3 origin;
  Point3 direction;  // of any length; times it, a distance along the ray is one in the frame
};

// The ray through the picture's point (x, y), both from 0 to 1, from its left and upper edge. Of an
// orthographic camera it begins `distance` in front of the frame's centre; of a perspective one at
// the eye. Along either, distance grows by 1 for each step of the frame's unit along the view axis.
Ray view_ray(const Camera& camera, double x, double y, double distance);

// From +x, -x, +y, -y, +z, -z, in this order, towards the centre. Four have the up axis upwards.
// The two that look along it have x to the right; with y up, z points down in the view from above,
// with z up, y points up in it.
std::array<Camera, 6> canonical_views(UpAxis up, double angle);

}  // namespace cellocut
