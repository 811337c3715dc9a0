#include "cellocut/mesh/triangle_soup.h"

#include <algorithm>

namespace cellocut {

Box3 bounding_box(const TriangleSoup& soup) {
  Box3 box{soup.points[soup.triangles.front()[0]], soup.points[soup.triangles.front()[0]]};
  for (const Triangle& triangle : soup.triangles) {
    for (const std::uint32_t v : triangle) {
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], soup.points[v][axis]);
        box.high[axis] = std::max(box.high[axis], soup.points[v][axis]);
      }
    }
  }
  return box;
}

}  // namespace cellocut
