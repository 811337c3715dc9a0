// cellocut scan: the visible outer surface of a mesh as points.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "cellocut/view/scan.h"
#include "cellocut_version.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/session.h"

namespace cellocut::tools {

namespace {

struct ScanArguments {
  CommonOptions common;
  ScanOptions options;
  std::string mesh;
  std::string format;
  std::string output;
};

nlohmann::ordered_json scan_json(const ScanArguments& a, const Scan& scan) {
  return {{"version", kCellocutVersion},
          {"input", {{"path", a.mesh}}},
          {"parameters",
           {{"viewpoints", a.options.viewpoints},
            {"rays", a.options.rays},
            {"points", a.options.points},
            {"spacing", a.options.spacing},
            {"seed", a.options.seed}}},
          {"rays", scan.rays},
          {"hits", scan.hits},
          {"grazing_hits", scan.grazing},
          {"unit", scan.unit},
          {"output",
           {{"path", a.output}, {"points", scan.cloud.points.size()}, {"spacing", scan.spacing}}}};
}

int run_scan(const ScanArguments& a) {
  a.options.validate();
  if (a.output != "-" && format_of_path(a.output) != MeshFormat::ply) {
    throw UsageError(a.output + ": points are written as .ply");
  }
  require_writable({a.output, a.common.json}, {a.mesh});
  const ThreadLimit limit(a.common.threads);
  TerminalObserver observer(a.common);
  observer.stage("read");
  const TriangleSoup mesh = read_input(a.mesh, a.format);
  const Scan scan = scan_outside(mesh, a.options, observer);
  observer.clear();
  write_text(a.output, encode_point_cloud(scan.cloud));
  if (!a.common.json.empty()) write_text(a.common.json, scan_json(a, scan).dump(2) + "\n");
  if (!a.common.quiet && a.output != "-" && a.common.json != "-") {
    fmt::print("{} points, {} of the longest edge apart, from {} hits of {} rays\n",
               scan.cloud.points.size(), fmt::format("{:.3g}", scan.spacing), scan.hits, scan.rays);
  }
  return kDone;
}

}  // namespace

Command add_scan(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "scan",
      "Virtual scan: rays from viewpoints evenly around the mesh, their first hits with normals "
      "that face the viewer, thinned evenly: the visible outer surface as a point cloud");
  auto arguments = std::make_shared<ScanArguments>();
  ScanArguments& a = *arguments;
  app->add_option("mesh", a.mesh, "Mesh: .obj .off .ply .stl, or '-'")->required();
  app->add_option("--format", a.format, "Format of the mesh: obj, off, ply, stl");
  app->add_option("-o,--output", a.output, "Points with normals: .ply (binary), or '-'")
      ->required();
  app->add_option("--viewpoints", a.options.viewpoints,
                  "Evenly on a sphere of three times the mesh's radius, 1 to 10^5")
      ->capture_default_str();
  app->add_option("--rays", a.options.rays, "From each viewpoint, 1 to 10^7")
      ->capture_default_str();
  CLI::Option* points =
      app->add_option("--points", a.options.points, "Keep at most so many, evenly spread")
          ->capture_default_str();
  app->add_option("--spacing", a.options.spacing,
                  "Instead: keep all that are no closer to each other, relative to the longest "
                  "edge of the mesh's box, 1e-5 to 1")
      ->excludes(points);
  app->add_option("--seed", a.options.seed, "Of the turn of each viewpoint and of the thinning")
      ->capture_default_str();
  a.common.add_to(*app);
  return {app, [arguments] { return run_scan(*arguments); },
          [arguments] { return arguments->mesh; }};
}

}  // namespace cellocut::tools
