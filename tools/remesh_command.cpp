// cellocut remesh: a defective mesh in, a closed manifold solid out.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "backends/backends.h"
#include "cellocut/base/memory.h"
#include "cellocut/base/stopwatch.h"
#include "cellocut/pipeline.h"
#include "solvers/solvers.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/pipeline_arguments.h"
#include "tools/problem_io.h"
#include "tools/report_json.h"
#include "tools/session.h"
#include "tools/solver_arguments.h"
#include "tools/stage_surfaces.h"
#ifdef CELLOCUT_WITH_VIZ
#include "cellocut_version.h"
#include "tools/labelled_cells.h"
#include "tools/stage_files.h"
#include "viz/vtp_file.h"
#endif

namespace cellocut::tools {

namespace {

struct RemeshArguments {
  CommonOptions common;
  std::string input;
  std::string input_format;
  std::string output;
  std::string output_format;
  std::string backend = "cgal";
  std::string solver = "push_relabel";
  std::string cut = "largest";
  std::string surface = "union";
  std::string vtu;
  std::string vtp;
  bool provenance = false;  // in the output file
  std::string keep_invalid;
  std::string problem;
  std::string stage_surfaces;
  std::string stages;
  PipelineArguments pipeline;

  [[nodiscard]] RemeshOptions& options() { return pipeline.options; }
  [[nodiscard]] const RemeshOptions& options() const { return pipeline.options; }
};

void add_arguments(CLI::App& app, RemeshArguments& a) {
  app.add_option("input", a.input, "Mesh: .obj .off .ply .stl, or '-' for standard input")
      ->required();
  app.add_option("--format", a.input_format,
                 "Format of the input: obj, off, ply, stl (default: by its name)");
  app.add_option("-o,--output", a.output, "Surface: .obj .off .ply .stl, or '-'")->required();
  app.add_option("--output-format", a.output_format,
                 "Format of the output: obj, off, ply, ply-ascii, stl, stl-ascii (default: by its "
                 "name)");
  app.add_option("--backend", a.backend, "Tetrahedralization backend (see cellocut list)")
      ->capture_default_str();
  app.add_option("--solver", a.solver, "Minimum-cut solver (see cellocut list)")
      ->capture_default_str();
  a.pipeline.add_to(app, LambdaOption::number_or_auto);
  app.add_option("--cut", a.cut, "Which of the minimum cuts: the smallest or the largest interior")
      ->check(CLI::IsMember({"smallest", "largest"}))
      ->capture_default_str();
  app.add_option(
         "--surface", a.surface,
         "union: phi where supported, absorbed cells where completed; sdf: signed distance of the "
         "interface, marching cubes; cells: the interface itself")
      ->check(CLI::IsMember({"union", "sdf", "cells"}))
      ->capture_default_str();
  app.add_flag_function(
      "--pull,!--no-pull", [&a](std::int64_t count) { a.options().pull = count > 0; },
      "Pull supported vertices to the input, off the offset surface (default: with "
      "--surface union)");
  app.add_option("--pull-distance", a.pipeline.options.pull_distance,
                 "What --pull leaves, relative to the longest edge (default: min(1/resolution, "
                 "epsilon) / 40)");
  app.add_flag("--fair", a.pipeline.options.fair,
               "Completed patches follow a bending energy, with smooth joints to their rims");
  app.add_option("--faces", a.pipeline.options.faces,
                 "Simplify the surface to so many triangles, where it stays valid (0: not)")
      ->capture_default_str();
  app.add_option("--max-error", a.pipeline.options.max_error,
                 "Simplify no further than to this Hausdorff distance from the full surface, "
                 "relative to the longest edge (0: no bound)")
      ->capture_default_str();
  add_solver_options(app, a.pipeline.options.reduce, a.pipeline.options.relaxation);
  app.add_option("--min-component", a.pipeline.options.min_component,
                 "Drop components below this share of the total volume, 0 to 1")
      ->capture_default_str();
  app.add_option("--keep-invalid", a.keep_invalid,
                 "Where a surface goes that fails its check (it never replaces the output)");
  app.add_option("--problem", a.problem, "The cut problem: .max (DIMACS) or .bbk");
  app.add_option("--stage-surfaces", a.stage_surfaces,
                 "Folder for the surfaces before the cut: thickened.ply, simplified.ply, "
                 "tetrahedralized.ply");
  app.add_flag(
      "--float-coordinates", a.pipeline.options.float_coordinates,
      "Coordinates that floats hold, so that the surface stays valid in programs that read "
      "in single precision (binary STL has no others)");
  app.add_flag("--provenance", a.provenance,
               "In a PLY output, for each vertex: nearest_face of the input, distance to it (input "
               "units), supported (1) or completed (0)");
  app.add_flag("--transfer-colour", a.pipeline.options.transfer_colour,
               "Give the surface the colours of the input's vertices, from the nearest points");
#ifdef CELLOCUT_WITH_VIZ
  app.add_option("--vtp", a.vtp, "The surface with its provenance for ParaView");
  app.add_option("--vtu", a.vtu, "Labelled tetrahedra for ParaView");
  app.add_option(
      "--save-stages", a.stages,
      "Folder for every stage as files for ParaView: the input with its defects, the "
      "proxy, the labelled cells, the facets of the cut, the surface; run.vtm opens all");
#endif
  a.common.add_to(app);
}

#ifdef CELLOCUT_WITH_VIZ
constexpr const char* kOrVtp = " or add --vtp FILE";
#else
constexpr const char* kOrVtp = "";
#endif

bool is_ply(MeshFormat format) {
  return format == MeshFormat::ply || format == MeshFormat::ply_ascii;
}

// That some output has room for what is asked for.
void check_vertex_values(const RemeshArguments& a) {
  const MeshFormat format = a.options().output_format;
  if (!a.vtp.empty()) return;
  if (a.provenance && !is_ply(format)) {
    throw UsageError(a.output + ": --provenance has no place in this format; write .ply" + kOrVtp);
  }
  if (a.options().transfer_colour && !is_ply(format) && format != MeshFormat::obj) {
    throw UsageError(
        a.output + ": --transfer-colour has no place in this format; write .ply or .obj" + kOrVtp);
  }
}

void complete_options(RemeshArguments& a) {
  a.pipeline.complete();
  a.options().cut = a.cut == "largest" ? CutChoice::largest : CutChoice::smallest;
  a.options().surface = a.surface == "union" ? SurfaceMode::union_
                        : a.surface == "sdf" ? SurfaceMode::sdf
                                             : SurfaceMode::cells;
  const std::optional<MeshFormat> format =
      a.output_format.empty() ? format_of_path(a.output) : format_of_name(a.output_format);
  if (!format) {
    throw UsageError(a.output +
                     ": the output's format is not told by its name; use .obj, .off, .ply or .stl, "
                     "or --output-format");
  }
  a.options().output_format = *format;
  a.options().provenance = a.provenance || !a.vtp.empty() || !a.stages.empty();
  check_vertex_values(a);
  a.options().validate();
  a.options().relaxation.validate();
  if (!a.problem.empty() && !problem_format_of_path(a.problem)) {
    throw UsageError(a.problem + ": the cut problem is written as .max or .bbk");
  }
  require_writable({a.output, a.vtu, a.vtp, a.common.json, a.keep_invalid, a.problem});
  // (The surface may take the place of the input: it is whole before it does.)
  require_writable({a.vtu, a.vtp, a.common.json, a.keep_invalid, a.problem}, {a.input});
  require_folder(a.stages);
  require_folder(a.stage_surfaces);
}

void print_summary(const RemeshResult& result, const RemeshArguments& a,
                   const std::vector<StageTime>& stages) {
  if (a.common.quiet || a.output == "-" || a.common.json == "-" || a.vtu == "-" || a.vtp == "-") {
    return;
  }
  fmt::print("{:<20} {:>9}\n", "stage", "seconds");
  double total = 0;
  for (const StageTime& stage : stages) {
    fmt::print("{:<20} {:>9.3f}\n", stage.name, stage.seconds);
    total += stage.seconds;
  }
  fmt::print("{:<20} {:>9.3f}\n", "total", total);
  fmt::print("peak memory {:.2f} GB\n", static_cast<double>(peak_memory_bytes()) * 1e-9);
  fmt::print("cells {}, facets {}, nodes {}, edges {}\n", result.complex.cells.size(),
             result.facets.size(), result.graph.problem.node_count(),
             result.graph.problem.edges.size());
  if (result.fill_choice) {
    const FillChoice& choice = *result.fill_choice;
    fmt::print("lambda_fill {} of {} labellings, the same from {:.4g} to {:.4g}",
               to_string(choice.lambda), choice.labellings, to_double(choice.chosen.from),
               to_double(choice.chosen.to));
    if (choice.runner_up) {
      fmt::print("; another solid, near {:.4g}, has {:.1f} % less one-sided input",
                 to_double(choice.runner_up->from), 100 * choice.margin());
    }
    fmt::print("\n");
  }
  fmt::print("cut value {} ({}), certificate {}\n", result.cut.value, to_string(result.cut.status),
             result.certificate.valid ? "valid" : "FAILED");
  if (a.options().pulls()) {
    const PullReport& pull = result.pull;
    fmt::print(
        "pull: {} of {} vertices supported, {} stopped early, {} went back; distance from "
        "the input median {:.3g}, 95 % {:.3g}\n",
        pull.supported, pull.vertices, pull.stopped_early, pull.went_back, pull.offset.median,
        pull.offset.p95);
  }
  if (a.options().fair) {
    const FairReport& fair = result.fair;
    fmt::print(
        "fairing: {} patches ({} left as they were), {} vertices, bending {:.3g} to {:.3g}\n",
        fair.patches, fair.patches_left, fair.vertices_moved, fair.bending_before,
        fair.bending_after);
  }
  if (a.options().simplifies()) {
    fmt::print(
        "simplification: error at most {:.3g}{}{}\n", result.simplification.error,
        result.simplification.reached ? "" : "; stopped early: ", result.simplification.stop);
  }
  const SurfaceReport& report = result.surface_report;
  fmt::print("surface: {} triangles, {} component{}, volume {:.6g}, {}\n", report.triangles,
             report.components.size(), report.components.size() == 1 ? "" : "s", report.volume,
             report.valid() ? "closed, manifold, embedded" : "NOT VALID");
}

std::string describe_defects(const SurfaceReport& report) {
  std::string text;
  const auto add = [&](std::int64_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + what;
  };
  add(report.by_index.boundary_edges, "boundary edges");
  add(report.by_index.nonmanifold_edges, "non-manifold edges");
  add(report.by_index.nonmanifold_vertices, "non-manifold vertices");
  add(report.by_index.misoriented_edges, "misoriented edges");
  add(report.nonfinite_points, "points not finite");
  add(report.degenerate_faces, "degenerate faces");
  add(report.intersecting_pairs, "intersecting pairs");
  return text.empty() ? "no faces" : text;
}

// What may be tried where these coordinates are too coarse for a valid surface.
std::string remedy(const RemeshOptions& options) {
  if (options.float_coordinates) {
    return "; floats may be too coarse for coordinates so far from the origin: try without "
           "--float-coordinates";
  }
  const MeshFormat format = options.output_format;
  const bool stl = format == MeshFormat::stl || format == MeshFormat::stl_ascii;
  return stl ? "; STL merges equal points, and binary STL keeps floats: use OBJ or PLY" : "";
}

// The exit code, and in one line what is wrong, if anything.
struct Verdict {
  ExitCode code = kDone;
  std::string problem;
};

Verdict judge(const RemeshResult& result, const RemeshArguments& a) {
  if (result.proxy.mesh.empty()) {  // phi is nowhere negative: there was nothing to cut
    return {kNoGuarantee, a.input + ": no cell is interior, there is no solid to write"};
  }
  if (result.cut.status == CutStatus::invalid) {
    return {kCertificateFailed, a.input + ": solver '" + a.solver + "': " + result.cut.message};
  }
  if (!result.certificate.valid) {
    std::string first;
    for (const CertificateCheck& check : result.certificate.checks) {
      if (!check.passed && first.empty()) first = check.name + ": " + check.detail;
    }
    return {kCertificateFailed, a.input + ": the certificate of the cut failed: " + first};
  }
  if (result.empty_solid()) {
    return {kNoGuarantee, a.input + ": no cell is interior, there is no solid to write"};
  }
  if (!result.surface_report.valid()) {
    return {kNoGuarantee, a.output + ": not written, the surface would not be valid (" +
                              describe_defects(result.surface_report) + ")" + remedy(a.options())};
  }
  return {};
}

// The surface that passed its check, in every file that was asked for.
void write_surface(const RemeshResult& result, const RemeshArguments& a) {
  const std::vector<VertexAttribute> attributes =
      a.options().provenance ? result.provenance.attributes() : std::vector<VertexAttribute>();
  const MeshFormat format = a.options().output_format;
  if (a.provenance && is_ply(format)) {
    write_mesh(result.surface, a.output, format, attributes);
  } else {
    write_mesh(result.surface, a.output, format);
  }
#ifdef CELLOCUT_WITH_VIZ
  if (!a.vtp.empty()) {
    const std::vector<viz::FieldValue> fields{
        {"cellocut_version", std::string(kCellocutVersion)},
        {"legend_supported", std::string("1 follows the input, 0 completed")}};
    write_text(a.vtp, viz::encode_vtp(result.surface, attributes, fields));
  }
#endif
}

int run_remesh(RemeshArguments& a) {
  complete_options(a);
  const std::unique_ptr<Tetrahedralizer> tetrahedralizer = backends::make(a.backend);
  const std::unique_ptr<CutSolver> solver = solvers::make(a.solver);
  const ThreadLimit limit(a.common.threads);
  TerminalObserver observer(a.common);

  Stopwatch stopwatch;
  observer.stage("read");
  const TriangleSoup input = read_input(a.input, a.input_format);
  std::vector<StageTime> stages{{"read", stopwatch.seconds(), peak_memory_bytes()}};

  const RemeshResult result = remesh(input, a.options(), *tetrahedralizer, *solver, observer);
  stages.insert(stages.end(), result.stages.begin(), result.stages.end());

  stopwatch.restart();
  observer.check();
  observer.stage("write");
  const auto [code, problem] = judge(result, a);
  // First what was asked for first: no other file that cannot be written costs it.
  if (code == kDone) write_surface(result, a);
#ifdef CELLOCUT_WITH_VIZ
  if (!a.stages.empty()) {
    write_stage_files(result, a.options(), input, a.solver, a.stages, observer);
  }
  if (!a.vtu.empty()) write_text(a.vtu, encode_vtu(labelled_cells(result, a.options(), a.solver)));
#endif
  if (!a.problem.empty() && !result.graph.decided.empty()) {
    write_problem(result.graph.problem, a.problem, *problem_format_of_path(a.problem));
  }
  if (!a.stage_surfaces.empty()) write_stage_surfaces(result, a.stage_surfaces);
  if (code != kDone && !a.keep_invalid.empty() && !result.surface.empty()) {
    write_mesh(result.surface, a.keep_invalid,
               format_of_path(a.keep_invalid).value_or(MeshFormat::obj));
  }
  stages.push_back({"write", stopwatch.seconds(), peak_memory_bytes()});
  observer.clear();
  if (!a.common.json.empty()) {
    const RunFacts facts{
        a.input, code == kDone ? a.output : "", a.backend, a.solver, limit.threads(), stages};
    write_text(a.common.json, remesh_json(result, a.options(), input, facts).dump(2) + "\n");
  }
  if (code != kDone) {
    print_error(problem);
    return code;
  }
  if (input.skipped_polygons > 0 && !a.common.quiet) {
    print_error(fmt::format("{}: warning: left out {} faces of fewer than three corners", a.input,
                            input.skipped_polygons));
  }
  if (result.derived.epsilon_below_step && !a.common.quiet) {
    print_error("warning: epsilon is below one grid step, thin parts may perforate");
  }
  print_summary(result, a, stages);
  return kDone;
}

}  // namespace

Command add_remesh(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "remesh", "A defective mesh in, a closed, manifold, embedded solid out");
  auto arguments = std::make_shared<RemeshArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments] { return run_remesh(*arguments); },
          [arguments] { return arguments->input; }};
}

}  // namespace cellocut::tools
