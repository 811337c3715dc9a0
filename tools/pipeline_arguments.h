// The options of the pipeline up to the cut, for every subcommand that runs it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cellocut/pipeline.h"

namespace CLI {
class App;
}

namespace cellocut::tools {

// What --lambda-fill takes, and with it what else makes sense.
enum class LambdaOption {
  none,  // all weights at once: no such option, no ablations
  number,
  number_or_auto
};

struct PipelineArguments {
  RemeshOptions options;
  std::string lambda = "20";
  std::optional<double> memory;  // bytes
  std::string decimation = "clusters";
  std::string support = "labels";
  std::string exterior = "unbounded";
  std::vector<std::string> inside;  // points, or files of them
  std::vector<std::string> outside;
  bool no_thickening = false;
  bool no_unary = false;

  void add_to(CLI::App& app, LambdaOption lambda_option);
  // Turns the texts into options, and reads files of points. Errors: UsageError that names the
  // option; InputError for a file that cannot be read, or with the number of a line that is no
  // point.
  void complete();
};

}  // namespace cellocut::tools
