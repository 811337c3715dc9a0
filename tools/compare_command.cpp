// cellocut compare: every backend and every solver on the same inputs, with proof.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "backends/backends.h"
#include "cellocut/base/memory.h"
#include "cellocut/base/stopwatch.h"
#include "cellocut_version.h"
#include "solvers/solvers.h"
#include "tools/commands.h"
#include "tools/comparison.h"
#include "tools/comparison_page.h"
#include "tools/exit_code.h"
#include "tools/html_report.h"
#include "tools/pipeline_arguments.h"
#include "tools/problem_io.h"
#include "tools/report_json.h"
#include "tools/session.h"
#include "tools/solver_arguments.h"
#ifdef CELLOCUT_WITH_VIZ
#include "tools/labelled_cells.h"
#endif

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

struct CompareArguments {
  CommonOptions common;
  std::vector<std::string> inputs;
  std::string folder;
  std::string html;  // empty: no page
  std::string backends = "all";
  std::string solvers = "all";
  bool write_problems = false;
  bool no_crossover = false;
  solvers::ComparisonOptions comparison{.solvers = {}, .repeats = 5};
  PipelineArguments pipeline;
};

void add_arguments(CLI::App& app, CompareArguments& a) {
  app.add_option("inputs", a.inputs, "Meshes (.obj .off .ply .stl) and problems (.max .bbk)")
      ->required();
  app.add_option("-o,--output", a.folder,
                 "Folder for compare.csv, compare.json and a VTU per mesh and backend")
      ->required();
  app.add_option("--html", a.html,
                 "A page for a browser in one file: the table, bars of times, energies and stages, "
                 "sections, parameters, and input and output in 3D");
  app.add_option("--backends", a.backends, "Names with commas between, or all")
      ->capture_default_str();
  app.add_option("--solvers", a.solvers,
                 "Names with commas between, all, or own (all but the references)")
      ->capture_default_str();
  app.add_option("--repeat", a.comparison.repeats, "How often each solver solves, 1 to 1000")
      ->capture_default_str();
  app.add_option("--time-limit", a.comparison.seconds_limit,
                 "Seconds after which a solve is given up; 0: never")
      ->capture_default_str();
  add_solver_options(app, a.comparison.reduce, a.comparison.relaxation);
  app.add_flag("--no-crossover", a.no_crossover,
               "lp: leave it at a labelling and a bound, with no flow and no certificate");
  app.add_flag("--write-problems", a.write_problems, "Each mesh's problem too, as .max and .bbk");
  a.pipeline.add_to(app, LambdaOption::number);
  a.common.add_to(app);
}

// The names that are chosen, each checked against the table.
template <class Interface, class Wanted>
std::vector<std::string> choose(const std::vector<Variant<Interface>>& table,
                                const std::string& kind, const std::string& names,
                                const Wanted& wanted) {
  std::vector<std::string> chosen;
  if (names == "all" || names == "own") {
    for (const Variant<Interface>& variant : table) {
      if (variant.make != nullptr && (names == "all" || wanted(variant))) {
        chosen.push_back(variant.name);
      }
    }
    return chosen;
  }
  for (const std::string& name : CLI::detail::split(names, ',')) {
    (void)make_variant(table, kind, name);
    chosen.push_back(name);
  }
  return chosen;
}

std::size_t count_terminal_nodes(const CutProblem& problem) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    count += problem.to_source[i] != 0 || problem.to_sink[i] != 0 ? 1 : 0;
  }
  return count;
}

std::string name_of(const std::string& input) {
  return std::filesystem::path(input).filename().string();
}

std::size_t count_meshes(const std::vector<std::string>& inputs) {
  return static_cast<std::size_t>(std::count_if(
      inputs.begin(), inputs.end(),
      [](const std::string& input) { return !problem_format_of_path(input).has_value(); }));
}

class Comparison {
 public:
  Comparison(CompareArguments& a, TerminalObserver& observer)
      : a_(a), observer_(observer), page_(count_meshes(a.inputs)) {}

  // What cannot be read is found before anything is solved.
  void require_readable() {
    observer_.stage("read");
    for (const std::string& input : a_.inputs) {
      if (input == "-") continue;
      if (const std::optional<ProblemFormat> format = problem_format_of_path(input)) {
        (void)read_problem(input, *format);
      } else {
        (void)read_input(input);
      }
    }
  }

  void run() {
    for (const std::string& input : a_.inputs) {
      observer_.stage(input);
      if (const std::optional<ProblemFormat> format = problem_format_of_path(input)) {
        compare(input, "", read_problem(input, *format).problem);
      } else {
        compare_mesh(input);
      }
    }
  }

  [[nodiscard]] const std::vector<ComparedInstance>& instances() const { return instances_; }
  [[nodiscard]] const std::vector<ComparedBackends>& pairs() const { return pairs_; }
  // What a page shows of meshes; empty where none was asked for.
  [[nodiscard]] PageContent take_content() { return page_.take(); }

