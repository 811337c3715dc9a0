// cellocut check: is a mesh the boundary of a solid, and if not, why not.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cellocut/validity/surface_report.h"
#include "cellocut_version.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/report_json.h"
#include "tools/session.h"

namespace cellocut::tools {

namespace {

struct CheckArguments {
  CommonOptions common;
  std::string input;
  std::string format;
};

void print_report(const SurfaceReport& report) {
  const auto row = [](const char* name, std::int64_t by_index, std::int64_t by_position) {
    fmt::print("{:<24} {:>12} {:>12}\n", name, by_index, by_position);
  };
  fmt::print("{:<24} {:>12}\n", "triangles", report.triangles);
  fmt::print("{:<24} {:>12}\n", "points", report.points);
  fmt::print("{:<24} {:>12} {:>12}\n", "", "by index", "by position");
  const IncidenceCounts& index = report.by_index;
  const IncidenceCounts& position = report.by_position;
  row("boundary edges", index.boundary_edges, position.boundary_edges);
  row("non-manifold edges", index.nonmanifold_edges, position.nonmanifold_edges);
  row("non-manifold vertices", index.nonmanifold_vertices, position.nonmanifold_vertices);
  row("misoriented edges", index.misoriented_edges, position.misoriented_edges);
  row("duplicate faces", index.duplicate_faces, position.duplicate_faces);
  fmt::print("{:<24} {:>12}\n", "degenerate faces", report.degenerate_faces);
  fmt::print("{:<24} {:>12}\n", "points not finite", report.nonfinite_points);
  fmt::print("{:<24} {:>12}\n", "intersecting pairs", report.intersecting_pairs);
  fmt::print("{:<24} {:>12}\n", "touching edges", report.touching_edges);
  fmt::print("{:<24} {:>12}\n", "touching vertices", report.touching_vertices);
  fmt::print("{:<24} {:>12}\n", "components", report.components.size());
  fmt::print("{:<24} {:>12}\n", "Euler number", report.euler);
  fmt::print("{:<24} {:>12.6g}\n", "volume", report.volume);
  fmt::print("{:<24} {:>12.6g}\n", "area", report.area);
  fmt::print("{}\n", report.valid() ? "valid: closed, oriented, manifold, embedded" : "not valid");
}

void warn_of_what_is_missing(const CheckArguments& a, const TriangleSoup& mesh,
                             const SurfaceReport& report) {
  if (mesh.skipped_polygons > 0) {
    print_error(fmt::format("{}: warning: left out {} faces of fewer than three corners", a.input,
                            mesh.skipped_polygons));
  }
  if (!std::isfinite(report.volume) || !std::isfinite(report.area)) {
    print_error(fmt::format("{}: warning: volume or area is beyond the range of numbers", a.input));
  }
}

int run_check(const CheckArguments& a) {
  require_writable({a.common.json}, {a.input});
  const ThreadLimit limit(a.common.threads);
  TerminalObserver observer(a.common);
  observer.stage("read");
  const TriangleSoup mesh = read_input(a.input, a.format);
  observer.stage("validity");
  const SurfaceReport report = inspect_surface(mesh, SurfaceCheckOptions{.observer = &observer});
  observer.clear();
  if (!a.common.quiet) warn_of_what_is_missing(a, mesh, report);
  if (!a.common.json.empty()) {
    const nlohmann::ordered_json json{{"version", kCellocutVersion},
                                      {"output", output_json(report, a.input)}};
    write_text(a.common.json, json.dump(2) + "\n");
  }
  if (!a.common.quiet && a.common.json != "-") print_report(report);
  return report.valid() ? kDone : kNoGuarantee;
}

}  // namespace

Command add_check(CLI::App& program) {
  CLI::App* app = program.add_subcommand("check",
                                         "Topology, orientation, self-intersection, components, "
                                         "Euler number, volume. Exit 0 where the "
                                         "mesh bounds a solid, 4 where it does not");
  auto arguments = std::make_shared<CheckArguments>();
  app->add_option("mesh", arguments->input, "Mesh: .obj .off .ply .stl, or '-'")->required();
  app->add_option("--format", arguments->format, "Format of the mesh: obj, off, ply, stl");
  arguments->common.add_to(*app);
  return {app, [arguments] { return run_check(*arguments); },
          [arguments] { return arguments->input; }};
}

}  // namespace cellocut::tools
