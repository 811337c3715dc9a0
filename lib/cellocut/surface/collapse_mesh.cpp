#include "cellocut/surface/collapse_mesh.h"

#include "cellocut/base/errors.h"

namespace cellocut {

CollapseMesh::CollapseMesh(const TriangleSoup& surface)
    : faces_(surface.triangles), face_count_(static_cast<std::int64_t>(faces_.size())) {
  const auto refuse = [] {
    throw InputError("a surface to simplify has to be a closed, oriented 2-manifold");
  };
  mesh_.request_vertex_status();
  mesh_.request_halfedge_status();
  mesh_.request_edge_status();
  mesh_.request_face_status();
  mesh_.reserve(surface.points.size(), faces_.size() / 2 * 3, faces_.size());
  for (std::size_t v = 0; v < surface.points.size(); ++v) mesh_.add_vertex();
  for (const Triangle& t : faces_) {
    // OpenMesh itself neither refuses these nor closed vertices with a second fan quietly.
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) refuse();
    for (int k = 0; k < 3; ++k) {
      const OpenMesh::VertexHandle v = handle(t[k]);
      if (!mesh_.is_boundary(v)) refuse();
      const OpenMesh::HalfedgeHandle h = mesh_.find_halfedge(v, handle(t[(k + 1) % 3]));
      if (h.is_valid() && !mesh_.is_boundary(h)) refuse();
    }
    if (!mesh_.add_face(handle(t[0]), handle(t[1]), handle(t[2])).is_valid()) refuse();
  }
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const OpenMesh::VertexHandle vertex = handle(static_cast<std::uint32_t>(v));
    if (mesh_.is_isolated(vertex)) {
      mesh_.status(vertex).set_deleted(true);
    } else if (mesh_.is_boundary(vertex)) {
      refuse();
    }
  }
}

bool CollapseMesh::has_vertex(std::uint32_t v) const { return !mesh_.status(handle(v)).deleted(); }

bool CollapseMesh::has_face(std::uint32_t f) const {
  return !mesh_.status(OpenMesh::FaceHandle(static_cast<int>(f))).deleted();
}

bool CollapseMesh::keeps_topology(OpenMesh::HalfedgeHandle halfedge) {
  // OpenMesh compares the neighbours of the two ends. On a tetrahedron these pass, but it would be
  // left as two faces back to back: the links have the opposite edge in common.
  const auto has_three_faces = [this](OpenMesh::VertexHandle v) { return mesh_.valence(v) == 3; };
  if (has_three_faces(mesh_.from_vertex_handle(halfedge)) &&
      has_three_faces(mesh_.to_vertex_handle(halfedge))) {
    return false;
  }
  return mesh_.is_collapse_ok(halfedge);
}

void CollapseMesh::describe(OpenMesh::HalfedgeHandle halfedge, Collapse& collapse) const {
  const auto face_at = [this](OpenMesh::HalfedgeHandle h) {
    return static_cast<std::uint32_t>(mesh_.face_handle(h).idx());
  };
  collapse.halfedge = halfedge;
  collapse.from = static_cast<std::uint32_t>(mesh_.from_vertex_handle(halfedge).idx());
  collapse.to = static_cast<std::uint32_t>(mesh_.to_vertex_handle(halfedge).idx());
  collapse.vanishing = {face_at(halfedge), face_at(mesh_.opposite_halfedge_handle(halfedge))};
  collapse.changed.clear();
  collapse.after.clear();
  OpenMesh::HalfedgeHandle h = halfedge;
  for (;;) {
    // The next face around `from`; the last one is behind the edge again.
    h = mesh_.opposite_halfedge_handle(mesh_.prev_halfedge_handle(h));
    const std::uint32_t face = face_at(h);
    if (face == collapse.vanishing[1]) break;
    collapse.changed.push_back(face);
    Triangle corners = faces_[face];
    for (std::uint32_t& v : corners) {
      if (v == collapse.from) v = collapse.to;
    }
    collapse.after.push_back(corners);
  }
}

void CollapseMesh::apply(const Collapse& collapse) {
  mesh_.collapse(collapse.halfedge);
  for (std::size_t i = 0; i < collapse.changed.size(); ++i) {
    faces_[collapse.changed[i]] = collapse.after[i];
  }
  face_count_ -= 2;
}

}  // namespace cellocut
