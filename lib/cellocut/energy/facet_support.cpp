#include "cellocut/energy/facet_support.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cellocut/field/sparse_grid.h"

namespace cellocut {

namespace {

using Corners = std::array<Point3, 3>;  // in index coordinates

// The share of a triangle's area in which the linear function with these values at its corners is
// negative.
double negative_share(std::array<double, 3> v) {
  std::sort(v.begin(), v.end());
  if (v[0] >= 0) return 0;
  if (v[2] < 0) return 1;
  const double corner = v[0] / (v[0] - v[2]);
  if (v[1] >= 0) return corner * v[0] / (v[0] - v[1]);
  return 1 - (1 - corner) * v[2] / (v[2] - v[1]);
}

// The share of the triangle's area that is supported.
double supported_share(const Corners& t, FieldSampler& phi) {
  const Point3 centre = (1.0 / 3) * (t[0] + t[1] + t[2]);
  double radius = 0;  // squared
  for (const Point3& corner : t) radius = std::max(radius, dot(corner - centre, corner - centre));
  const double beyond = phi(centre) - kSupportReach;
  if (beyond * beyond >= radius) return beyond < 0 ? 1 : 0;
  if (radius < 1) {
    return negative_share(
        {phi(t[0]) - kSupportReach, phi(t[1]) - kSupportReach, phi(t[2]) - kSupportReach});
  }
  // The longest edge is halved: most facets are slivers.
  std::size_t longest = 0;
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3 edge = t[(k + 1) % 3] - t[k];
    if (dot(edge, edge) > most) {
      most = dot(edge, edge);
      longest = k;
    }
  }
  const Point3& from = t[longest];
  const Point3& to = t[(longest + 1) % 3];
  const Point3& apex = t[(longest + 2) % 3];
  const Point3 middle = 0.5 * (from + to);
  return 0.5 *
         (supported_share({from, middle, apex}, phi) + supported_share({middle, to, apex}, phi));
}

}  // namespace

std::vector<std::int64_t> support_by_facets(const TetComplex& complex, const FacetList& facets,
                                            const FacetAreas& areas, const SparseField& phi,
                                            const Frame& frame) {
  std::vector<std::int64_t> supported(facets.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, facets.size(), 256),
      [&](const tbb::blocked_range<std::size_t>& range) {
        FieldSampler sampler(phi);
        for (std::size_t f = range.begin(); f != range.end(); ++f) {
          const auto corners = facet_corners(complex, facets[f].cell, facets[f].corner);
          Corners triangle;
          for (std::size_t k = 0; k < 3; ++k) {
            triangle[k] = frame.to_index(complex.points[corners[k]]);
          }
          const double share = supported_share(triangle, sampler);
          supported[f] = std::llround(share * static_cast<double>(areas.quantised[f]));
        }
      });
  return supported;
}

}  // namespace cellocut
