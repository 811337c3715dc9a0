// cellocut solve: a minimum cut problem from a file, solved and proved.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cellocut/base/errors.h"
#include "cellocut/base/read_file.h"
#include "cellocut/base/stopwatch.h"
#include "cellocut_version.h"
#include "solvers/solvers.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/problem_io.h"
#include "tools/session.h"
#include "tools/solver_arguments.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

struct SolveArguments {
  CommonOptions common;
  std::string input;
  std::string format;
  std::string solver = "push_relabel";
  std::string solution;
  std::string check;
  std::string problem;
  bool statistics = false;
  bool no_crossover = false;
  bool reduce = false;
  RelaxationOptions relaxation{};
};

void add_arguments(CLI::App& app, SolveArguments& a) {
  app.add_option("input", a.input, "Problem: .max (DIMACS) or .bbk, or '-' for standard input")
      ->required();
  app.add_option("--format", a.format, "Format of the input: max, bbk (default: by its name)");
  app.add_option("--solver", a.solver, "Minimum-cut solver (see cellocut list)")
      ->capture_default_str();
  app.add_option("--sol", a.solution, "DIMACS solution: the value and the flow of every arc");
  app.add_option("--check", a.check,
                 "Somebody else's DIMACS solution: is it a flow of this problem, is it maximum?");
  app.add_option("--problem", a.problem, "The problem again, as .max or .bbk");
  app.add_flag("--statistics", a.statistics,
               "Degrees, capacities, terminals, components and a bound of the diameter");
  add_solver_options(app, a.reduce, a.relaxation);
  app.add_flag("--no-crossover", a.no_crossover,
               "lp: leave it at a labelling and a bound, with no flow and no canonical cuts");
  a.common.add_to(app);
}

std::int64_t count_ones(const CutLabels& labels) {
  return std::count(labels.begin(), labels.end(), 1);
}

Json result_json(const SolveArguments& a, const CutProblem& problem, const CutResult& cut,
                 double read_seconds) {
  Json counters = Json::object();
  for (const auto& [name, value] : cut.counters) counters[name] = value;
  return {{"version", kCellocutVersion},
          {"input", {{"path", a.input}}},
          {"counts", {{"nodes", problem.node_count()}, {"edges", problem.edges.size()}}},
          {"cut",
           {{"solver", a.solver},
            {"status", to_string(cut.status)},
            {"canonical", cut.canonical},
            {"stop", cut.stop},
            {"message", cut.message},
            {"value", cut.value},
            {"constant", problem.constant},
            {"lower_bound", cut.lower_bound},
            {"gap", cut.value - cut.lower_bound},
            {"source_side_smallest", count_ones(cut.smallest_source_side)},
            {"source_side_largest", count_ones(cut.largest_source_side)},
            {"read_seconds", read_seconds},
            {"build_seconds", cut.build_seconds},
            {"solve_seconds", cut.solve_seconds},
            {"verify_seconds", cut.verify_seconds},
            {"solver_bytes", cut.bytes},
            {"counters", counters}}}};
}

// What is wrong with somebody else's solution, or nothing.
std::string judge_solution(const std::string& path, const DimacsProblem& problem,
                           const CutResult& cut) {
  FlowSolution solution;
  try {
    solution = parse_solution(read_file(path));
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  }
  const std::string defect = check_solution(problem, solution);
  if (!defect.empty()) return path + ": not a flow of this problem: " + defect;
  if (cut.status == CutStatus::gap) {
    if (solution.value >= cut.lower_bound && solution.value <= cut.value) return {};
    return fmt::format("{}: a flow of value {}, but the minimum cut lies between {} and {}", path,
                       solution.value, cut.lower_bound, cut.value);
  }
  if (solution.value != cut.value) {
    return fmt::format("{}: a flow of value {}, but the minimum cut is {}", path, solution.value,
                       cut.value);
  }
  return {};
}

