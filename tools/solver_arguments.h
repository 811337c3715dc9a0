// Options of the commands that run solvers: what is done before, and when a relaxation stops.
#pragma once

#include <CLI/CLI.hpp>

#include "cellocut/cut/cut_solver.h"

namespace cellocut::tools {

inline void add_solver_options(CLI::App& app, bool& reduce, RelaxationOptions& options) {
  app.add_flag(
      "--reduce", reduce,
      "Reduce the problem exactly before it is solved; the report counts what that removed");
  app.add_option("--lp-gap", options.relative_gap,
                 "lp: stop at this relative gap, 0 to below 1; 0: at a proof only")
      ->capture_default_str();
  app.add_option("--lp-time", options.seconds_limit,
                 "lp: stop the iteration after so many seconds; 0: never")
      ->capture_default_str();
  app.add_option("--lp-iterations", options.iteration_limit,
                 "lp: stop after so many iterations, at least 1")
      ->capture_default_str();
}

}  // namespace cellocut::tools
