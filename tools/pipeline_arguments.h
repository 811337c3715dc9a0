// The options of the pipeline up to the cut, for every subcommand that runs it.
#pragma once

#include <string>

#include "cellocut/pipeline.h"

namespace CLI {
class App;
}

namespace cellocut::tools {

struct PipelineArguments {
  RemeshOptions options;
  std::string lambda = "20";
  std::string exterior = "unbounded";
  bool no_thickening = false;
  bool no_unary = false;

  // Without --lambda-fill where all are asked for.
  void add_to(CLI::App& app, bool with_lambda = true);
  // Turns the texts into options. Errors: UsageError that names the option.
  void complete();
};

}  // namespace cellocut::tools
