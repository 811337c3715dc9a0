// Connected components of a closed surface.
#pragma once

#include <cstdint>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Removes the components whose |volume| is below `share` of the sum of all signed volumes, with
// their points; the largest stays, whatever its share. What lies inside a dropped component is
// smaller still, so nothing is left hanging in a void. Returns how many were dropped; 0 share drops
// none. O(n).
std::int64_t drop_small_components(TriangleSoup& surface, double share);

}  // namespace cellocut
