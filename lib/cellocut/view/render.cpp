#include "cellocut/view/render.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "cellocut/base/errors.h"
#include "cellocut/view/clay.h"

namespace cellocut {

void RenderOptions::validate() const {
  if (resolution < 16 || resolution > 4096) {
    throw UsageError("the resolution of pictures must be 16 to 4096");
  }
  if (perspective != 0 && !(perspective >= 1 && perspective <= 120)) {
    throw UsageError("perspective must be an angle of 1 to 120 degrees, or 0");
  }
  if (antialiasing < 1 || antialiasing > 8) throw UsageError("antialiasing must be 1 to 8");
}

namespace {

struct Renderer {
  const RayScene& scene;
  const Camera& camera;
  const RenderOptions& options;
  View& view;

  [[nodiscard]] Ray ray(double column, double row) const {
    return view_ray(camera, column / options.resolution, row / options.resolution,
                    scene.radius() + 1);
  }

  void sample_middle(int column, int row, std::size_t pixel) const {
    const Ray middle = ray(column + 0.5, row + 0.5);
    const auto hit = scene.first_hit(middle);
    if (!hit) return;
    const Point3 p = middle.origin + hit->distance * middle.direction;
    view.depth[pixel] = static_cast<float>(-dot(p, camera.back));
    const Point3 normal = hit->front ? hit->normal : -1.0 * hit->normal;
    view.normals[pixel] = {static_cast<float>(dot(normal, camera.right)),
                           static_cast<float>(dot(normal, camera.up)),
                           static_cast<float>(dot(normal, camera.back))};
  }

  [[nodiscard]] LinearColour sample_clay(int column, int row) const {
    const int across = options.antialiasing;
    LinearColour sum{};
    for (int k = 0; k < across * across; ++k) {
      const int right = k % across;
      const int down = k / across;
      const Ray r = ray(column + (right + 0.5) / across, row + (down + 0.5) / across);
      const auto hit = scene.first_hit(r);
      const LinearColour colour =
          hit ? clay_colour(scene, camera, r, *hit, k, across * across) : kBackgroundColour;
      for (int c = 0; c < 3; ++c) sum[c] += colour[c];
    }
    for (double& channel : sum) channel /= across * across;
    return sum;
  }
};

}  // namespace

View render_view(const RayScene& scene, const Camera& camera, const RenderOptions& options,
                 const Observer& observer) {
  View view{.name = camera.name,
            .resolution = options.resolution,
            .clay = {},
            .depth = {},
            .normals = {}};
  const auto pixels = static_cast<std::size_t>(options.resolution) * options.resolution;
  view.clay.resize(pixels);
  view.depth.resize(pixels, View::kNothing);
  view.normals.resize(pixels);
  const Renderer renderer{scene, camera, options, view};
  tbb::parallel_for(0, options.resolution, [&](int row) {
    observer.check();
    for (int column = 0; column < options.resolution; ++column) {
      const std::size_t pixel = static_cast<std::size_t>(row) * options.resolution + column;
      renderer.sample_middle(column, row, pixel);
      view.clay[pixel] = to_srgb(renderer.sample_clay(column, row));
    }
  });
  return view;
}

std::vector<View> render_views(const TriangleSoup& mesh, const ViewFrame& frame,
                               const RenderOptions& options, const Observer& observer) {
  options.validate();
  const RayScene scene(mesh, frame);
  std::vector<View> views;
  views.reserve(6);
  for (const Camera& camera : canonical_views(options.up, options.perspective)) {
    views.push_back(render_view(scene, camera, options, observer));
  }
  return views;
}

}  // namespace cellocut