 private:
  ComparedInstance& compare(const std::string& input, const std::string& backend,
                            const CutProblem& problem) {
    ComparedInstance& instance = instances_.emplace_back();
    instance.input = input;
    instance.backend = backend;
    instance.nodes = problem.node_count();
    instance.edges = problem.edges.size();
    instance.terminal_nodes = count_terminal_nodes(problem);
    instance.statistics = problem_statistics(problem);
    instance.runs = solvers::compare_solvers(problem, a_.comparison);
    instance.defect = solvers::find_disagreement(instance.runs);
    return instance;
  }

  void compare_mesh(const std::string& input) {
    const TriangleSoup soup = read_input(input);
    std::vector<std::pair<std::string, RemeshResult>> results;
    for (const std::string& backend :
         choose(backends::registered(), "backend", a_.backends, [](const auto&) { return true; })) {
      RemeshResult result =
          pose_cut(soup, a_.pipeline.options, *backends::make(backend), observer_);
      if (result.proxy.mesh.empty()) {
        throw GuaranteeError(input + ": no cell is interior, there is no problem to compare");
      }
      ComparedInstance& instance = compare(input, backend, result.graph.problem);
      const Stopwatch stopwatch;
      certify(instance, result);
      instance.stages = result.stages;
      instance.stages.push_back({"certificates", stopwatch.seconds(), peak_memory_bytes()});
      instance.energy_unit =
          result.frame.unit * result.frame.unit /
          (result.areas.scale * static_cast<double>(result.derived.lambda_fill.denominator));
      write_files(input, backend, result, soup);
      if (!a_.html.empty() && results.empty()) {
        page_.add_scene(name_of(input), backend, result, soup);
      }
      results.emplace_back(backend, std::move(result));
    }
    for (std::size_t i = 1; i < results.size(); ++i) {
      const auto& [first_name, first] = results[0];
      const auto& [name, other] = results[i];
      ComparedBackends pair{
          input, first_name, name, {}, differing_cell_share(first.complex, other.complex)};
      if (first.cut.canonical && other.cut.canonical) {
        const double energy = static_cast<double>(first.cut.value) / first.areas.scale;
        const double other_energy = static_cast<double>(other.cut.value) / other.areas.scale;
        pair.energy_difference = std::fabs(other_energy - energy) / energy;
      }
      pairs_.push_back(std::move(pair));
    }
  }

  // Every flow against the complex itself; the labels of the last stay in the result.
  void certify(ComparedInstance& instance, RemeshResult& result) {
    for (const solvers::SolverRun& run : instance.runs) {
      if (!run.refused.empty() || !run.result.canonical) continue;
      adopt_cut(result, a_.pipeline.options, run.result);
      if (!result.certificate.valid && instance.defect.empty()) {
        instance.defect = "solver '" + run.info.name + "': the certificate failed";
      }
    }
  }

  [[nodiscard]] std::string output(const std::string& input, const std::string& ending) {
    // Two inputs of one name in different folders get numbers.
    const std::string stem = std::filesystem::path(input).stem().string();
    std::string name = stem + ending;
    for (int n = 2; !names_.insert(name).second; ++n)
      name = fmt::format("{}_{}{}", stem, n, ending);
    return (std::filesystem::path(a_.folder) / name).string();
  }

  void write_files(const std::string& input, const std::string& backend, const RemeshResult& result,
                   const TriangleSoup& soup) {
    const ComparedInstance& instance = instances_.back();
    if (a_.write_problems) {
      const std::string path = output(input, "_" + backend + ".max");
      write_problem(result.graph.problem, path, ProblemFormat::dimacs);
      write_problem(result.graph.problem, output(input, "_" + backend + ".bbk"),
                    ProblemFormat::bbk);
    }
#ifdef CELLOCUT_WITH_VIZ
    viz::LabelledCells cells = labelled_cells(result, a_.pipeline.options, "");
    std::vector<std::uint8_t> disagree(result.complex.cells.size(), 0);
    for (const solvers::SolverRun& run : instance.runs) {
      if (!run.refused.empty() || run.result.status == CutStatus::invalid) continue;
      const CutLabels& side = a_.pipeline.options.cut == CutChoice::largest
                                  ? run.result.largest_source_side
                                  : run.result.smallest_source_side;
      CellLabels labels = expand_labels(result.graph, side);
      // A labelling that leaves a gap, or one of many minimum cuts, is no disagreement.
      for (std::size_t c = 0; c < labels.size() && run.result.canonical; ++c) {
        if (labels[c] != result.label[c]) disagree[c] = 1;
      }
      if (!run.result.relaxed.empty() && cells.find("lp_value") == nullptr) {
        cells.arrays.push_back({"lp_value", expand_relaxed(result.graph, run.result.relaxed)});
      }
      cells.arrays.push_back({"label_" + run.info.name, std::move(labels)});
    }
    cells.arrays.push_back({"disagree", std::move(disagree)});
    write_text(output(input, "_" + backend + ".vtu"), encode_vtu(cells));
    if (!a_.html.empty()) page_.add_section(instances_.size() - 1, cells, soup, name_of(input));
#else
    (void)instance;
    (void)soup;
#endif
  }

