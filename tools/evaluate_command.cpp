// cellocut evaluate: how close meshes are to a reference.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "tools/commands.h"
#include "tools/evaluate_pairs.h"
#include "tools/exit_code.h"
#include "tools/reference.h"
#include "tools/session.h"

namespace cellocut::tools {

namespace {

struct EvaluateArguments {
  CommonOptions common;
  std::vector<std::string> meshes;
  std::string format;
  std::string reference;
  std::string pairs;
  EvaluationWork work;
  ImageArguments images;
  bool no_counts = false;
};

int run_evaluate(EvaluateArguments& a) {
  a.work.counts = !a.no_counts;
  a.work.validate();
  if (a.pairs.empty() && a.meshes.empty()) throw UsageError("meshes is required, or --pairs");
  if (a.pairs.empty() && a.reference.empty()) throw UsageError("--reference is required");
  std::vector<std::string> inputs = a.meshes;
  inputs.insert(inputs.end(), {a.reference, a.pairs});
  require_writable({a.common.json}, inputs);
  const ThreadLimit limit(a.common.threads);
  a.work.images = a.images.load();
  if (!a.pairs.empty()) return evaluate_pairs(a.pairs, a.work, a.common);
  TerminalObserver observer(a.common);
  observer.stage("reference");
  const Reference reference(a.reference, a.work, observer);
  EvaluationReport report = reference.report();
  for (const std::string& path : a.meshes) {
    report.meshes.push_back(reference.evaluate(path, a.format, observer));
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
      "between random samples and from samples to the surface, and the volume IoU of closed "
      "meshes. Lengths are relative to the longest edge of the reference's bounding box");
  auto arguments = std::make_shared<EvaluateArguments>();
  EvaluateArguments& a = *arguments;
  CLI::Option* meshes = app->add_option("meshes", a.meshes, "Meshes: .obj .off .ply .stl, or '-'");
  CLI::Option* format =
      app->add_option("--format", a.format, "Format of the meshes: obj, off, ply, stl");
  CLI::Option* reference =
      app->add_option("--reference", a.reference,
                      "Mesh, or points: a .ply without faces, with or without normals nx ny nz");
  app->add_option("--pairs", a.pairs,
                  "Instead of meshes and reference: a CSV file of rows `mesh,reference`, with "
                  "paths relative to it. A pair that fails does not stop the others; the exit "
                  "code is that of the first failure")
      ->excludes(meshes)
      ->excludes(format)
      ->excludes(reference);
  app->add_option(
         "--samples", a.work.options.samples,
         "Random points on each mesh, uniform by area, 1 to 10^8 (a reference of points is "
         "taken as it is)")
      ->capture_default_str();
  app->add_option("--seed", a.work.options.seed, "Of the random points")->capture_default_str();
  app->add_option("--thresholds", a.work.options.thresholds,
                  "Of F1, relative lengths with commas between")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->default_str("0.001,0.005,0.01,0.02");
  app->add_option("--volume-points", a.work.volume_points,
                  "Random points for the volume IoU, in the box around both; inside by the exact "
                  "parity of faces above. Undefined where one surface is not closed. 0: no IoU")
      ->capture_default_str();
  app->add_flag("--no-counts", a.no_counts,
                "Leave out what `cellocut check` counts, and its test for intersections");
  a.images.add_to(*app);
  a.common.add_to(*app);
  return {app, [arguments] { return run_evaluate(*arguments); },
          [arguments] { return arguments->meshes.empty() ? "" : arguments->meshes.front(); }};
}

}  // namespace cellocut::tools
