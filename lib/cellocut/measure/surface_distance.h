// The Hausdorff distance of two surfaces, between proven bounds.
#pragma once

#include <algorithm>

#include "cellocut/base/observer.h"
#include "cellocut/measure/face_distance.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// In the units of the surfaces.
struct SurfaceDistance {
  DirectedDistance forward;   // from the first surface to the second
  DirectedDistance backward;  // from the second to the first
  // The two-sided distance.
  [[nodiscard]] double lower() const { return std::max(forward.lower, backward.lower); }
  [[nodiscard]] double upper() const { return std::max(forward.upper, backward.upper); }
};

// Branch and bound over the faces of each surface (face_distance.h). What two surfaces have in
// common costs no more than the overlay of its faces has parts, even where the distance is 0.
//
// upper() <= (1 + tolerance) lower(), or upper() is below 1e-9 of the longest edge of the box of
// both. Of each direction alone the same holds only if it is the larger one: bounds below the other
// direction's are not made tight.
//
// Parallel; the same bits for any number of threads. O((n + m) log(n + m)) where the surfaces are
// close to each other.
// Preconditions: finite coordinates; tolerance > 0. Errors: UsageError where a surface is empty or
// the tolerance is not positive; Cancelled.
SurfaceDistance measure_surface_distance(const TriangleSoup& first, const TriangleSoup& second,
                                         double tolerance, Observer& observer);

}  // namespace cellocut
