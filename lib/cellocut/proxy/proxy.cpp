#include "cellocut/proxy/proxy.h"

#include "cellocut/proxy/decimation.h"
#include "cellocut/proxy/refinement.h"

namespace cellocut {

namespace {

// The points that faces use, in their order, and the faces renumbered.
TriangleSoup drop_unused_points(const std::vector<Point3>& points,
                                const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> number(points.size(), 0);
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) number[v] = 1;
  }
  TriangleSoup compact;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (number[i] == 0) continue;
    number[i] = static_cast<std::uint32_t>(compact.points.size());
    compact.points.push_back(points[i]);
  }
  compact.triangles.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    compact.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  return compact;
}

}  // namespace

Proxy make_proxy(const TriangleSoup& surface, const SparseField& phi, const Frame& frame,
                 double removed_share, Observer& observer) {
  Proxy proxy;
  proxy.faces_before = static_cast<std::int64_t>(surface.triangles.size());
  if (surface.empty()) return proxy;
  const Refinement refined = refine_to_surface(
      surface, decimate(surface, removed_share, kProxyTolerance), phi, kProxyTolerance, observer);
  proxy.largest_distance = refined.largest_distance;
  proxy.faces_restored = refined.faces_restored;
  proxy.mesh = drop_unused_points(surface.points, refined.faces);
  for (Point3& p : proxy.mesh.points) p = frame.to_input(p);
  proxy.removed_share = 1 - static_cast<double>(proxy.mesh.triangles.size()) /
                                static_cast<double>(proxy.faces_before);
  return proxy;
}

}  // namespace cellocut
