// What the options of a remesh may be, and what they come to on a given input.
#include <algorithm>
#include <cmath>
#include <string>

#include "cellocut/base/errors.h"
#include "cellocut/pipeline.h"

namespace cellocut {

namespace {

constexpr int kLargestResolution = 16384;

std::string short_decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

void require(bool holds, const char* what) {
  if (!holds) throw UsageError(what);
}

}  // namespace

void RemeshOptions::validate() const {
  require(resolution >= 8 && resolution <= kLargestResolution,
          "--resolution must be between 8 and 16384");
  require(!(epsilon && epsilon_absolute), "give --epsilon or --epsilon-abs, not both");
  require(!epsilon || (*epsilon > 0 && *epsilon <= 1), "--epsilon must be above 0 and at most 1");
  require(!epsilon_absolute || (*epsilon_absolute > 0 && std::isfinite(*epsilon_absolute)),
          "--epsilon-abs must be above 0");
  require(decimation.removed_share >= 0 && decimation.removed_share <= 0.99,
          "--decimate must be between 0 and 0.99");
  require(area_bits >= 8 && area_bits <= 50, "--area-bits must be between 8 and 50");
  require(surface != SurfaceMode::union_ || (thickening && unary),
          "--no-thickening and --no-unary need --surface sdf or cells");
  require(!lambda_auto || (thickening && unary),
          "--lambda-fill auto needs the slab and the anchored cells: no --no-thickening, no "
          "--no-unary");
  require(surface != SurfaceMode::cells || !pulls(), "--surface cells cannot be pulled");
  require(thickening || !pulls(), "--no-thickening leaves nothing to be pulled back");
  require(surface != SurfaceMode::cells || !fair, "--surface cells cannot be faired");
  require(!pull_distance || pulls(), "--pull-distance needs --pull");
  require(!pull_distance || (*pull_distance > 0 && *pull_distance <= 1),
          "--pull-distance must be above 0 and at most 1");
  require(faces == 0 || faces >= 4, "--faces must be at least 4");
  require(max_error >= 0 && max_error <= 1, "--max-error must be between 0 and 1");
  require(surface != SurfaceMode::cells || !simplifies(),
          "--surface cells cannot be simplified: its parts may touch");
  require(memory_limit >= 0, "--memory must not be negative");
  require(min_component >= 0 && min_component <= 1, "--min-component must be between 0 and 1");
}

DerivedParameters derive_parameters(const TriangleSoup& input, const RemeshOptions& options) {
  if (input.empty()) throw InputError("the mesh has no faces");
  const double unit = bounding_box(input).longest_edge();
  if (!(unit > 0) || !std::isfinite(unit)) {
    throw InputError("the mesh has no extent: all its points are the same, or too far apart");
  }
  if (unit < 1e-100 || unit > 1e100) {
    throw InputError("the mesh is " + short_decimal(unit) +
                     " long, and squared lengths would leave the range of a double; scale it");
  }
  DerivedParameters derived;
  const double step = 1.0 / options.resolution;
  derived.epsilon = options.epsilon            ? *options.epsilon
                    : options.epsilon_absolute ? *options.epsilon_absolute / unit
                                               : std::max(1.0 / 512, step);
  require(derived.epsilon <= 1, "--epsilon-abs must be at most the longest edge of the box");
  if (!options.thickening) derived.epsilon = 0;
  if (options.thickening && 2 * derived.epsilon < step) {
    const double usable = std::ceil(0.5 / derived.epsilon);
    const std::string finer =
        usable <= kLargestResolution
            ? "--resolution " + std::to_string(static_cast<int>(usable)) + " or more, or "
            : std::string();
    throw UsageError("epsilon " + short_decimal(derived.epsilon) +
                     " is below half a grid step, so that sheets perforate; use " + finer +
                     "--epsilon " + short_decimal(0.5 * step) + " or more");
  }
  derived.epsilon_steps = derived.epsilon * options.resolution;
  derived.epsilon_below_step = options.thickening && derived.epsilon < step;
  if (!options.lambda_auto) derived.lambda_fill = options.lambda_fill;
  derived.pull_distance = options.pull_distance.value_or(std::min(step, derived.epsilon) / 40);
  if (options.pulls() && derived.pull_distance > derived.epsilon) {
    throw UsageError("--pull-distance must be at most epsilon, here " +
                     short_decimal(derived.epsilon));
  }
  return derived;
}

}  // namespace cellocut
