// How far is what a simplification has removed from what it left? Judged at the vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/surface/collapse_mesh.h"

namespace cellocut {

// Keeps every removed vertex with the face nearest to it among those that took its place, and
// refuses collapses that would leave one too far from all of these (Klein, Liebich, Strasser, "Mesh
// reduction with error control", 1996). That bounds the distance from the vertices of the full
// surface to the simplified one; between vertices, and the other way, it is an estimate.
// A vertex takes part whenever a face near it changes: O(log(n / m)) times on the way from n faces
// to m.
class RemovedPoints {
 public:
  // `points` and `mesh` must outlive this; `bound` in the units of the points.
  RemovedPoints(const std::vector<Point3>& points, const CollapseMesh& mesh, double bound);

  // Whether every vertex removed so far at the faces of this collapse, and the one it removes,
  // stays within the bound.
  [[nodiscard]] bool allows(const Collapse& collapse);
  // Precondition: allows() was the last call, for the same collapse.
  void applied(const Collapse& collapse);

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  template <class Visit>
  void visit_face(std::uint32_t face, const Visit& visit) const {
    for (std::uint32_t v = first_[face]; v != kNone; v = next_[v]) visit(v);
  }

  const std::vector<Point3>& points_;
  double squared_bound_;
  std::vector<std::uint32_t> first_;  // by face: a removed vertex near it
  std::vector<std::uint32_t> next_;   // by vertex: another one near the same face
  std::vector<std::uint32_t> moved_;  // the vertices that the last question was about,
  std::vector<std::uint32_t> goal_;   // and which of the faces after it is the nearest to each
};

}  // namespace cellocut
