// The first face that a ray meets.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cellocut/view/camera.h"

namespace cellocut {

// Embree's hierarchy of boxes finds the candidates, with room for its single precision; everything
// else is decided in doubles: every corner is projected along the ray once, and whether the ray
// passes through a face is an exact predicate on the projected corners (line_coverage.h). So there
// is no gap at edges or corners that faces share, where Embree's own triangles let a ray in some
// thousands through when it is aimed at a corner; and the order in which the hierarchy is built and
// searched decides nothing: the same bits for any number of threads.
//
// Faces without area are not there.
class RayScene {
 public:
  struct Hit {
    std::uint32_t face = 0;
    double distance = 0;  // along the ray, in lengths of its direction
    Point3 normal{};      // of unit length, in the mesh's axes, by the order of the face's corners
    bool front = true;    // whether the ray comes from the side that the normal points to
  };

  // A mesh in a frame. Preconditions: finite coordinates, fewer than 2^32 points and faces.
  // Errors: InputError where a coordinate is too far from the frame for single precision;
  // LimitError where memory is short. Parallel; O(n log n).
  RayScene(const TriangleSoup& mesh, const ViewFrame& frame);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  // The nearest face in front of the origin. Of faces at the same distance (to 1e-9) one whose
  // front is seen, and then the lowest. From any number of threads at once. O(log n) for surfaces.
  [[nodiscard]] std::optional<Hit> first_hit(const Ray& ray) const;
  // Whether any face lies between the origin and `distance` lengths of the direction.
  [[nodiscard]] bool is_blocked(const Ray& ray, double distance) const;
  // All of the mesh lies within this of the frame's centre.
  [[nodiscard]] double radius() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace cellocut
