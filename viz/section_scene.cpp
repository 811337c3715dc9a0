#include "viz/section_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "cellocut/base/errors.h"

namespace cellocut::viz {

namespace {

std::string names_of_arrays(const LabelledCells& cells) {
  std::string names;
  for (const CellArray& array : cells.arrays) names += (names.empty() ? "" : ", ") + array.name;
  return names.empty() ? "none" : names;
}

// Borders of bands that hold about as many values each; values that are not finite have no say.
template <class Value>
std::vector<double> band_borders(const std::vector<Value>& values) {
  constexpr std::size_t kBands = 8;
  std::vector<double> sorted;
  sorted.reserve(values.size());
  for (const Value value : values) {
    if (std::isfinite(value)) sorted.push_back(static_cast<double>(value));
  }
  if (sorted.empty()) return {0, 0};
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> borders;
  for (std::size_t i = 0; i <= kBands; ++i) {
    borders.push_back(sorted[i * (sorted.size() - 1) / kBands]);
  }
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
  if (borders.size() < kBands / 2) {  // few values, most of them the same: bands of one width
    const double low = sorted.front();
    const double high = sorted.back();
    borders.clear();
    for (std::size_t i = 0; i <= kBands; ++i) {
      borders.push_back(low + (high - low) * static_cast<double>(i) / kBands);
    }
  }
  if (borders.front() < 0 && borders.back() > 0) borders.push_back(0);
  std::sort(borders.begin(), borders.end());
  borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
  if (borders.size() == 1) borders.push_back(borders.front());
  return borders;
}

// Values and categories of the cells that are cut.
template <class Value>
void colour_cells(const std::vector<Value>& values, const std::string& name, CellLayer& layer) {
  layer.values.reserve(layer.section.cells.size());
  if constexpr (std::is_floating_point_v<Value>) {
    const std::vector<double> borders = band_borders(values);
    layer.categories = bands_of(borders);
    const auto last = static_cast<std::int32_t>(layer.categories.size()) - 1;
    for (const std::uint32_t c : layer.section.cells) {
      const auto above = std::upper_bound(borders.begin(), borders.end(), values[c]);
      const auto band = static_cast<std::int32_t>(above - borders.begin()) - 1;
      layer.values.push_back(std::clamp(band, 0, last));
    }
  } else {
    for (const std::uint32_t c : layer.section.cells) layer.values.push_back(values[c]);
    std::vector<std::int32_t> present = layer.values;
    std::sort(present.begin(), present.end());
    present.erase(std::unique(present.begin(), present.end()), present.end());
    layer.categories = categories_of(name, present);
  }
}

void colour_cells(const LabelledCells& cells, const std::string& name, CellLayer& layer) {
  const CellArray* array = cells.find(name);
  if (array == nullptr) {
    throw InputError("there is no cell array '" + name + "'; there are: " + names_of_arrays(cells));
  }
  std::visit(
      [&](const auto& values) {
        if (values.size() != cells.cells.size()) {
          throw InputError(fmt::format("cell array '{}' holds {} values for {} cells", name,
                                       values.size(), cells.cells.size()));
        }
        colour_cells(values, name, layer);
      },
      array->values);
}

}  // namespace

void fail_missed(const SectionLayers& layers, const Plane& plane) {
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
    colour_cells(*layers.cells, layers.colour_by, layer);
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
  return scene;
}

}  // namespace cellocut::viz
