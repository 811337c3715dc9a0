// The connectivity of a closed surface under edge collapses: OpenMesh's half-edges, with the
// corners of every face beside them. Internal to the simplification (it names OpenMesh types).
#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <array>
#include <cstdint>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// What the collapse of a vertex into a neighbour does to the faces around it.
struct Collapse {
  OpenMesh::HalfedgeHandle halfedge;
  std::uint32_t from = 0;                    // the vertex that goes
  std::uint32_t to = 0;                      // the one that takes its place
  std::array<std::uint32_t, 2> vanishing{};  // the faces at their edge
  std::vector<std::uint32_t> changed;        // the other faces at `from`, in their cyclic order
  std::vector<Triangle> after;               // the corners of those, with `to` in place of `from`
};

class CollapseMesh {
 public:
  // O(n). Errors: InputError where the faces are not a closed, oriented 2-manifold by index.
  explicit CollapseMesh(const TriangleSoup& surface);

  // By face; what those that are gone had last stays.
  [[nodiscard]] const std::vector<Triangle>& faces() const { return faces_; }
  [[nodiscard]] std::int64_t face_count() const { return face_count_; }
  [[nodiscard]] bool has_vertex(std::uint32_t v) const;
  [[nodiscard]] bool has_face(std::uint32_t f) const;

  // Calls visit(neighbour, halfedge from v to it) around v.
  template <class Visit>
  void visit_ring(std::uint32_t v, const Visit& visit) const {
    const OpenMesh::HalfedgeHandle start = mesh_.halfedge_handle(handle(v));
    OpenMesh::HalfedgeHandle h = start;
    do {
      visit(static_cast<std::uint32_t>(mesh_.to_vertex_handle(h).idx()), h);
      h = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(h));
    } while (h != start);
  }

  // Whether the collapse along the halfedge keeps the surface a 2-manifold of the same topology:
  // the link condition (Dey, Edelsbrunner, Guha, Nekhayev, "Topology preserving edge contraction",
  // 1999). Not const, for OpenMesh marks vertices.
  [[nodiscard]] bool keeps_topology(OpenMesh::HalfedgeHandle halfedge);

  // Writes what the collapse does into `collapse` (whose memory is reused).
  void describe(OpenMesh::HalfedgeHandle halfedge, Collapse& collapse) const;
  // Precondition: keeps_topology() holds and describe() has just described it.
  void apply(const Collapse& collapse);

 private:
  static OpenMesh::VertexHandle handle(std::uint32_t v) {
    return OpenMesh::VertexHandle(static_cast<int>(v));
  }

  OpenMesh::TriConnectivity mesh_;
  std::vector<Triangle> faces_;
  std::int64_t face_count_ = 0;
};

}  // namespace cellocut
