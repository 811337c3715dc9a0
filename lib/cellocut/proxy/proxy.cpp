#include "cellocut/proxy/proxy.h"

#include <meshoptimizer.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>
#include <unordered_set>

#include "cellocut/field/sparse_grid.h"

namespace cellocut {

namespace {

constexpr double kRaster = 0.5;  // grid steps between samples on a face

// Errors that decimation may make, in grid steps: of the whole surface, and of the places where
// that went too far, and again. The simplifier's error is an average, so none is a bound; what the
// last one leaves wrong is kept as it was.
constexpr double kErrors[] = {kProxyTolerance, 0.5 * kProxyTolerance, 0.2 * kProxyTolerance};

// Quadric edge collapse onto existing vertices (meshoptimizer): `faces` of `positions`, fewer of
// them.
std::vector<Triangle> decimate(const std::vector<float>& positions,
                               const std::vector<Triangle>& faces, double removed_share,
                               double error) {
  std::vector<unsigned int> indices;
  indices.reserve(3 * faces.size());
  for (const Triangle& t : faces) indices.insert(indices.end(), t.begin(), t.end());
  const double kept = (1 - removed_share) * static_cast<double>(faces.size());
  const std::size_t target = 3 * static_cast<std::size_t>(std::ceil(kept));
  const std::size_t points = positions.size() / 3;
  const float scale = meshopt_simplifyScale(positions.data(), points, 12);
  std::vector<unsigned int> result(indices.size());
  result.resize(meshopt_simplify(result.data(), indices.data(), indices.size(), positions.data(),
                                 points, 12, target, static_cast<float>(error) / scale, 0,
                                 nullptr));
  std::vector<Triangle> triangles(result.size() / 3);
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    triangles[f] = {result[3 * f], result[3 * f + 1], result[3 * f + 2]};
  }
  return triangles;
}

// The points that `faces` use, alone, and the faces renumbered; `origin` says which they were.
struct Patch {
  std::vector<float> positions;
  std::vector<Triangle> faces;
  std::vector<std::uint32_t> origin;
};

Patch cut_out(const TriangleSoup& surface, const std::vector<Triangle>& faces) {
  Patch patch;
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  for (const Triangle& t : faces) {
    Triangle renumbered{};
    for (int k = 0; k < 3; ++k) {
      const auto [entry, fresh] =
          number.try_emplace(t[k], static_cast<std::uint32_t>(patch.origin.size()));
      renumbered[k] = entry->second;
      if (!fresh) continue;
      patch.origin.push_back(t[k]);
      for (const double x : surface.points[t[k]]) {
        patch.positions.push_back(static_cast<float>(x));
      }
    }
    patch.faces.push_back(renumbered);
  }
  return patch;
}

// Visits a raster of points on the triangle, corners and edges included, at most `spacing` apart.
template <class Visit>
void for_each_raster_point(const std::vector<Point3>& points, const Triangle& face, double spacing,
                           const Visit& visit) {
  const Point3& a = points[face[0]];
  const Point3 u = points[face[1]] - a;
  const Point3 v = points[face[2]] - a;
  const double longest = std::max({norm(u), norm(v), norm(u - v)});
  const int steps = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      visit((a + (static_cast<double>(i) / steps) * u) + (static_cast<double>(j) / steps) * v);
    }
  }
}

std::vector<double> measure_all(const TriangleSoup& surface, const std::vector<Triangle>& faces,
                                const SparseField& phi) {
  std::vector<double> largest(faces.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 256),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      FieldSampler sampler(phi);
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        for_each_raster_point(
                            surface.points, faces[i], kRaster, [&](const Point3& p) {
                              largest[i] = std::max(largest[i], std::fabs(sampler(p)));
                            });
                      }
                    });
  return largest;
}

// A set of grid cells.
class CellSet {
 public:
  // Adds the cell of p and those around it.
  void add_around(const Point3& p) {
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          cells_.insert(key(static_cast<int>(p[0]) + dx, static_cast<int>(p[1]) + dy,
                            static_cast<int>(p[2]) + dz));
        }
      }
    }
  }
  [[nodiscard]] bool contains(const Point3& p) const {
    return cells_.count(
               key(static_cast<int>(p[0]), static_cast<int>(p[1]), static_cast<int>(p[2]))) != 0;
  }

 private:
  static std::uint64_t key(int x, int y, int z) {
    const auto part = [](int value) { return static_cast<std::uint64_t>(value + 8) & 0x1FFFFF; };
    return (part(x) << 42) | (part(y) << 21) | part(z);
  }
  std::unordered_set<std::uint64_t> cells_;
};

// The faces of the full surface around the faces that went too far.
std::vector<Triangle> faces_around(const TriangleSoup& surface, const std::vector<Triangle>& bad) {
  CellSet cells;
  for (const Triangle& t : bad) {
    for_each_raster_point(surface.points, t, 1.0, [&](const Point3& p) { cells.add_around(p); });
  }
  std::vector<Triangle> around;
  for (const Triangle& t : surface.triangles) {
    if (cells.contains(surface.points[t[0]])) around.push_back(t);
  }
  return around;
}

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

  std::vector<Triangle> accepted;
  std::vector<Triangle> source = surface.triangles;  // still to be represented
  for (std::size_t round = 0; !source.empty(); ++round) {
    observer.check();
    const bool last = removed_share <= 0 || round == std::size(kErrors);
    std::vector<Triangle> faces = std::move(source);
    source.clear();
    if (round > 0) proxy.faces_restored += static_cast<std::int64_t>(faces.size());
    if (!last) {
      const Patch patch = cut_out(surface, faces);
      faces = decimate(patch.positions, patch.faces, removed_share, kErrors[round]);
      for (Triangle& t : faces) {
        for (std::uint32_t& corner : t) corner = patch.origin[corner];
      }
    }
    const std::vector<double> largest = measure_all(surface, faces, phi);
    std::vector<Triangle> bad;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (largest[f] > kProxyTolerance && !last) {
        bad.push_back(faces[f]);
      } else {
        accepted.push_back(faces[f]);
        proxy.largest_distance = std::max(proxy.largest_distance, largest[f]);
      }
    }
    if (!bad.empty()) source = faces_around(surface, bad);
  }

  proxy.mesh = drop_unused_points(surface.points, accepted);
  for (Point3& p : proxy.mesh.points) p = frame.to_input(p);
  proxy.removed_share = 1 - static_cast<double>(proxy.mesh.triangles.size()) /
                                static_cast<double>(proxy.faces_before);
  return proxy;
}

}  // namespace cellocut
