// Would a collapse take the simplified surface too far from the full one?
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/measure/face_distance.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/surface/collapse_mesh.h"

namespace cellocut {

// Both ways:
// - every removed vertex is kept with the face nearest to it among those that took its place, and
//   has to stay within the bound of one of these (Klein, Liebich, Strasser, "Mesh reduction with
//   error control", 1996): a vertex takes part whenever a face near it changes, O(log(n / m)) times
//   on the way from n faces to m;
// - every face that a collapse makes has to lie within the bound of the full surface.
// The second is all of that direction; of the first, what lies between vertices is left open.
class DistanceTest {
 public:
  DistanceTest(const DistanceTest&) = delete;
  DistanceTest& operator=(const DistanceTest&) = delete;
  // The mesh must outlive this; `bound` in the units of the surface. O(n log n).
  DistanceTest(const TriangleSoup& surface, const CollapseMesh& mesh, double bound);

  // Whether the vertices removed so far at the faces of this collapse, and the one it removes, stay
  // within the bound.
  [[nodiscard]] bool keeps_removed_points(const Collapse& collapse);
  // Whether the faces after it lie within the bound.
  [[nodiscard]] bool keeps_faces(const Collapse& collapse) const;
  // Precondition: keeps_removed_points() was called last for the same collapse.
  void applied(const Collapse& collapse);

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  DistanceTest(const Box3& box, const TriangleSoup& surface, const CollapseMesh& mesh,
               double bound);

  template <class Visit>
  void visit_face(std::uint32_t face, const Visit& visit) const {
    for (std::uint32_t v = first_[face]; v != kNone; v = next_[v]) visit(v);
  }

  TriangleSoup surface_;
  const std::vector<Point3>& points_;
  double bound_;
  NearestTriangle nearest_;
  FaceDistance full_;                 // to the full surface
  std::vector<std::uint32_t> first_;  // by face: a removed vertex near it
  std::vector<std::uint32_t> next_;   // by vertex: another one near the same face
  std::vector<std::uint32_t> moved_;  // the vertices that the last question was about,
  std::vector<std::uint32_t> goal_;   // and which of the faces after it is the nearest to each
};

}  // namespace cellocut
