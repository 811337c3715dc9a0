// Options of the commands that draw meshes.
#pragma once

#include <string>

#include "cellocut/view/render.h"

namespace CLI {
class App;
}

namespace cellocut::tools {

struct ViewArguments {
  RenderOptions options;
  std::string up = "y";

  // `prefix` before each option's name, as in --image-resolution; empty, or ending in '-'.
  void add_to(CLI::App& command, const std::string& prefix);
  // The options as parsed. Errors: UsageError.
  [[nodiscard]] RenderOptions parsed() const;
};

}  // namespace cellocut::tools
