#include "tools/pipeline_arguments.h"

#include <CLI/CLI.hpp>

namespace cellocut::tools {

void PipelineArguments::add_to(CLI::App& app, bool with_lambda) {
  app.add_option("-R,--resolution", options.resolution,
                 "Grid steps along the longest edge of the box, 8 to 16384")
      ->capture_default_str();
  auto* epsilon =
      app.add_option("--epsilon", options.epsilon,
                     "Thickening offset relative to the longest edge (default: max(1/512, "
                     "1/resolution))");
  app.add_option("--epsilon-abs", options.epsilon_absolute, "Thickening offset in input units")
      ->excludes(epsilon);
  app.add_option("--decimate", options.decimate, "Share of the proxy's faces to remove, 0 to 0.99")
      ->capture_default_str();
  if (with_lambda) {
    app.add_option("--lambda-fill", lambda,
                   "Weight of an unsupported interface: a number or p/q, terms up to 2^20; auto: "
                   "chosen so that most of the input has the solid on one side alone")
        ->capture_default_str();
  }
  app.add_option("--exterior", exterior,
                 "What is fixed exterior: the unbounded region, or every hull cell that is not "
                 "initially interior")
      ->check(CLI::IsMember({"unbounded", "hull-cells"}))
      ->capture_default_str();
  app.add_option("--area-bits", options.area_bits,
                 "Facet areas sum to at most 2^bits quanta, 8 to 50")
      ->capture_default_str();
  app.add_flag("--no-thickening", no_thickening,
               "Ablation: phi is the flood-signed distance, no offset");
  app.add_flag("--no-unary", no_unary, "Ablation: no cell is anchored interior");
}

void PipelineArguments::complete() {
  options.lambda_auto = lambda == "auto";
  try {
    if (!options.lambda_auto) options.lambda_fill = parse_rational(lambda);
  } catch (const UsageError& error) {
    throw UsageError(std::string("--lambda-fill: ") + error.what());
  }
  options.exterior = exterior == "unbounded" ? ExteriorMode::unbounded : ExteriorMode::hull_cells;
  options.thickening = !no_thickening;
  options.unary = !no_unary;
}

}  // namespace cellocut::tools
