// What `cellocut compare` measures, and its tables.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cellocut/cut/problem_statistics.h"
#include "cellocut/pipeline.h"
#include "solvers/comparison.h"

namespace cellocut::tools {

// One problem, as all solvers saw it.
struct ComparedInstance {
  std::string input;    // the path
  std::string backend;  // empty for a problem file
  std::size_t nodes = 0;
  std::size_t edges = 0;
  std::size_t terminal_nodes = 0;  // with a source or a sink arc that has capacity
  ProblemStatistics statistics;
  std::vector<solvers::SolverRun> runs;
  std::string defect;  // disagreement or a failed certificate; empty where all is well
  // Of a mesh, up to the problem, and the certificates of all solvers together.
  std::vector<StageTime> stages;
  double energy_unit =
      0;  // squared input units that one unit of the value is; 0 for a problem file
};

// Between two backends on one mesh.
struct ComparedBackends {
  std::string input;
  std::string first;
  std::string second;
  std::optional<double> energy_difference;  // relative; none where one of them has no exact cut
  double differing_cells = 0;               // share
};

// The columns of the max-flow benchmark collection of Jensen et al. 2022, then ours. Times are
// medians in seconds over the repeats, reading outside of them.
std::string comparison_csv(const std::vector<ComparedInstance>& instances);

nlohmann::ordered_json comparison_json(const std::vector<ComparedInstance>& instances,
                                       const std::vector<ComparedBackends>& backends);

// A table to read: per instance its solvers, and the geometric mean of solve time and of build and
// solve time against the fastest over all instances that every solver of the mean solved.
std::string comparison_table(const std::vector<ComparedInstance>& instances,
                             const std::vector<ComparedBackends>& backends);

}  // namespace cellocut::tools
