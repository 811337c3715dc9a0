#include "tools/comparison_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "cellocut/surface/interface.h"
#include "tools/html_parts.h"
#ifdef CELLOCUT_WITH_VIZ
#include "viz/section.h"
#endif

namespace cellocut::tools {

namespace {

constexpr std::size_t kScenes = 10;

std::string faces_note(const PackedMesh& mesh) {
  const std::string all = group_digits(static_cast<std::int64_t>(mesh.faces_before));
  if (mesh.triangles.size() == mesh.faces_before) return all + " faces";
  return group_digits(static_cast<std::int64_t>(mesh.triangles.size())) + " of " + all +
         " faces shown";
}

}  // namespace

ComparisonPage::ComparisonPage(std::size_t meshes) : meshes_(meshes) {}

void ComparisonPage::add_scene(const std::string& name, const std::string& backend,
                               const RemeshResult& result, const TriangleSoup& input) {
  if (content_.scenes.size() == kScenes) {
    content_.left_out.push_back(
        fmt::format("{}: not in the 3D view, which has {} meshes.", name, kScenes));
    return;
  }
  const std::size_t faces = kPageFaces / (2 * std::clamp<std::size_t>(meshes_, 1, kScenes));
  PageScene scene{name, {pack_mesh(input, faces)}};
  scene.views[0].title = "Input";
  scene.views[0].note = faces_note(scene.views[0]) + "; backs of faces are red";
  if (!result.label.empty()) {
    PackedMesh solid = pack_mesh(
        interface_triangles(result.complex, list_interface(result.complex, result.label)), faces);
    solid.title = "Output of the cut";
    solid.note =
        fmt::format("boundary of the interior cells on {}, before a surface is extracted; {}",
                    backend, faces_note(solid));
    scene.views.push_back(std::move(solid));
  }
  content_.scenes.push_back(std::move(scene));
}

#ifdef CELLOCUT_WITH_VIZ
void ComparisonPage::add_section(std::size_t instance, const viz::LabelledCells& cells,
                                 const TriangleSoup& input, const std::string& name) {
  constexpr std::size_t kDrawingBytes = 600'000;
  if (cells.find("label") == nullptr) return;
  viz::SectionLayers layers;
  layers.cells = &cells;
  layers.surfaces = {&input};
  layers.surface_names = {name};
  const viz::SectionStyle style{.width = 700, .cell_edges = false};
  const viz::Plane plane = viz::parse_plane("y=50%", bounding_box(cells.points));
  PagePicture picture{instance, "Section y = 50 %: labelled cells and the input", "image/svg+xml",
                      viz::draw_section(layers, plane, style, viz::PictureFormat::svg)};
  if (picture.bytes.size() > kDrawingBytes) {
    picture.media_type = "image/png";
    picture.bytes = viz::draw_section(layers, plane, style, viz::PictureFormat::png);
  }
  content_.pictures.push_back(std::move(picture));
}
#endif

PageContent ComparisonPage::take() {
#ifndef CELLOCUT_WITH_VIZ
  if (!content_.scenes.empty()) {
    content_.left_out.emplace_back("Without sections: built without VTK and cairo.");
  }
#endif
  return std::move(content_);
}

}  // namespace cellocut::tools
