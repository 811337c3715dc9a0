// Which triangles does a line along an axis pass through? Exact, and the same from both sides of an
// edge.
#pragma once

#include "cellocut/base/predicates.h"

namespace cellocut {

// A point as seen along the line.
struct Flat {
  double y;
  double z;
};

// Whether the ray from p towards +z (in the plane) crosses the edge (a, b). The half-open rule in y
// counts an edge end once; an edge is judged the same from every face at it, since the answer is
// exact and depends only on the two end points as a set. So over a closed surface the answers
// cancel to an even number, whatever is degenerate.
inline bool ray_crosses(const Flat& a, const Flat& b, const Flat& p) {
  const bool a_right = a.y > p.y;
  const bool b_right = b.y > p.y;
  if (a_right == b_right) return false;
  const Flat& left = a_right ? b : a;
  const Flat& right = a_right ? a : b;
  return turn(left.y, left.z, right.y, right.z, p.y, p.z) < 0;
}

// Whether the line through p passes through the triangle. Triangles that share an edge leave no
// line between them and claim none twice; one that is a segment as seen along the line is never
// passed through.
inline bool line_passes(const Flat& a, const Flat& b, const Flat& c, const Flat& p) {
  return ray_crosses(a, b, p) ^ ray_crosses(b, c, p) ^ ray_crosses(c, a, p);
}

}  // namespace cellocut
