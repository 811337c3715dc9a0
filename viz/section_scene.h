// What a picture of a section shows, in coordinates of the plane: the layers, cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "viz/plane_section.h"
#include "viz/section.h"
#include "viz/section_colours.h"

namespace cellocut::viz {

// The smallest rectangle that holds what was added.
struct Extent {
  Point2 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point2 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  // Of no or of one point: nothing to draw. (A plane that touches a corner.)
  [[nodiscard]] bool empty() const { return !(longest() > 0); }
  void add(const std::vector<Point2>& points) {
    for (const Point2& p : points) {
      for (int k = 0; k < 2; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    }
  }
  [[nodiscard]] double edge(int k) const { return high[k] - low[k]; }
  [[nodiscard]] double longest() const { return std::max(edge(0), edge(1)); }
};

struct CellLayer {
  CellSection section;
  std::vector<std::int32_t> values;  // of the cells that are cut
  std::vector<Category> categories;
};

struct SurfaceLayer {
  SurfaceSection section;
  std::string name;
  std::size_t index = 0;
};

struct Scene {
  CellLayer cells;
  std::vector<SurfaceLayer> surfaces;
  Extent extent;
};

// Cuts all layers. Errors: as draw_section, but a plane that misses makes an empty scene.
Scene make_scene(const SectionLayers& layers, const Plane& plane);

// The error for a plane that misses everything, with the offsets that would hit, as nobody sees
// them in an empty picture.
[[noreturn]] void fail_missed(const SectionLayers& layers, const Plane& plane);

// "z = 0.5   (x right, y up)", or "x + y - 0.7 z = 0.7".
std::string plane_equation(const Plane& plane);

}  // namespace cellocut::viz
