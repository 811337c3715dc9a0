// Discrete Laplacians on a patch, and the curvature that they measure.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/point.h"
#include "cellocut/surface/patches.h"

namespace cellocut {

// Rows of a discrete Laplace operator: for a function f on the vertices of the patch,
//   (L f)_i = sum over k in [first[i], first[i+1]) of weight[k] (f[column[k]] - f[i]),
// about the Laplacian of f at vertex i, in units of f over squared length.
struct LaplaceRows {
  std::vector<std::uint32_t> first;   // of every row, and the end
  std::vector<std::uint32_t> column;  // neighbours of the row's vertex, ascending
  std::vector<double> weight;
  std::vector<double> area;  // of the surface about the row's vertex

  [[nodiscard]] std::uint32_t rows() const { return static_cast<std::uint32_t>(area.size()); }
  // (L f)_i for a function of any type with + - and a factor.
  template <class Value>
  [[nodiscard]] Value apply(const std::vector<Value>& f, std::uint32_t i) const {
    Value sum{};
    for (std::uint32_t k = first[i]; k < first[i + 1]; ++k) {
      sum = sum + weight[k] * (f[column[k]] - f[i]);
    }
    return sum;
  }
};

// The neighbours of the rows; weights and areas are 0. O(faces log faces).
LaplaceRows laplace_pattern(const FairingPatch& patch);

// The cotangent formula with mixed Voronoi areas (Meyer, Desbrun, Schroeder, Barr: Discrete
// differential-geometry operators for triangulated 2-manifolds, 2003), for points in units of about
// the length of an edge. Cotangents and areas of slivers are clamped, so that they neither overflow
// nor drown their neighbours. Unlike the uniform weights it depends on the shape alone, not on how
// it is triangulated. O(faces log degree).
void set_cotangent_weights(LaplaceRows& rows, const FairingPatch& patch,
                           const std::vector<Point3>& points);

// Unit normals of the rows, the mean of the faces' by area; zero where that vanishes. O(faces).
std::vector<Point3> row_normals(const FairingPatch& patch, const std::vector<Point3>& points);

// Sum over rows of area times the square of (L x . normal), that is, the integral of (2 H)^2, H the
// mean curvature; has no unit. The weights must be those of the points.
double bending_energy(const LaplaceRows& rows, const std::vector<Point3>& points,
                      const std::vector<Point3>& normals);

}  // namespace cellocut
