// Pictures of a mesh: clay, depth and normals, by ray casting; no display is needed.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/view/ray_scene.h"

namespace cellocut {

struct RenderOptions {
  int resolution = 512;    // pixels of either edge; 16 to 4096
  double perspective = 0;  // angle of view in degrees, 1 to 120; 0: orthographic
  UpAxis up = UpAxis::y;
  int antialiasing = 3;  // squared: samples of the clay picture in a pixel, on a grid; 1 to 8

  // Errors: UsageError that names the option and what it may be.
  void validate() const;
};

// A square picture, row by row from above, each from the left. Clay is the mean over a pixel's
// samples; depth and normal are those at its middle, so that no two surfaces mix.
struct View {
  static constexpr float kNothing = std::numeric_limits<float>::infinity();

  std::string name;  // of the camera
  int resolution = 0;
  std::vector<std::array<std::uint8_t, 3>> clay;  // sRGB, on white
  // Along the view axis, in the frame's unit, 0 at the frame's centre, growing away from the
  // viewer; kNothing where no face is seen.
  std::vector<float> depth;
  // In the camera's axes: right, up, towards the viewer; of unit length, and turned to the side
  // that is seen, whatever the order of the face's corners. Zero where no face is seen.
  std::vector<std::array<float, 3>> normals;

  [[nodiscard]] std::size_t size() const { return depth.size(); }
  [[nodiscard]] bool covers(std::size_t pixel) const { return depth[pixel] != kNothing; }
};

// The same bits for any number of threads. Errors: Cancelled. Parallel;
// O(resolution^2 antialiasing^2 log n).
View render_view(const RayScene& scene, const Camera& camera, const RenderOptions& options,
                 const Observer& observer = silent_observer());

// render_view() from each of canonical_views(). Errors: as RayScene; UsageError by
// options.validate(); Cancelled.
std::vector<View> render_views(const TriangleSoup& mesh, const ViewFrame& frame,
                               const RenderOptions& options,
                               const Observer& observer = silent_observer());

}  // namespace cellocut
