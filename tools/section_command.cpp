// cellocut section: a plane through labelled cells and surfaces, as PNG or SVG.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
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
  std::vector<std::string> planes{"y=50%"};
  int series = 1;
  int columns = 0;
  bool apart = false;
  std::string colour_by = "label";
  viz::SectionStyle style;
  bool no_cell_edges = false;
};

// What is drawn in one panel of each plane: labelled cells and surfaces, or either.
struct Run {
  std::string name;
  viz::LabelledCells cells;
  std::vector<std::size_t> meshes;
};

struct Inputs {
  std::vector<Run> runs;
  std::vector<TriangleSoup> meshes;
  std::vector<std::string> names;  // of the meshes
};

viz::PictureFormat picture_format(const std::string& path) {
  if (has_ending(path, ".png")) return viz::PictureFormat::png;
  if (has_ending(path, ".svg")) return viz::PictureFormat::svg;
  throw UsageError(path + ": a section is written as .png or .svg");
}

std::string file_name(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

// Each .vtu begins a run, which the meshes after it belong to; those before the first belong to
// all. Apart: every input is a run of its own.
Inputs read_inputs(const SectionArguments& a) {
  Inputs inputs;
  std::vector<std::size_t> of_all;
  for (const std::string& path : a.inputs) {
    if (has_ending(path, ".vtu")) {
      inputs.runs.push_back({file_name(path), viz::read_vtu(path), of_all});
      continue;
    }
    const std::size_t mesh = inputs.meshes.size();
    inputs.meshes.push_back(read_input(path));
    inputs.names.push_back(file_name(path));
    if (a.apart) {
      inputs.runs.push_back({inputs.names.back(), {}, {mesh}});
    } else if (inputs.runs.empty()) {
      of_all.push_back(mesh);
    } else {
      inputs.runs.back().meshes.push_back(mesh);
    }
  }
  if (inputs.runs.empty()) inputs.runs.push_back({"", {}, of_all});
  return inputs;
}

Box3 box_of(const Inputs& inputs) {
  Box3 box;
  bool first = true;
  const auto extend_all = [&](const std::vector<Point3>& points) {
    for (const Point3& p : points) {
      if (first) box = {p, p};
      first = false;
      box.include(p);
    }
  };
  for (const Run& run : inputs.runs) extend_all(run.cells.points);
  for (const TriangleSoup& mesh : inputs.meshes) extend_all(mesh.points);
  return box;
}

// As many planes of its normal, evenly over the box, none at its borders.
void add_series(const viz::Plane& plane, const Box3& box, int count,
                std::vector<viz::Plane>& planes) {
  double low = 0;
  double high = 0;
  for (int k = 0; k < 3; ++k) {
    const double a = plane.normal[k] * box.low[k];
    const double b = plane.normal[k] * box.high[k];
    low += std::min(a, b);
    high += std::max(a, b);
  }
  for (int i = 0; i < count; ++i) {
    planes.push_back({plane.normal, low + (high - low) * (i + 0.5) / count});
  }
}

std::vector<viz::Plane> list_planes(const SectionArguments& a, const Box3& box) {
  std::vector<viz::Plane> planes;
  for (const std::string& text : a.planes) {
    const viz::Plane plane = viz::parse_plane(text, box);
    if (a.series == 1) {
      planes.push_back(plane);
    } else {
      add_series(plane, box, a.series, planes);
    }
  }
  return planes;
}

int run_section(const SectionArguments& a) {
  for (const std::string& path : a.outputs) picture_format(path);
  std::vector<std::string> outputs = a.outputs;
  outputs.push_back(a.common.json);
  require_writable(outputs, a.inputs);
  const ThreadLimit limit(a.common.threads);
  const Inputs inputs = read_inputs(a);
  const std::vector<viz::Plane> planes = list_planes(a, box_of(inputs));

  // One row for each plane, one column for each run; of a single run as near to a square as it
  // goes.
  std::vector<viz::SectionPanel> panels;
  for (const viz::Plane& plane : planes) {
    for (const Run& run : inputs.runs) {
      viz::SectionPanel panel{{}, plane, inputs.runs.size() > 1 ? run.name : ""};
      if (!run.cells.cells.empty()) panel.layers.cells = &run.cells;
      panel.layers.colour_by = a.colour_by;
      for (const std::size_t mesh : run.meshes) {
        panel.layers.surfaces.push_back(&inputs.meshes[mesh]);
        panel.layers.surface_names.push_back(inputs.names[mesh]);
      }
      panels.push_back(std::move(panel));
    }
  }
  int columns = a.columns;
  if (columns == 0 && inputs.runs.size() > 1) columns = static_cast<int>(inputs.runs.size());
  if (columns == 0) {
    columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(planes.size()))));
  }
  viz::SectionStyle style = a.style;
  style.cell_edges = !a.no_cell_edges;
  for (const std::string& path : a.outputs) {
    write_text(path, viz::draw_sections(panels, columns, style, picture_format(path)));
  }
  if (!a.common.json.empty()) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const viz::Plane& plane : planes) {
      list.push_back({{"normal", plane.normal}, {"offset", plane.offset}});
    }
    const nlohmann::ordered_json report{{"version", kCellocutVersion},
                                        {"inputs", a.inputs},
                                        {"planes", list},
                                        {"columns", columns},
                                        {"outputs", a.outputs}};
    write_text(a.common.json, report.dump(2) + "\n");
  }
  return kDone;
}

}  // namespace

Command add_section(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "section", "Planes through labelled cells (.vtu) and surfaces, drawn to PNG or SVG");
  auto a = std::make_shared<SectionArguments>();
  app->add_option(
         "inputs", a->inputs,
         "Labelled cells (.vtu) and meshes. Several .vtu are drawn side by side, each with "
         "the meshes after it; meshes before the first are drawn over all")
      ->required();
  app->add_option("-o,--output", a->outputs, "Pictures: .png .svg")->required();
  app->add_option("--plane", a->planes,
                  "x=0.5 (input units), y=50% (of the box's edge), or nx,ny,nz,offset; may be "
                  "repeated")
      ->allow_extra_args(false)
      ->capture_default_str();
  app->add_option("--series", a->series,
                  "In place of each plane so many of its normal, evenly over the box")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app->add_option("--columns", a->columns,
                  "Panels in a row (default: one for each run, or as many as rows)")
      ->check(CLI::Range(0, 1000));
  app->add_flag("--apart", a->apart, "Every input in a panel of its own");
  app->add_option("--colour-by", a->colour_by,
                  "Cell array that colours the cells, of categories or measures")
      ->capture_default_str();
  app->add_option("--width", a->style.width, "Pixels of the longer edge")->capture_default_str();
  app->add_flag("--no-cell-edges", a->no_cell_edges, "No lines between cells");
  a->common.add_to(*app);
  return {app, [a] { return run_section(*a); },
          [a] { return a->inputs.empty() ? std::string() : a->inputs.front(); }};
}

}  // namespace cellocut::tools
