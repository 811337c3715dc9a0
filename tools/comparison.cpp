#include "tools/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/problem_io.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;
using solvers::median;
using solvers::SolverRun;

double smallest(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

double solve_time(const SolverRun& run) { return median(run.solve_seconds); }

double whole_time(const SolverRun& run) { return median(run.build_seconds) + solve_time(run); }

std::string status_of(const SolverRun& run) {
  return run.refused.empty() ? to_string(run.result.status) : "refused";
}

// Of a relaxation also why it stopped.
std::string status_and_stop(const SolverRun& run) {
  return status_of(run) + (run.result.stop.empty() ? "" : " (" + run.result.stop + ")");
}

// In quotes, as a path may hold a comma.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

std::string title_of(const ComparedInstance& instance) {
  const std::string name = std::filesystem::path(instance.input).filename().string();
  return instance.backend.empty() ? name : name + " on " + instance.backend;
}

// Over the instances that all solvers solved: the geometric mean of time / fastest time.
template <class Time>
std::vector<double> relative_means(const std::vector<ComparedInstance>& instances,
                                   const Time& time) {
  std::vector<double> logarithms;
  std::size_t count = 0;
  for (const ComparedInstance& instance : instances) {
    const auto solved = [](const SolverRun& run) { return run.refused.empty(); };
    if (!std::all_of(instance.runs.begin(), instance.runs.end(), solved)) continue;
    double fastest = std::numeric_limits<double>::infinity();
    for (const SolverRun& run : instance.runs) fastest = std::min(fastest, time(run));
    if (!(fastest > 0)) continue;
    logarithms.resize(instance.runs.size(), 0);
    for (std::size_t s = 0; s < instance.runs.size(); ++s) {
      logarithms[s] += std::log(time(instance.runs[s]) / fastest);
    }
    ++count;
  }
  for (double& value : logarithms) value = std::exp(value / static_cast<double>(count));
  return logarithms;
}

Json times_json(const std::vector<double>& seconds) {
  return {{"minimum", smallest(seconds)},
          {"median", median(seconds)},
          {"maximum", largest(seconds)},
          {"all", seconds}};
}

Json run_json(const SolverRun& run, double energy_unit) {
  Json row{{"solver", run.info.name},
           {"exact", run.info.exact},
           {"outside", run.info.outside},
           {"status", status_of(run)}};
  if (!run.refused.empty()) {
    row["message"] = run.refused;
    return row;
  }
  row["value"] = run.result.value;
  row["lower_bound"] = run.result.lower_bound;
  row["gap"] = run.result.value - run.result.lower_bound;
  if (energy_unit > 0) {
    row["energy"] = static_cast<double>(run.result.value) * energy_unit;
    row["energy_lower_bound"] = static_cast<double>(run.result.lower_bound) * energy_unit;
  }
  row["canonical"] = run.result.canonical;
  row["stop"] = run.result.stop;
  row["build_seconds"] = times_json(run.build_seconds);
  row["solve_seconds"] = times_json(run.solve_seconds);
  row["verify_seconds"] = times_json(run.verify_seconds);
  row["bytes"] = run.result.bytes;
  Json counters = Json::object();
  for (const auto& [name, value] : run.result.counters) counters[name] = value;
  row["counters"] = counters;
  return row;
}

// Of the solver's own arrays over the edges of the problem, where the solver tells.
double bytes_per_edge(const std::vector<ComparedInstance>& instances, std::size_t solver) {
  double bytes = 0;
  double edges = 0;
  for (const ComparedInstance& instance : instances) {
    if (!instance.runs[solver].refused.empty()) continue;
    bytes += static_cast<double>(instance.runs[solver].result.bytes);
    edges += static_cast<double>(instance.edges);
  }
  return edges > 0 ? bytes / edges : 0;
}

void add_means(std::string& text, const std::vector<ComparedInstance>& instances) {
  const std::vector<double> solve = relative_means(instances, solve_time);
  const std::vector<double> whole = relative_means(instances, whole_time);
  if (solve.empty()) return;
  text += fmt::format(
      "\ngeometric mean against the fastest, over the instances that all solved\n"
      "  {:<20} {:>8} {:>14} {:>15}\n",
      "solver", "solve", "build + solve", "bytes per edge");
  for (std::size_t s = 0; s < solve.size(); ++s) {
    const double bytes = bytes_per_edge(instances, s);
    text += fmt::format("  {:<20} {:>8.2f} {:>14.2f} {:>15}\n", instances.front().runs[s].info.name,
                        solve[s], whole[s], bytes > 0 ? fmt::format("{:.1f}", bytes) : "not told");
  }
}

}  // namespace

