// cellocut path: every labelling that is a minimum for some lambda_fill.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <regex>

#include "backends/backends.h"
#include "cellocut/base/memory.h"
#include "cellocut/base/stopwatch.h"
#include "cellocut/pipeline.h"
#include "cellocut_version.h"
#include "solvers/solvers.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/path_report.h"
#include "tools/pipeline_arguments.h"
#include "tools/report_json.h"
#include "tools/session.h"
#ifdef CELLOCUT_WITH_VIZ
#include "cellocut/mesh/unused_points.h"
#include "cellocut/surface/interface.h"
#include "tools/labelled_cells.h"
#include "viz/vtp_file.h"
#endif

namespace cellocut::tools {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct PathArguments {
  CommonOptions common;
  std::string input;
  std::string input_format;
  std::string folder;
  std::string range = "1,1000";
  std::string backend = "cgal";
  std::string solver = "push_relabel";
  int surfaces = 40;
  PipelineArguments pipeline;
};

void add_arguments(CLI::App& app, PathArguments& a) {
  app.add_option("input", a.input, "Mesh: .obj .off .ply .stl, or '-' for standard input")
      ->required();
  app.add_option("--format", a.input_format,
                 "Format of the input: obj, off, ply, stl (default: by its name)");
  app.add_option("-o,--output", a.folder,
                 "Folder for path.json, path.csv, path.svg, cells.vtu, path.pvd and its surfaces")
      ->required();
  app.add_option("--range", a.range, "From and to which lambda_fill: two numbers or fractions p/q")
      ->capture_default_str();
  app.add_option("--backend", a.backend, "Tetrahedralization backend (see cellocut list)")
      ->capture_default_str();
  app.add_option("--solver", a.solver, "Exact minimum-cut solver (see cellocut list)")
      ->capture_default_str();
#ifdef CELLOCUT_WITH_VIZ
  app.add_option("--surfaces", a.surfaces,
                 "How many surfaces path.pvd has: of the labellings with the longest intervals of "
                 "log lambda; 0: no path.pvd")
      ->check(CLI::Range(0, 100000))
      ->capture_default_str();
#endif
  a.pipeline.add_to(app, LambdaOption::none);
  a.common.add_to(app);
}

struct Range {
  Lambda first;
  Lambda last;
};

Range parse_range(const std::string& text) {
  const std::vector<std::string> ends = CLI::detail::split(text, ',');
  if (ends.size() != 2) throw UsageError("--range: give two numbers, such as 1,1000");
  Range range;
  try {
    const Rational first = parse_rational(ends[0]);
    const Rational last = parse_rational(ends[1]);
    range = {{first.numerator, first.denominator}, {last.numerator, last.denominator}};
  } catch (const UsageError& error) {
    throw UsageError(std::string("--range: ") + error.what());
  }
  if (!(range.first < range.last)) throw UsageError("--range: the first has to be the smaller one");
  return range;
}

#ifdef CELLOCUT_WITH_VIZ

// The largest lambda at which a cell is interior: of anchors the end of the range, 0 where it is
// exterior throughout.
std::vector<double> largest_interior_lambda(const CellPath& path) {
  std::vector<double> value(path.count() + 1, 0.0);
  for (std::size_t level = 1; level < path.count(); ++level) {
    value[level] = to_double(path.path.breakpoints[level - 1]);
  }
  value[path.count()] = to_double(path.path.last);
  std::vector<double> values(path.level.size());
  for (std::size_t c = 0; c < values.size(); ++c) values[c] = value[path.level[c]];
  return values;
}

std::string encode_cells(const RemeshResult& result, const RemeshOptions& options,
                         const CellPath& path, const std::string& solver) {
  viz::LabelledCells cells = labelled_cells(result, options, solver);
  std::erase_if(cells.fields, [](const viz::FieldValue& field) {
    return field.name == "lambda_fill" || field.name == "cut_value" ||
           field.name == "cut_lower_bound" || field.name == "energy";
  });
  // Where labellings are not nested a cell may leave and come back.
  if (path.path.nested) {
    cells.arrays.push_back({"label_path", largest_interior_lambda(path)});
    cells.fields.push_back({"legend_label_path",
                            std::string("the largest lambda_fill at which the cell is interior")});
  }
  return viz::encode_vtu(cells);
}

// The labellings with the longest intervals of log lambda, at most `most`, ascending.
std::vector<std::size_t> longest_intervals(const std::vector<PathEntry>& entries,
                                           std::size_t most) {
  std::vector<std::size_t> chosen(entries.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  const auto ratio = [&entries](std::size_t k) {
    return to_double(entries[k].to) / to_double(entries[k].from);
  };
  std::stable_sort(chosen.begin(), chosen.end(),
                   [&ratio](std::size_t a, std::size_t b) { return ratio(a) > ratio(b); });
  chosen.resize(std::min(chosen.size(), most));
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

// Those of an earlier path in this folder; the collection first, so that it never lists what is not
// there.
void remove_surfaces(const fs::path& folder) {
  fs::remove(folder / "path.pvd");
  const std::regex of_a_labelling("interface_[0-9]+\\.vtp");
  std::vector<fs::path> surfaces;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (std::regex_match(entry.path().filename().string(), of_a_labelling)) {
      surfaces.push_back(entry.path());
    }
  }
  for (const fs::path& surface : surfaces) fs::remove(surface);
}

// Surfaces of labellings, and a collection whose time is lambda.
void write_surfaces(const fs::path& folder, const RemeshResult& result, const CellPath& path,
                    const std::vector<PathEntry>& entries, std::size_t most, Observer& observer) {
  std::string collection =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const std::size_t k : longest_intervals(entries, most)) {
    observer.check();
    observer.progress(static_cast<double>(k) / static_cast<double>(entries.size()));
    const std::string name = fmt::format("interface_{:04}.vtp", k);
    const std::vector<viz::FieldValue> fields{{"lambda_from", to_double(entries[k].from)},
                                              {"lambda_to", to_double(entries[k].to)}};
    const TriangleSoup interface =
        interface_triangles(result.complex, list_interface(result.complex, path.labels(k)));
    const TriangleSoup surface = drop_unused_points(interface.points, interface.triangles);
    write_text((folder / name).string(), viz::encode_vtp(surface, {}, fields));
    collection +=
        fmt::format("<DataSet timestep=\"{}\" file=\"{}\"/>\n", to_double(entries[k].from), name);
  }
  write_text((folder / "path.pvd").string(), collection + "</Collection>\n</VTKFile>\n");
}

#endif

// Before any work: that the folder is there or can be made, and that no file is asked for twice.
void check_outputs(const PathArguments& a) {
  const fs::path folder(a.folder);
  for (const char* name : {"path.json", "path.csv", "path.svg", "cells.vtu", "path.pvd"}) {
    if (!a.common.json.empty() && a.common.json != "-" &&
        fs::weakly_canonical(a.common.json) == fs::weakly_canonical(folder / name)) {
      throw UsageError(a.common.json + ": two outputs cannot be the same file");
    }
  }
  require_folder(a.folder);
  const std::string report = fs::is_directory(folder) ? (folder / "path.json").string() : "";
  require_writable({report, a.common.json}, {a.input});
}

int run_path(PathArguments& a) {
  a.pipeline.complete();
  RemeshOptions& options = a.pipeline.options;
  options.lambda_fill = {1, 1};
  options.validate();
  const Range range = parse_range(a.range);
  const auto backend = backends::make(a.backend);
  const auto solver = solvers::make(a.solver);
  if (!solver->info().exact) throw UsageError("--solver: the path needs an exact one");
  check_outputs(a);
  const ThreadLimit limit(a.common.threads);
  TerminalObserver observer(a.common);

  const TriangleSoup input = read_input(a.input, a.input_format);
  const fs::path folder(a.folder);
  RemeshResult result = pose_cut(input, options, *backend, observer);
  const CellLabels& initial = result.initial_label;
  if (std::find(initial.begin(), initial.end(), kInterior) == initial.end()) {
    throw GuaranteeError("no cell is interior, there is no solid");
  }
  observer.stage("path");
  std::optional<PathChecker> checker;
  if (options.support == SupportRule::facets) checker.emplace(path_checker(result, options));
  Stopwatch stopwatch;
  const CellPath path =
      find_path(result, range.first, range.last, *solver, observer, checker ? &*checker : nullptr);
  result.stages.push_back({"path", stopwatch.seconds(), peak_memory_bytes()});
  observer.stage("certificate");
  stopwatch.restart();
  if (!checker) checker.emplace(path_checker(result, options));
  const CertificateReport certificate = checker->check(path, {range.first, range.last});
  result.stages.push_back({"certificate", stopwatch.seconds(), peak_memory_bytes()});
  const std::vector<PathEntry> entries =
      path_entries(result, path, path_solids(result.complex, path));

  Json report{
      {"version", kCellocutVersion},
      {"input",
       {{"path", a.input}, {"points", input.points.size()}, {"triangles", input.triangles.size()}}},
      {"parameters",
       {{"resolution", options.resolution},
        {"epsilon", result.derived.epsilon},
        {"epsilon_abs", result.derived.epsilon * result.frame.unit},
        {"decimate", options.decimation.removed_share},
        {"decimation", a.pipeline.decimation},
        {"exterior", a.pipeline.exterior},
        {"guidance", guidance_json(options.guidance)},
        {"area_bits", options.area_bits},
        {"support", a.pipeline.support},
        {"backend", a.backend},
        {"solver", a.solver},
        {"range", {to_double(range.first), to_double(range.last)}}}}};
  Json stages = Json::array();
  for (const StageTime& stage : result.stages) {
    stages.push_back({{"name", stage.name},
                      {"seconds", stage.seconds},
                      {"peak_memory_bytes", stage.peak_memory}});
  }
  report["stages"] = stages;
  report["counts"] = {{"cells", result.complex.cells.size()},
                      {"nodes", result.graph.problem.node_count()},
                      {"edges", result.graph.problem.edges.size()}};
  report["area_quantum"] = 1 / result.areas.scale;
  report["nested"] = path.path.nested;
  report.update(path_json(entries, path, certificate));
  observer.stage("files");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw OutputError("cannot make the folder: " + error.message(), a.folder);
  const std::string name = fs::path(a.input).filename().string();
  write_text((folder / "path.csv").string(), path_csv(entries));
  write_text((folder / "path.svg").string(),
             path_plot(entries, fmt::format("{}, R = {}: {} labellings", name, options.resolution,
                                            entries.size())));
#ifdef CELLOCUT_WITH_VIZ
  write_text((folder / "cells.vtu").string(), encode_cells(result, options, path, a.solver));
  remove_surfaces(folder);
  if (a.surfaces > 0) {
    write_surfaces(folder, result, path, entries, static_cast<std::size_t>(a.surfaces), observer);
  }
#endif
  write_text((folder / "path.json").string(), report.dump(2) + "\n");
  if (!a.common.json.empty()) write_text(a.common.json, report.dump(2) + "\n");
  observer.clear();
  if (!a.common.quiet && a.common.json != "-") {
    fmt::print("{:>12} {:>12} {:>12} {:>12} {:>12} {:>10}\n", "lambda from", "to", "supported",
               "unsupported", "volume", "components");
    for (const PathEntry& entry : entries) {
      fmt::print("{:12.6g} {:12.6g} {:12.6g} {:12.6g} {:12.6g} {:10}\n", to_double(entry.from),
                 to_double(entry.to), entry.supported, entry.unsupported, entry.solid.volume,
                 entry.solid.components);
    }
    fmt::print("{} labellings, {} solves, {:.2f} s; certificate {}\n", entries.size(),
               path.path.solves, result.stages[result.stages.size() - 2].seconds,
               certificate.valid ? "valid" : "NOT VALID");
  }
  if (certificate.valid) return kDone;
  print_error(a.input + ": the certificate of the path failed");
  return kCertificateFailed;
}

}  // namespace

Command add_path(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "path", "Every labelling that is a minimum for some lambda_fill of a range, proved");
  auto arguments = std::make_shared<PathArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments] { return run_path(*arguments); },
          [arguments] { return arguments->input; }};
}

}  // namespace cellocut::tools
