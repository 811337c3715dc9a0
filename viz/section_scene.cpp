#include "viz/section_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "cellocut/base/errors.h"

namespace cellocut::viz {

namespace {

std::string names_of_categorical_arrays(const LabelledCells& cells) {
  std::string names;
  for (const CellArray& array : cells.arrays) {
    if (std::holds_alternative<std::vector<float>>(array.values)) continue;
    if (std::holds_alternative<std::vector<double>>(array.values)) continue;
    names += (names.empty() ? "" : ", ") + array.name;
  }
  return names.empty() ? "none" : names;
}

std::vector<std::int32_t> values_of_cells(const LabelledCells& cells, const std::string& name,
                                          const std::vector<std::uint32_t>& which) {
  const std::string there = "; arrays of categories: " + names_of_categorical_arrays(cells);
  const CellArray* array = cells.find(name);
  if (array == nullptr) throw InputError("there is no cell array '" + name + "'" + there);
  return std::visit(
      [&](const auto& values) -> std::vector<std::int32_t> {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        if constexpr (std::is_floating_point_v<Value>) {
          throw InputError("cell array '" + name + "' holds measures, not categories" + there);
        } else {
          if (values.size() != cells.cells.size()) {
            throw InputError(fmt::format("cell array '{}' holds {} values for {} cells", name,
                                         values.size(), cells.cells.size()));
          }
          std::vector<std::int32_t> result;
          result.reserve(which.size());
          for (const std::uint32_t c : which) result.push_back(values[c]);
          return result;
        }
      },
      array->values);
}

// Says where a plane would hit, as the caller cannot see it in an empty picture.
[[noreturn]] void fail_missed(const SectionLayers& layers, const Plane& plane) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  const auto add = [&](const Point3& p) {
    low = std::min(low, dot(plane.normal, p));
    high = std::max(high, dot(plane.normal, p));
  };
  if (layers.cells != nullptr) {
    for (const auto& cell : layers.cells->cells) {
      for (const std::uint32_t v : cell) add(layers.cells->points[v]);
    }
  }
  for (const TriangleSoup* surface : layers.surfaces) {
    for (const Triangle& t : surface->triangles) {
      for (const std::uint32_t v : t) add(surface->points[v]);
    }
  }
  if (low > high) throw InputError("there is nothing to cut");
  throw InputError(
      fmt::format("the plane with offset {:.6g} misses everything: the offsets that hit "
                  "lie between {:.6g} and {:.6g}",
                  plane.offset, low, high));
}

}  // namespace

std::string plane_equation(const Plane& plane) {
  constexpr char kAxes[] = "xyz";
  int axis = -1;
  int terms = 0;
  std::string text;
  for (int k = 0; k < 3; ++k) {
    const double n = plane.normal[k];
    if (n == 0) continue;
    axis = k;
    if (n < 0) text += terms > 0 ? " - " : "-";
    if (n > 0 && terms > 0) text += " + ";
    if (std::abs(n) != 1) text += fmt::format("{:.4g} ", std::abs(n));
    text += kAxes[k];
    ++terms;
  }
  if (terms > 1) return fmt::format("{} = {:.4g}", text, plane.offset);
  constexpr const char* kDirections[] = {"y right, z up", "x right, z up", "x right, y up"};
  return fmt::format("{} = {:.6g}   ({})", kAxes[axis], plane.offset / plane.normal[axis],
                     kDirections[axis]);
}

Scene make_scene(const SectionLayers& layers, const Plane& plane) {
  Scene scene;
  if (layers.cells != nullptr) {
    CellLayer& layer = scene.cells;
    layer.section = section_of_cells(layers.cells->points, layers.cells->cells, plane);
    layer.values = values_of_cells(*layers.cells, layers.colour_by, layer.section.cells);
    std::vector<std::int32_t> present = layer.values;
    std::sort(present.begin(), present.end());
    present.erase(std::unique(present.begin(), present.end()), present.end());
    layer.categories = categories_of(layers.colour_by, present);
    scene.extent.add(layer.section.nodes);
  }
  for (std::size_t i = 0; i < layers.surfaces.size(); ++i) {
    SurfaceLayer layer;
    layer.section = section_of_surface(*layers.surfaces[i], plane);
    layer.name = i < layers.surface_names.size() ? layers.surface_names[i]
                                                 : fmt::format("surface {}", i + 1);
    layer.index = i;
    if (layer.section.segments.empty()) continue;
    scene.extent.add(layer.section.nodes);
    scene.surfaces.push_back(std::move(layer));
  }
  // An extent of zero: the plane touches a corner.
  if (!(scene.extent.longest() > 0)) fail_missed(layers, plane);
  return scene;
}

}  // namespace cellocut::viz
