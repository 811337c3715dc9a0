// cellocut section: a plane through labelled cells and surfaces, as PNG or SVG.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cellocut_version.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/session.h"
#include "viz/section.h"
#include "viz/vtu_file.h"

namespace cellocut::tools {

namespace {

struct SectionArguments {
  CommonOptions common;
  std::vector<std::string> inputs;
  std::vector<std::string> outputs;
  std::string plane = "y=50%";
  std::string colour_by = "label";
  viz::SectionStyle style;
  bool no_cell_edges = false;
};

bool ends_with(const std::string& text, const std::string& ending) {
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower.size() >= ending.size() &&
         lower.compare(lower.size() - ending.size(), ending.size(), ending) == 0;
}

viz::PictureFormat picture_format(const std::string& path) {
  if (ends_with(path, ".png")) return viz::PictureFormat::png;
  if (ends_with(path, ".svg")) return viz::PictureFormat::svg;
  throw UsageError(path + ": a section is written as .png or .svg");
}

void extend(Box3& box, const Point3& p, bool first) {
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = first ? p[axis] : std::min(box.low[axis], p[axis]);
    box.high[axis] = first ? p[axis] : std::max(box.high[axis], p[axis]);
  }
}

int run_section(const SectionArguments& a) {
  for (const std::string& path : a.outputs) picture_format(path);
  require_writable(a.outputs);
  require_writable({a.common.json});
  const ThreadLimit limit(a.common.threads);
  viz::LabelledCells cells;
  std::vector<TriangleSoup> meshes;
  std::vector<std::string> names;
  for (const std::string& path : a.inputs) {
    if (ends_with(path, ".vtu")) {
      if (!cells.cells.empty()) throw UsageError("only one .vtu can be drawn");
      cells = viz::read_vtu(path);
    } else {
      meshes.push_back(read_input(path));
      names.push_back(path.substr(path.find_last_of('/') + 1));
    }
  }
  Box3 box;
  bool first = true;
  const auto extend_all = [&](const std::vector<Point3>& points) {
    for (const Point3& p : points) {
      extend(box, p, first);
      first = false;
    }
  };
  extend_all(cells.points);
  for (const TriangleSoup& mesh : meshes) extend_all(mesh.points);

  viz::SectionLayers layers;
  if (!cells.cells.empty()) layers.cells = &cells;
  layers.colour_by = a.colour_by;
  for (const TriangleSoup& mesh : meshes) layers.surfaces.push_back(&mesh);
  layers.surface_names = names;
  viz::SectionStyle style = a.style;
  style.cell_edges = !a.no_cell_edges;
  const viz::Plane plane = viz::parse_plane(a.plane, box);
  for (const std::string& path : a.outputs) {
    write_text(path, viz::draw_section(layers, plane, style, picture_format(path)));
  }
  if (!a.common.json.empty()) {
    const nlohmann::ordered_json report{
        {"version", kCellocutVersion},
        {"inputs", a.inputs},
        {"plane", {{"normal", plane.normal}, {"offset", plane.offset}}},
        {"outputs", a.outputs}};
    write_text(a.common.json, report.dump(2) + "\n");
  }
  return kDone;
}

}  // namespace

Command add_section(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "section", "A plane through labelled cells (.vtu) and surfaces, drawn to PNG or SVG");
  auto a = std::make_shared<SectionArguments>();
  app->add_option("inputs", a->inputs, "One .vtu and any number of meshes")->required();
  app->add_option("-o,--output", a->outputs, "Pictures: .png .svg")->required();
  app->add_option("--plane", a->plane,
                  "x=0.5 (input units), y=50% (of the box's edge), or nx,ny,nz,offset")
      ->capture_default_str();
  app->add_option("--colour-by", a->colour_by, "Cell array that colours the cells")
      ->capture_default_str();
  app->add_option("--width", a->style.width, "Pixels of the longer edge")->capture_default_str();
  app->add_flag("--no-cell-edges", a->no_cell_edges, "No lines between cells");
  a->common.add_to(*app);
  return {app, [a] { return run_section(*a); },
          [a] { return a->inputs.empty() ? std::string() : a->inputs.front(); }};
}

}  // namespace cellocut::tools
