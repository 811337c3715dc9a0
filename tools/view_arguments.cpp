#include "tools/view_arguments.h"

#include <CLI/CLI.hpp>

#include "cellocut/base/errors.h"

namespace cellocut::tools {

void ViewArguments::add_to(CLI::App& command, const std::string& prefix) {
  command
      .add_option("--" + prefix + "resolution", options.resolution,
                  "Pixels of either edge of a picture, 16 to 4096")
      ->capture_default_str();
  command
      .add_option("--" + prefix + "perspective", options.perspective,
                  "Angle of view in degrees, 1 to 120; 0: orthographic")
      ->capture_default_str();
  command
      .add_option("--" + prefix + "up", up, "Axis of the mesh that points up in the pictures: y, z")
      ->capture_default_str();
  command
      .add_option("--" + prefix + "antialiasing", options.antialiasing,
                  "Squared: samples in a pixel of a clay picture, 1 to 8")
      ->capture_default_str();
}

RenderOptions ViewArguments::parsed() const {
  RenderOptions result = options;
  if (up != "y" && up != "z") throw UsageError("'" + up + "': the axis that points up is y or z");
  result.up = up == "y" ? UpAxis::y : UpAxis::z;
  result.validate();
  return result;
}

}  // namespace cellocut::tools
