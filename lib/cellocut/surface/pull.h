// `--pull`: takes the dilation by eps back where the surface follows the input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cellocut/base/coordinates.h"
#include "cellocut/base/observer.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct Quantiles {
  double median = 0;
  double p95 = 0;
  double largest = 0;
};
// By rank, the lower of two in the middle. All 0 where there are no values. Reorders them. O(n).
Quantiles quantiles_of(std::span<double> values);

struct PullReport {
  double distance = 0;  // asked for, in input units
  std::int64_t vertices = 0;
  std::int64_t supported = 0;
  std::int64_t shifted = 0;             // of the supported: slid into a concave crease
  std::int64_t stopped_early = 0;       // of the supported: moved, but less than asked
  std::int64_t went_back = 0;           // of the supported: not moved in the end
  std::int64_t bad_faces_at_first = 0;  // that were degenerate or intersected before the retreat
  int rounds = 0;
  Quantiles offset;  // distance of supported vertices from the input afterwards, input units
};

// Moves every supported vertex of `surface` (input units) towards its nearest point on the input
// until `distance` is left; those nearer than that stay. Each side of a sheet keeps to its own side
// of it, as no vertex passes its nearest point (but by rounding, where floats are so coarse).
// Vertices at concave creases of the input slide further, towards the bottom of the crease
// (crease_slide.h). Vertices retreat (retreat.h) where the surface would not stay valid. `expected`
// is how far supported vertices are from the input, about (the search begins there). Vertices stop
// at `coordinates` alone. Precondition: the surface is valid, and its points are such. O(n log n).
// Errors: Cancelled, and then the surface has lost its points.
PullReport pull_to_input(TriangleSoup& surface, const std::vector<std::uint8_t>& supported,
                         const NearestTriangle& input, double expected, double distance,
                         Observer& observer, Coordinates coordinates = Coordinates::doubles);

}  // namespace cellocut
