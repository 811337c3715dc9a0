#include "cellocut/proxy/proxy.h"

#include <meshoptimizer.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cellocut/field/sparse_grid.h"

namespace cellocut {

namespace {

constexpr double kRaster = 0.5;  // grid steps between samples on a face
constexpr int kMaxRounds = 12;   // of splitting; each at least halves what is wrong, in practice

// Quadric edge collapse onto existing vertices (meshoptimizer). Vertices stay exactly where they are.
std::vector<Triangle> decimate(const TriangleSoup& surface, double removed_share) {
  std::vector<float> positions(3 * surface.points.size());
  tbb::parallel_for(std::size_t{0}, surface.points.size(), [&](std::size_t i) {
    for (int axis = 0; axis < 3; ++axis) {
      positions[3 * i + axis] = static_cast<float>(surface.points[i][axis]);
    }
  });
  std::vector<unsigned int> indices;
  indices.reserve(3 * surface.triangles.size());
  for (const Triangle& t : surface.triangles) indices.insert(indices.end(), t.begin(), t.end());
  const double kept = (1 - removed_share) * static_cast<double>(surface.triangles.size());
  const std::size_t target = 3 * static_cast<std::size_t>(std::ceil(kept));
  const float scale = meshopt_simplifyScale(positions.data(), surface.points.size(), 12);
  std::vector<unsigned int> result(indices.size());
  result.resize(meshopt_simplify(result.data(), indices.data(), indices.size(), positions.data(),
                                 surface.points.size(), 12, target,
                                 static_cast<float>(kProxyTolerance) / scale, 0, nullptr));
  std::vector<Triangle> triangles(result.size() / 3);
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    triangles[f] = {result[3 * f], result[3 * f + 1], result[3 * f + 2]};
  }
  return triangles;
}

struct WorstSample {
  double distance = 0;  // |phi|
  Point3 at{};
  int edge = -1;  // k where the sample lies on the edge from corner k to k + 1, -1 in the interior
};

// The largest |phi| over a raster on the triangle. Samples on an edge are computed from its end of lower
// index, so that both faces at an edge see the same ones.
WorstSample measure(const std::vector<Point3>& points, const Triangle& face, FieldSampler& phi) {
  WorstSample worst;
  const auto consider = [&](const Point3& p, int edge) {
    const double distance = std::fabs(phi(p));
    if (distance > worst.distance) worst = {distance, p, edge};
  };
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t a = std::min(face[k], face[(k + 1) % 3]);
    const std::uint32_t b = std::max(face[k], face[(k + 1) % 3]);
    const Point3 along = points[b] - points[a];
    const double length = norm(along);
    longest = std::max(longest, length);
    const int steps = static_cast<int>(std::ceil(length / kRaster));
    for (int i = 1; i < steps; ++i) {
      consider(points[a] + (static_cast<double>(i) / steps) * along, k);
    }
  }
  const int steps = static_cast<int>(std::ceil(longest / kRaster));
  const Point3 u = points[face[1]] - points[face[0]];
  const Point3 v = points[face[2]] - points[face[0]];
  for (int i = 1; i < steps; ++i) {
    for (int j = 1; i + j < steps; ++j) {
      consider((points[face[0]] + (static_cast<double>(i) / steps) * u) +
                   (static_cast<double>(j) / steps) * v,
               -1);
    }
  }
  return worst;
}

// Moves p along the gradient onto phi = 0; p itself where that does not lead anywhere.
Point3 project(const Point3& p, FieldSampler& phi) {
  Point3 q = p;
  for (int step = 0; step < 8; ++step) {
    const double value = phi(q);
    if (std::fabs(value) < 1.0 / 64) break;
    Point3 gradient{};
    for (int axis = 0; axis < 3; ++axis) {
      Point3 forward = q;
      Point3 backward = q;
      forward[axis] += 0.5;
      backward[axis] -= 0.5;
      gradient[axis] = phi(forward) - phi(backward);
    }
    const double squared = squared_norm(gradient);
    if (squared < 1e-6) return p;
    q = q - (value / squared) * gradient;
  }
  return std::fabs(phi(q)) < std::fabs(phi(p)) ? q : p;
}

class Refinement {
 public:
  Refinement(TriangleSoup mesh, const SparseField& phi) : mesh_(std::move(mesh)), phi_(phi) {}

  // Measures all faces and splits those beyond the tolerance; again for the new ones.
  void run(Observer& observer) {
    std::vector<std::size_t> pending(mesh_.triangles.size());
    for (std::size_t f = 0; f < pending.size(); ++f) pending[f] = f;
    for (int round = 0; !pending.empty(); ++round) {
      observer.check();
      const std::vector<WorstSample> worst = measure_all(pending);
      std::vector<std::size_t> touched;
      for (std::size_t i = 0; i < pending.size(); ++i) {
        if (worst[i].distance <= kProxyTolerance || round == kMaxRounds) {
          largest_distance_ = std::max(largest_distance_, worst[i].distance);
        } else {
          split(pending[i], worst[i], touched);
        }
      }
      pending = std::move(touched);
    }
  }

  [[nodiscard]] double largest_distance() const { return largest_distance_; }
  [[nodiscard]] std::int64_t points_added() const { return points_added_; }
  TriangleSoup take() { return std::move(mesh_); }

 private:
  [[nodiscard]] std::vector<WorstSample> measure_all(const std::vector<std::size_t>& faces) const {
    std::vector<WorstSample> worst(faces.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 256),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        FieldSampler phi(phi_);
                        for (std::size_t i = range.begin(); i != range.end(); ++i) {
                          worst[i] = measure(mesh_.points, mesh_.triangles[faces[i]], phi);
                        }
                      });
    return worst;
  }

  // Two new faces where the worst place is on an edge, three where it is inside.
  void split(std::size_t f, const WorstSample& worst, std::vector<std::size_t>& touched) {
    const std::uint32_t m = add_point(worst.at);
    const Triangle face = mesh_.triangles[f];
    std::vector<Triangle> parts;
    for (int k = 0; k < 3; ++k) {
      if (k != worst.edge) parts.push_back({face[k], face[(k + 1) % 3], m});
    }
    mesh_.triangles[f] = parts.front();
    touched.push_back(f);
    for (std::size_t i = 1; i < parts.size(); ++i) {
      touched.push_back(mesh_.triangles.size());
      mesh_.triangles.push_back(parts[i]);
    }
  }

  // The point for a sample; two faces that split their common edge at the same place share it.
  std::uint32_t add_point(const Point3& sample) {
    const auto [entry, fresh] =
        point_of_sample_.try_emplace(sample, static_cast<std::uint32_t>(mesh_.points.size()));
    if (fresh) {
      FieldSampler phi(phi_);
      mesh_.points.push_back(project(sample, phi));
      ++points_added_;
    }
    return entry->second;
  }

  TriangleSoup mesh_;
  const SparseField& phi_;
  std::map<Point3, std::uint32_t> point_of_sample_;
  double largest_distance_ = 0;
  std::int64_t points_added_ = 0;
};

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
  Refinement refinement(
      drop_unused_points(surface.points,
                         removed_share > 0 ? decimate(surface, removed_share) : surface.triangles),
      phi);
  refinement.run(observer);
  proxy.largest_distance = refinement.largest_distance();
  proxy.points_added = refinement.points_added();
  proxy.mesh = refinement.take();
  for (Point3& p : proxy.mesh.points) p = frame.to_input(p);
  proxy.removed_share = 1 - static_cast<double>(proxy.mesh.triangles.size()) /
                                static_cast<double>(proxy.faces_before);
  return proxy;
}

}  // namespace cellocut
