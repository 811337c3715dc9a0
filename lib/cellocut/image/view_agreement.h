// How alike two views are that one camera took: outline, depth, normals.
#pragma once

#include <optional>

#include "cellocut/view/render.h"

namespace cellocut {

// Of all of these: precondition: both views have the same resolution. O(pixels).

// The pixels that both cover over the pixels that either covers, 0 to 1. Nothing where neither
// covers any.
std::optional<double> silhouette_iou(const View& a, const View& b);

// The mean absolute difference of depth over the pixels that both cover, in the frame's unit (the
// longest edge of the reference). Nothing where there are none.
std::optional<double> depth_error(const View& a, const View& b);

// The mean angle between the normals over the pixels that both cover, in degrees. Normals are
// turned to the side that is seen, so the order of corners does not count. Nothing where there are
// none.
std::optional<double> normal_error(const View& a, const View& b);

}  // namespace cellocut