int run_solve(const SolveArguments& a) {
  std::optional<ProblemFormat> format = problem_format_of_path(a.input);
  if (!a.format.empty()) format = problem_format_of_name(a.format);
  if (!format) {
    throw UsageError(a.input +
                     ": the format is not told by the name; use .max or .bbk, or --format");
  }
  std::optional<ProblemFormat> output_format;
  if (!a.problem.empty()) {
    output_format = problem_format_of_path(a.problem);
    if (!output_format) throw UsageError(a.problem + ": use .max or .bbk");
  }
  require_writable({a.solution, a.problem, a.common.json}, {a.input, a.check});
  const std::unique_ptr<CutSolver> solver = solvers::make(a.solver);
  RelaxationOptions relaxation = a.relaxation;
  relaxation.crossover = !a.no_crossover;
  relaxation.validate();
  if (a.no_crossover && !solver->info().exact && !a.solution.empty()) {
    throw UsageError("--sol: without a crossover there is no flow to write");
  }
  const ThreadLimit limit(a.common.threads);
  TerminalObserver observer(a.common);

  const Stopwatch stopwatch;
  observer.stage("read");
  const DimacsProblem problem = read_problem(a.input, *format);
  const double read_seconds = stopwatch.seconds();
  observer.stage("minimum cut");
  const CutResult cut = solver->solve(
      problem.problem,
      SolveOptions{.observer = &observer, .relaxation = relaxation, .reduce = a.reduce});
  observer.stage("write");
  std::string defect;
  if (cut.status == CutStatus::invalid) {
    defect = a.input + ": solver '" + a.solver + "': " + cut.message;
  } else if (!a.check.empty()) {
    defect = judge_solution(a.check, problem, cut);
  }
  Json report = result_json(a, problem.problem, cut, read_seconds);
  if (a.statistics) report["statistics"] = statistics_json(problem_statistics(problem.problem));
  if (cut.canonical && !a.solution.empty()) {
    write_text(a.solution, encode_solution(problem, cut));
  }
  if (output_format) write_problem(problem.problem, a.problem, *output_format);
  observer.clear();
  if (!a.common.json.empty()) write_text(a.common.json, report.dump(2) + "\n");
  if (!defect.empty()) {
    print_error(defect);
    return kCertificateFailed;
  }
  const bool to_standard_output = a.common.json == "-" || a.solution == "-" || a.problem == "-";
  if (!a.common.quiet && !to_standard_output) {
    fmt::print("nodes {}, edges {}\nminimum cut {} ({}), lower bound {}\n",
               problem.problem.node_count(), problem.problem.edges.size(), cut.value,
               to_string(cut.status), cut.lower_bound);
    if (cut.canonical) {
      fmt::print("source side: {} nodes in the smallest minimum cut, {} in the largest\n",
                 count_ones(cut.smallest_source_side), count_ones(cut.largest_source_side));
    } else {
      fmt::print("source side: {} nodes\n", count_ones(cut.largest_source_side));
    }
    if (!cut.stop.empty()) {
      fmt::print("relaxation: stopped at: {}, {} fractional values\n", cut.stop,
                 std::count_if(cut.relaxed.begin(), cut.relaxed.end(),
                               [](float x) { return x > 0 && x < 1; }));
    }
    fmt::print("read {:.3f} s, build {:.3f} s, solve {:.3f} s, verify {:.3f} s\n", read_seconds,
               cut.build_seconds, cut.solve_seconds, cut.verify_seconds);
    if (a.statistics) fmt::print("{}\n", report["statistics"].dump(2));
  }
  return kDone;
}

}  // namespace

Command add_solve(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "solve", "A minimum cut problem from a file (DIMACS .max, .bbk), solved and proved");
  auto arguments = std::make_shared<SolveArguments>();
  add_arguments(*app, *arguments);
  return {app, [arguments] { return run_solve(*arguments); },
          [arguments] { return arguments->input; }};
}

}  // namespace cellocut::tools
