// cellocut evaluate: how close meshes are to a reference.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <variant>

#include "cellocut/base/errors.h"
#include "cellocut/mesh/point_cloud.h"
#include "cellocut/validity/position_merge.h"
#include "tools/commands.h"
#include "tools/evaluation_report.h"
#include "tools/exit_code.h"
#include "tools/session.h"

namespace cellocut::tools {

namespace {

struct EvaluateArguments {
  CommonOptions common;
  std::vector<std::string> meshes;
  std::string format;
  std::string reference;
  EvaluationOptions options;
  bool no_counts = false;
};

// Gives errors that know no file the one that the work is about.
template <class Work>
auto about(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(error.what(), error.file().empty() ? path : error.file());
  }
}

std::variant<TriangleSoup, PointCloud> read_reference(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) throw InputError("is a directory", path);
  if (path == "-") throw UsageError("--reference must be a file");
  return read_mesh_or_cloud(path);
}

// The pieces that are left when points with equal coordinates are one.
std::int64_t components_by_position(const TriangleSoup& mesh) {
  TriangleSoup merged = mesh;
  const std::vector<std::uint32_t> first = merge_equal_positions(mesh.points);
  for (Triangle& t : merged.triangles) {
    for (std::uint32_t& corner : t) corner = first[corner];
  }
  const SurfaceReport report = inspect_surface(merged, SurfaceCheckOptions{.intersections = false});
  return static_cast<std::int64_t>(report.components.size());
}

EvaluatedReference describe(const std::string& path,
                            const std::variant<TriangleSoup, PointCloud>& reference, double unit) {
  EvaluatedReference result{.path = path, .unit = unit, .surface = {}};
  if (const auto* cloud = std::get_if<PointCloud>(&reference)) {
    result.points = cloud->points.size();
    result.normals = !cloud->normals.empty();
  } else {
    const auto& soup = std::get<TriangleSoup>(reference);
    result.points = soup.points.size();
    result.surface = inspect_surface(soup, SurfaceCheckOptions{.intersections = false});
  }
  return result;
}

EvaluatedMesh evaluate_mesh(const std::string& path, const EvaluateArguments& a,
                            const Evaluator& evaluator, TerminalObserver& observer) {
  observer.stage(path);
  const TriangleSoup mesh = read_input(path, a.format);
  EvaluatedMesh result{.path = path, .evaluation = {}, .surface = {}};
  result.evaluation = evaluator(mesh, observer);
  result.surface = inspect_surface(
      mesh, SurfaceCheckOptions{.intersections = !a.no_counts, .observer = &observer});
  result.components_by_position = components_by_position(mesh);
  return result;
}

int run_evaluate(const EvaluateArguments& a) {
  a.options.validate();
  require_writable({a.common.json});
  const ThreadLimit limit(a.common.threads);
  TerminalObserver observer(a.common);
  observer.stage("reference");
  const auto reference = read_reference(a.reference);
  const Evaluator evaluator = about(a.reference, [&] {
    return std::visit([&](const auto& shape) { return Evaluator(shape, a.options); }, reference);
  });
  EvaluationReport report{.options = a.options,
                          .reference = describe(a.reference, reference, evaluator.unit()),
                          .meshes = {},
                          .counts = !a.no_counts};
  for (const std::string& path : a.meshes) {
    report.meshes.push_back(
        about(path, [&] { return evaluate_mesh(path, a, evaluator, observer); }));
  }
  observer.clear();
  if (!a.common.json.empty()) write_text(a.common.json, evaluation_json(report).dump(2) + "\n");
  if (!a.common.quiet && a.common.json != "-") fmt::print("{}", evaluation_tables(report));
  return kDone;
}

}  // namespace

Command add_evaluate(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "evaluate",
      "Chamfer and Hausdorff distance, normal consistency and F1 of meshes against a reference, "
      "between random samples and from samples to the surface. Lengths are relative to the longest "
      "edge of the reference's bounding box");
  auto arguments = std::make_shared<EvaluateArguments>();
  EvaluateArguments& a = *arguments;
  app->add_option("meshes", a.meshes, "Meshes: .obj .off .ply .stl, or '-'")->required();
  app->add_option("--format", a.format, "Format of the meshes: obj, off, ply, stl");
  app->add_option("--reference", a.reference,
                  "Mesh, or points: a .ply without faces, with or without normals nx ny nz")
      ->required();
  app->add_option(
         "--samples", a.options.samples,
         "Random points on each mesh, uniform by area, 1 to 10^8 (a reference of points is "
         "taken as it is)")
      ->capture_default_str();
  app->add_option("--seed", a.options.seed, "Of the random points")->capture_default_str();
  app->add_option("--thresholds", a.options.thresholds,
                  "Of F1, relative lengths with commas between")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->default_str("0.001,0.005,0.01,0.02");
  app->add_flag("--no-counts", a.no_counts,
                "Leave out what `cellocut check` counts, and its test for intersections");
  a.common.add_to(*app);
  return {app, [arguments] { return run_evaluate(*arguments); },
          [arguments] { return arguments->meshes.empty() ? "" : arguments->meshes.front(); }};
}

}  // namespace cellocut::tools
