#include "cellocut/proxy/proxy.h"

#include <tbb/parallel_for.h>

#include <bit>

#include "cellocut/base/random_stream.h"
#include "cellocut/mesh/unused_points.h"
#include "cellocut/proxy/clustering.h"
#include "cellocut/proxy/edge_collapses.h"
#include "cellocut/proxy/refinement.h"

namespace cellocut {

namespace {

Point3 break_ties(const Point3& p) {
  std::uint64_t hash = 0;
  for (const double x : p) {
    hash = mix_bits(hash + 0x9E3779B97F4A7C15U + std::bit_cast<std::uint64_t>(x));
  }
  Point3 moved = p;
  for (double& x : moved) {
    hash = mix_bits(hash + 0x9E3779B97F4A7C15U);
    x += kTieBreak * (static_cast<double>(hash >> 11) * 0x1p-52 - 1);  // a share in [-1, 1)
  }
  return moved;
}

Refinement decimate(const TriangleSoup& surface, const Decimation& decimation,
                    const SparseField& phi, Observer& observer) {
  const auto& [removed_share, method] = decimation;
  if (removed_share > 0 && method == DecimationMethod::clusters) {
    return cluster_vertices(surface, removed_share, phi, kProxyTolerance, observer);
  }
  return refine_to_surface(surface, collapse_edges(surface, removed_share, kProxyTolerance), phi,
                           kProxyTolerance, observer);
}

}  // namespace

Proxy make_proxy(TriangleSoup surface, const SparseField& phi, const Frame& frame,
                 const Decimation& decimation, Observer& observer) {
  Proxy proxy;
  proxy.faces_before = static_cast<std::int64_t>(surface.triangles.size());
  if (surface.empty()) return proxy;
  tbb::parallel_for(std::size_t{0}, surface.points.size(),
                    [&](std::size_t i) { surface.points[i] = break_ties(surface.points[i]); });
  const Refinement refined = decimate(surface, decimation, phi, observer);
  proxy.largest_distance = refined.largest_distance;
  proxy.faces_restored = refined.faces_restored;
  proxy.mesh = drop_unused_points(surface.points, refined.faces);
  for (Point3& p : proxy.mesh.points) p = frame.to_input(p);
  proxy.removed_share = 1 - static_cast<double>(proxy.mesh.triangles.size()) /
                                static_cast<double>(proxy.faces_before);
  return proxy;
}

}  // namespace cellocut
