// Points that no face uses.
#pragma once

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// The points that faces use, in their order, and the faces renumbered. O(points + faces).
TriangleSoup drop_unused_points(const std::vector<Point3>& points,
                                const std::vector<Triangle>& triangles);

}  // namespace cellocut
