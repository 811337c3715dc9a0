// What a collapse costs: quadric error metrics.
#pragma once

#include <OpenMesh/Core/Geometry/VectorT.hh>
#include <OpenMesh/Core/Utils/vector_traits.hh>
// Needs those above.
#include <OpenMesh/Core/Geometry/QuadricT.hh>
#include <cstdint>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Sums of squared distances to the planes of faces, weighted by area (Garland, Heckbert, "Surface
// simplification using quadric error metrics", 1997), by OpenMesh's QuadricT. A vertex has those of
// its faces and of the faces of all vertices that went into it, so a sharp edge is expensive to
// leave. A very small weight on the squared distance to these vertices themselves decides where
// planes leave it open: in flat regions faces stay compact and do not become fans of slivers.
//
// In units of the surface's box, about its centre: costs do not depend on scale and offset.
class VertexQuadrics {
 public:
  // O(n). Preconditions: finite, not empty.
  explicit VertexQuadrics(const TriangleSoup& surface);

  // The cost of moving `from` to where `to` is, with all that has gone into both.
  [[nodiscard]] double cost(std::uint32_t from, std::uint32_t to) const;

  // `from` has gone into `to`.
  void merge(std::uint32_t from, std::uint32_t to);

 private:
  using Point = OpenMesh::Vec3d;
  [[nodiscard]] Point at(std::uint32_t v) const;

  const std::vector<Point3>& points_;
  Point3 centre_{};
  double unit_ = 1;
  std::vector<OpenMesh::Geometry::Quadricd> quadric_;
  std::vector<double> own_cost_;  // of each vertex where it is
};

}  // namespace cellocut
