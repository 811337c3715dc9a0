// Which faces of a triangle mesh take part in a defect: for looking at it.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// One value for each face, 1 or 0; the terms of surface_report.h. Edges are those after points with
// equal coordinates are merged.
struct FaceDefects {
  std::vector<std::uint8_t> boundary;      // an edge without a second face
  std::vector<std::uint8_t> nonmanifold;   // an edge with more than two faces
  std::vector<std::uint8_t> degenerate;    // no area, or a corner that is not finite
  std::vector<std::uint8_t> intersecting;  // a pair of faces that intersect
  // The gravest of them, or 0: 1 boundary, 2 non-manifold, 3 degenerate, 4 intersecting.
  [[nodiscard]] std::vector<std::uint8_t> gravest() const;
};

// O(n log n + intersecting pairs), with memory for all of these. Errors: as inspect_surface().
FaceDefects find_face_defects(const TriangleSoup& mesh, Observer& observer = silent_observer());

}  // namespace cellocut
