// The Hausdorff distance of two surfaces, between proven bounds.
#pragma once

#include <algorithm>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// The largest distance from a point of one surface to the other surface, in their units: at least
// `lower` (a point at that distance has been found) and at most `upper`, up to the rounding of
// doubles in evaluating them (some 1e-15 of the coordinates).
struct DirectedDistance {
  double lower = 0;
  double upper = 0;
};

struct SurfaceDistance {
  DirectedDistance forward;   // from the first surface to the second
  DirectedDistance backward;  // from the second to the first
  // The two-sided distance.
  [[nodiscard]] double lower() const { return std::max(forward.lower, backward.lower); }
  [[nodiscard]] double upper() const { return std::max(forward.upper, backward.upper); }
};

// Branch and bound over the faces of each surface. A part P of a face (a convex polygon) needs no
// further look where the distance to the other surface is known to stay below what has been found
// elsewhere, by one of
// - the distance is 1-Lipschitz: it is at most that of a point of P plus the radius of P about it;
// - the distance to one triangle F is convex: on P it is at most its maximum over the corners of P,
//   for the F that is nearest to some point of P.
// (Tang, Lee, Kim, "Interactive Hausdorff distance computation for general polygonal models",
// 2009.) Else P is cut by the planes through the sides of F, perpendicular to F, or halved where
// these leave it whole. So also two surfaces that coincide in large faces here and in many small
// ones there cost no more than the overlay of the two has parts.
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
