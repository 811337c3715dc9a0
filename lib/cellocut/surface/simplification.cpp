#include "cellocut/surface/simplification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cellocut/measure/surface_distance.h"
#include "cellocut/surface/edge_collapser.h"

namespace cellocut {

namespace {

constexpr double kErrorTolerance = 0.01;  // between the bounds of the error
constexpr double kFirstBound = 0.97;      // of the error allowed: room for that tolerance
constexpr double kTighten = 0.9;          // below what the last error suggests
constexpr int kMostAttempts = 6;

Simplification unchanged(const TriangleSoup& surface) {
  Simplification result;
  result.surface = surface;
  result.source.resize(surface.points.size());
  std::iota(result.source.begin(), result.source.end(), 0U);
  return result;
}

Simplification attempt(const TriangleSoup& surface, std::int64_t target, double bound,
                       Observer& observer) {
  Simplification result;
  {
    EdgeCollapser collapser(surface, bound, observer);
    collapser.run(target);
    result.counts = collapser.counts();
    result.surface = collapser.surface(result.source);
  }
  const SurfaceDistance distance =
      measure_surface_distance(surface, result.surface, kErrorTolerance, observer);
  result.error = distance.upper();
  result.error_lower = distance.lower();
  return result;
}

}  // namespace

void SimplificationOptions::validate() const {
  if (faces < 0) throw UsageError("the number of faces to simplify to must not be negative");
  if (!(max_error >= 0) || !std::isfinite(max_error)) {
    throw UsageError("the error of a simplification must be a finite length, not negative");
  }
}

Simplification simplify_surface(const TriangleSoup& surface, const SimplificationOptions& options,
                                Observer& observer) {
  options.validate();
  if (surface.empty() || (options.faces == 0 && options.max_error == 0)) return unchanged(surface);

  Simplification result;
  double bound = kFirstBound * options.max_error;
  for (int n = 1;; ++n) {
    result = attempt(surface, options.faces, bound, observer);
    result.attempts = n;
    if (options.max_error == 0 || result.error <= options.max_error) break;
    if (n == kMostAttempts) {
      result = unchanged(surface);
      result.attempts = n;
      result.reached = false;
      result.stop = fmt::format(
          "{} attempts did not keep to the error allowed, {}: the surface is left as it is", n,
          options.max_error);
      break;
    }
    bound *= kTighten * options.max_error / result.error;
  }
  observer.progress(1);

  const auto left = static_cast<std::int64_t>(result.surface.triangles.size());
  if (options.faces > 0 && left > options.faces && result.reached) {
    result.reached = false;
    result.stop = fmt::format(
        "{} faces are left of {}, {} were asked for: every further collapse would change the "
        "topology, fold the surface, make slivers, degenerate or intersecting faces{}",
        left, surface.triangles.size(), options.faces,
        options.max_error > 0 ? ", or exceed the error allowed" : "");
  }
  return result;
}

}  // namespace cellocut
