#include "cellocut/surface/laplacian.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace cellocut {

namespace {

constexpr double kLargestCotangent = 20;  // an angle of three degrees
constexpr double kLeastArea = 0.1;        // of a vertex, in squared edge lengths

double cotangent(const Point3& at, const Point3& a, const Point3& b) {
  const double across = norm(cross(a - at, b - at));
  const double along = dot(a - at, b - at);
  if (std::fabs(along) >= kLargestCotangent * across)
    return std::copysign(kLargestCotangent, along);
  return along / across;
}

}  // namespace

LaplaceRows laplace_pattern(const FairingPatch& patch) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  pairs.reserve(6 * patch.faces.size());
  for (const Triangle& t : patch.faces) {
    for (int k = 0; k < 3; ++k) {
      for (const std::uint32_t other : {t[(k + 1) % 3], t[(k + 2) % 3]}) {
        if (t[k] < patch.rows) pairs.emplace_back(t[k], other);
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  LaplaceRows rows;
  rows.area.assign(patch.rows, 0.0);
  rows.first.assign(patch.rows + 1U, 0);
  rows.weight.assign(pairs.size(), 0.0);
  rows.column.reserve(pairs.size());
  for (const auto& [row, column] : pairs) {
    rows.column.push_back(column);
    rows.first[row + 1] = static_cast<std::uint32_t>(rows.column.size());
  }
  return rows;
}

void set_cotangent_weights(LaplaceRows& rows, const FairingPatch& patch,
                           const std::vector<Point3>& points) {
  std::fill(rows.weight.begin(), rows.weight.end(), 0.0);
  std::fill(rows.area.begin(), rows.area.end(), 0.0);
  const auto add = [&rows](std::uint32_t i, std::uint32_t j, double weight) {
    if (i >= rows.rows()) return;
    const auto begin = rows.column.begin() + rows.first[i];
    const auto at = std::lower_bound(begin, rows.column.begin() + rows.first[i + 1], j);
    rows.weight[static_cast<std::size_t>(at - rows.column.begin())] += weight;
  };
  for (const Triangle& t : patch.faces) {
    const std::array<Point3, 3> p{points[t[0]], points[t[1]], points[t[2]]};
    const double area = triangle_area(p[0], p[1], p[2]);
    std::array<double, 3> cot{};
    for (int k = 0; k < 3; ++k) cot[k] = cotangent(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
    const bool obtuse = cot[0] < 0 || cot[1] < 0 || cot[2] < 0;
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      const int m = (k + 2) % 3;
      add(t[l], t[m], 0.5 * cot[k]);
      add(t[m], t[l], 0.5 * cot[k]);
      if (t[k] >= rows.rows()) continue;
      if (obtuse) {
        rows.area[t[k]] += (cot[k] < 0 ? 0.5 : 0.25) * area;
      } else {
        rows.area[t[k]] +=
            0.125 * (cot[l] * squared_norm(p[m] - p[k]) + cot[m] * squared_norm(p[l] - p[k]));
      }
    }
  }
  for (std::uint32_t i = 0; i < rows.rows(); ++i) {
    rows.area[i] = std::max(rows.area[i], kLeastArea);
    for (std::uint32_t k = rows.first[i]; k < rows.first[i + 1]; ++k) {
      rows.weight[k] /= rows.area[i];
    }
  }
}

std::vector<Point3> row_normals(const FairingPatch& patch, const std::vector<Point3>& points) {
  std::vector<Point3> normals(patch.rows, Point3{});
  for (const Triangle& t : patch.faces) {
    const Point3 normal = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    for (const std::uint32_t v : t) {
      if (v < patch.rows) normals[v] = normals[v] + normal;
    }
  }
  for (Point3& n : normals) {
    const double length = norm(n);
    n = length > 0 ? (1 / length) * n : Point3{};
  }
  return normals;
}

double bending_energy(const LaplaceRows& rows, const std::vector<Point3>& points,
                      const std::vector<Point3>& normals) {
  double energy = 0;
  for (std::uint32_t i = 0; i < rows.rows(); ++i) {
    const double curvature = dot(rows.apply(points, i), normals[i]);
    energy += rows.area[i] * curvature * curvature;
  }
  return energy;
}

}  // namespace cellocut
