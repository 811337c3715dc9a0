// The sweep over real defective meshes: every mesh, both backends, all exact solvers on the same
// instance.
//
//   cellocut_sweep FOLDER [--resolution 256] [--only NAME[,NAME...]] [--surface union|sdf|cells]
//
// Prints a table and `N passed, N failed`; exit 1 where a mesh fails. A mesh passes where, on every
// backend, all exact solvers give the same value and bit for bit the same canonical labellings, the
// certificate of each holds, and the surface is valid with a positive volume.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "backends/backends.h"
#include "cellocut/base/stopwatch.h"
#include "cellocut/mesh/mesh_file.h"
#include "cellocut/pipeline.h"
#include "solvers/comparison.h"
#include "solvers/solvers.h"

namespace {

using namespace cellocut;

struct Arguments {
  std::string folder;
  std::string only;
  RemeshOptions options;
};

Arguments parse(int argc, char** argv) {
  Arguments a;
  a.options.resolution = 256;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--resolution" && has_value) {
      a.options.resolution = std::stoi(argv[++i]);
    } else if (word == "--only" && has_value) {
      a.only = std::string(",") + argv[++i] + ",";
    } else if (word == "--surface" && has_value) {
      const std::string name = argv[++i];
      a.options.surface = name == "cells" ? SurfaceMode::cells
                          : name == "sdf" ? SurfaceMode::sdf
                                          : SurfaceMode::union_;
    } else if (a.folder.empty() && word.rfind("--", 0) != 0) {
      a.folder = word;
    } else {
      throw UsageError(
          "usage: cellocut_sweep FOLDER [--resolution R] [--only NAME,...] "
          "[--surface union|sdf|cells]");
    }
  }
  if (a.folder.empty()) throw UsageError("name the folder of the meshes");
  return a;
}

// Every exact solver on the problem of `result`, whose labels and flow become those of the last;
// what disagrees, or nothing. `times` says what each took.
std::string disagreement(RemeshResult& result, const RemeshOptions& options, std::string& times) {
  solvers::ComparisonOptions comparison;
  for (const Variant<CutSolver>& variant : solvers::registered()) {
    if (variant.make != nullptr && variant.make()->info().exact) {
      comparison.solvers.push_back(variant.name);
    }
  }
  const std::int64_t value = result.cut.value;
  const auto runs = solvers::compare_solvers(result.graph.problem, comparison);
  times = "  build and solve, s:";
  for (const solvers::SolverRun& run : runs) {
    if (!run.refused.empty()) return run.info.name + ": " + run.refused;
    times += fmt::format(" {} {:.3f} + {:.3f}", run.info.name, run.build_seconds[0],
                         run.solve_seconds[0]);
  }
  std::string defect = solvers::find_disagreement(runs);
  if (!defect.empty()) return defect;
  for (const solvers::SolverRun& run : runs) {
    if (run.result.value != value) return run.info.name + ": another value";
    adopt_cut(result, options, run.result);
    if (!result.certificate.valid) return run.info.name + ": the certificate fails";
  }
  return {};
}

std::string surface_defect(const RemeshResult& result) {
  const SurfaceReport& report = result.surface_report;
  if (result.surface.empty()) return "no surface";
  if (!report.valid()) return "the surface is not valid";
  if (!(report.volume > 0)) return "the volume is not positive";
  return {};
}

double energy(const RemeshResult& result) {
  return static_cast<double>(result.cut.value) / result.areas.scale;
}

// One mesh on all backends. True where it passes.
bool run_mesh(const std::filesystem::path& path, const RemeshOptions& options) {
  const TriangleSoup input = read_mesh(path.string());
  std::vector<std::pair<std::string, RemeshResult>> results;
  bool passed = true;
  for (const Variant<Tetrahedralizer>& backend : backends::registered()) {
    if (backend.make == nullptr) continue;
    const Stopwatch stopwatch;
    const std::unique_ptr<Tetrahedralizer> tetrahedralizer = backend.make();
    const std::unique_ptr<CutSolver> solver = solvers::make("bk");
    RemeshResult result = remesh(input, options, *tetrahedralizer, *solver);
    const double seconds = stopwatch.seconds();
    std::string times;
    std::string defect = surface_defect(result);
    if (!result.certificate.valid) defect = "the certificate fails";
    if (defect.empty()) defect = disagreement(result, options, times);
    passed = passed && defect.empty();
    const SurfaceReport& report = result.surface_report;
    fmt::print("{:<40} {:<7} {:>8} {:>8} {:>16} {:>8} {:>5} {:>11.5g} {:>6.2f} {:>6.3f}  {}\n",
               path.filename().string(), backend.name, result.complex.cells.size(),
               result.graph.problem.node_count(), result.cut.value, report.triangles,
               report.components.size(), report.volume, seconds, result.proxy.largest_distance,
               defect.empty() ? "ok" : defect);
    if (!times.empty()) fmt::print("{:<40}{}\n", "", times);
    std::fflush(stdout);
    results.emplace_back(backend.name, std::move(result));
  }
  if (results.size() == 2) {
    const RemeshResult& a = results[0].second;
    const RemeshResult& b = results[1].second;
    fmt::print("{:<40} between {}: energy differs by {:.2e}, {:.4f} % of the cells differ\n", "",
               results[0].first + " and " + results[1].first,
               std::abs(energy(a) - energy(b)) / energy(a),
               100 * differing_cell_share(a.complex, b.complex));
  }
  return passed;
}

int run(const Arguments& a) {
  std::vector<std::filesystem::path> meshes;
  for (const auto& entry : std::filesystem::directory_iterator(a.folder)) {
    const std::string name = entry.path().filename().string();
    if (!format_of_path(name)) continue;
    if (!a.only.empty() && a.only.find("," + name + ",") == std::string::npos) continue;
    meshes.push_back(entry.path());
  }
  std::sort(meshes.begin(), meshes.end());
  fmt::print("{:<40} {:<7} {:>8} {:>8} {:>16} {:>8} {:>5} {:>11} {:>6} {:>6}  {}\n", "mesh",
             "backend", "cells", "nodes", "cut value", "faces", "parts", "volume", "s", "proxy",
             "all exact solvers, certificates, surface");
  int passed = 0;
  int failed = 0;
  for (const std::filesystem::path& mesh : meshes) {
    try {
      (run_mesh(mesh, a.options) ? passed : failed) += 1;
    } catch (const Error& error) {
      fmt::print("{:<40} {}\n", mesh.filename().string(), error.what());
      ++failed;
    }
  }
  fmt::print("{} passed, {} failed\n", passed, failed);
  return failed == 0 && passed > 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(parse(argc, argv));
  } catch (const std::exception& error) {
    fmt::print(stderr, "cellocut_sweep: {}\n", error.what());
    return 2;
  }
}