  CompareArguments& a_;
  TerminalObserver& observer_;
  std::vector<ComparedInstance> instances_;
  std::vector<ComparedBackends> pairs_;
  std::set<std::string> names_;
  ComparisonPage page_;
};

// What was asked for, as far as it can change a number of the report.
Json parameters_json(const CompareArguments& a, const ThreadLimit& limit) {
  const RemeshOptions& options = a.pipeline.options;
  Json json{{"resolution", options.resolution},
            {"epsilon", options.epsilon.value_or(std::max(1.0 / 512, 1.0 / options.resolution))},
            {"decimate", options.decimation.removed_share},
            {"decimation", a.pipeline.decimation},
            {"lambda_fill", to_string(options.lambda_fill)},
            {"support", a.pipeline.support},
            {"exterior", a.pipeline.exterior},
            {"points_inside", options.guidance.inside.size()},
            {"points_outside", options.guidance.outside.size()},
            {"guidance", guidance_json(options.guidance)},
            {"area_bits", options.area_bits},
            {"thickening", options.thickening},
            {"unary", options.unary},
            {"reduce", a.comparison.reduce},
            {"crossover", a.comparison.relaxation.crossover},
            {"time_limit", a.comparison.seconds_limit},
            {"repeats", a.comparison.repeats},
            {"threads", limit.threads()}};
  if (options.epsilon_absolute) {
    json["epsilon"] = nullptr;  // another one for each mesh
    json["epsilon_abs"] = *options.epsilon_absolute;
  }
  return json;
}

int run_compare(CompareArguments& a) {
  a.pipeline.complete();
  if (a.pipeline.options.lambda_auto) {
    throw UsageError("--lambda-fill auto: give a number, so that all solve the same problem");
  }
  a.pipeline.options.validate();
  a.comparison.relaxation.crossover = !a.no_crossover;
  a.comparison.relaxation.validate();
  a.comparison.solvers =
      choose(solvers::registered(), "solver", a.solvers,
             [](const Variant<CutSolver>& variant) { return !variant.make()->info().outside; });
  (void)choose(backends::registered(), "backend", a.backends, [](const auto&) { return true; });
  std::error_code error;
  std::filesystem::create_directories(a.folder, error);
  if (error) throw UsageError(a.folder + ": cannot make the folder: " + error.message());
  const std::filesystem::path folder(a.folder);
  const std::string csv = (folder / "compare.csv").string();
  const std::string json = (folder / "compare.json").string();
  require_writable({csv, json, a.common.json, a.html}, a.inputs);
  const ThreadLimit limit(a.common.threads);
  TerminalObserver observer(a.common);
  a.comparison.observer = &observer;

  Comparison comparison(a, observer);
  if (a.inputs.size() > 1) comparison.require_readable();
  comparison.run();
  observer.clear();
  Json report{{"version", kCellocutVersion},
              {"repeats", a.comparison.repeats},
              {"parameters", parameters_json(a, limit)}};
  report.update(comparison_json(comparison.instances(), comparison.pairs()));
  write_text(csv, comparison_csv(comparison.instances()));
  write_text(json, report.dump(2) + "\n");
  if (!a.common.json.empty()) write_text(a.common.json, report.dump(2) + "\n");
  if (!a.html.empty()) write_text(a.html, html_report(report, comparison.take_content()));
  if (!a.common.quiet && a.common.json != "-" && a.html != "-") {
    fmt::print("{}", comparison_table(comparison.instances(), comparison.pairs()));
  }
  for (const ComparedInstance& instance : comparison.instances()) {
    if (instance.defect.empty()) continue;
    print_error(instance.input + ": " + instance.defect);
    return kCertificateFailed;
  }
  for (const ComparedInstance& instance : comparison.instances()) {
    const auto refused = [](const solvers::SolverRun& run) { return !run.refused.empty(); };
    if (!std::all_of(instance.runs.begin(), instance.runs.end(), refused)) continue;
    print_error(instance.input + ": no solver solved it (" + instance.runs.front().refused + ")");
    return kLimit;
  }
  return kDone;
}

}  // namespace

Command add_compare(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "compare", "Backends and solvers on the same meshes and problem files, timed and proved");
  auto arguments = std::make_shared<CompareArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments] { return run_compare(*arguments); },
          [arguments] { return arguments->inputs.empty() ? "" : arguments->inputs.front(); }};
}

}  // namespace cellocut::tools
