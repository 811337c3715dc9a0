// Options of `cellocut evaluate --images`, and the networks that they name.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cellocut/image/image_evaluation.h"
#include "tools/view_arguments.h"

namespace CLI {
class App;
}

namespace cellocut::tools {

// A measure that has no values, and why.
struct EmptyColumn {
  std::string measure;  // lpips, fid or clip
  std::string reason;
};

// A network as it was read.
struct NamedNetwork {
  std::string measure;
  std::string path;
  NetworkInput input;
};

struct ImageWork {
  RenderOptions options;
  std::string up;
  std::shared_ptr<const ImageNetworks> networks;
  std::vector<NamedNetwork> read;
  std::vector<EmptyColumn> empty;
};

struct ImageArguments {
  bool images = false;
  ViewArguments view;
  std::string lpips;
  std::string lpips_weights;
  std::string fid;
  std::string clip;

  void add_to(CLI::App& command);
  // Reads the networks. Null where no images are asked for. Errors: UsageError; InputError with the
  // file that is wrong.
  [[nodiscard]] std::shared_ptr<const ImageWork> load() const;
};

}  // namespace cellocut::tools