std::string comparison_csv(const std::vector<ComparedInstance>& instances) {
  std::string text =
      "bench_name,file_name,num_nodes,num_term_arcs,num_nbor_arcs,cap_type,term_type,flow_type,"
      "index_type,algorithm,number_of_runs,num_threads,num_blocks,build_time,solve_time,maxflow,"
      "backend,status,lower_bound,build_time_min,build_time_max,solve_time_min,solve_time_max,"
      "verify_time,bytes\n";
  for (const ComparedInstance& instance : instances) {
    for (const SolverRun& run : instance.runs) {
      const std::string name = std::filesystem::path(instance.input).stem().string();
      text += fmt::format("{},{},{},{},{},int64,int64,int64,uint32,{},{},1,1,", quoted(name),
                          quoted(instance.input), instance.nodes, instance.terminal_nodes,
                          instance.edges, run.info.name, run.solve_seconds.size());
      if (run.refused.empty()) {
        text += fmt::format("{:.9g},{:.9g},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{}\n",
                            median(run.build_seconds), solve_time(run), run.result.value,
                            instance.backend, status_of(run), run.result.lower_bound,
                            smallest(run.build_seconds), largest(run.build_seconds),
                            smallest(run.solve_seconds), largest(run.solve_seconds),
                            median(run.verify_seconds), run.result.bytes);
      } else {
        text += fmt::format(",,,{},{},,,,,,,\n", instance.backend, status_of(run));
      }
    }
  }
  return text;
}

Json comparison_json(const std::vector<ComparedInstance>& instances,
                     const std::vector<ComparedBackends>& backends) {
  Json report;
  report["instances"] = Json::array();
  for (const ComparedInstance& instance : instances) {
    Json runs = Json::array();
    for (const SolverRun& run : instance.runs) {
      runs.push_back(run_json(run, instance.energy_unit));
    }
    Json stages = Json::array();
    for (const StageTime& stage : instance.stages) {
      stages.push_back({{"name", stage.name}, {"seconds", stage.seconds}});
    }
    report["instances"].push_back({{"input", instance.input},
                                   {"backend", instance.backend},
                                   {"statistics", statistics_json(instance.statistics)},
                                   {"energy_unit", instance.energy_unit},
                                   {"runs", runs},
                                   {"stages", stages},
                                   {"defect", instance.defect}});
  }
  report["backends"] = Json::array();
  for (const ComparedBackends& pair : backends) {
    report["backends"].push_back(
        {{"input", pair.input},
         {"first", pair.first},
         {"second", pair.second},
         {"energy_difference", pair.energy_difference ? Json(*pair.energy_difference) : Json()},
         {"differing_cells", pair.differing_cells}});
  }
  return report;
}

std::string comparison_table(const std::vector<ComparedInstance>& instances,
                             const std::vector<ComparedBackends>& backends) {
  std::string text;
  for (const ComparedInstance& instance : instances) {
    double fastest = std::numeric_limits<double>::infinity();
    for (const SolverRun& run : instance.runs) {
      if (run.refused.empty()) fastest = std::min(fastest, solve_time(run));
    }
    text +=
        fmt::format("{}: {} nodes, {} edges\n  {:<20} {:>20} {:>9} {:>9} {:>9} {:>9} {:>8}  {}\n",
                    title_of(instance), instance.nodes, instance.edges, "solver", "value",
                    "build s", "solve s", "min", "max", "x best", "status");
    for (const SolverRun& run : instance.runs) {
      if (!run.refused.empty()) {
        text += fmt::format("  {:<20} refused: {}\n", run.info.name, run.refused);
        continue;
      }
      text += fmt::format("  {:<20} {:>20} {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f} {:>8.2f}  {}\n",
                          run.info.name, run.result.value, median(run.build_seconds),
                          solve_time(run), smallest(run.solve_seconds), largest(run.solve_seconds),
                          solve_time(run) / fastest, status_and_stop(run));
    }
    text += instance.defect.empty() ? "" : "  FAILED: " + instance.defect + "\n";
  }
  for (const ComparedBackends& pair : backends) {
    const std::string energy =
        pair.energy_difference ? fmt::format("energy differs by {:.2e}, ", *pair.energy_difference)
                               : std::string();
    text += fmt::format("{}: {} and {}: {}{:.4f} % of the cells differ\n",
                        std::filesystem::path(pair.input).filename().string(), pair.first,
                        pair.second, energy, 100 * pair.differing_cells);
  }
  add_means(text, instances);
  return text;
}

}  // namespace cellocut::tools
