// Options of the commands that run a relaxation: when it stops.
#pragma once

#include <CLI/CLI.hpp>

#include "cellocut/cut/cut_solver.h"

namespace cellocut::tools {

inline void add_relaxation_options(CLI::App& app, RelaxationOptions& options) {
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
