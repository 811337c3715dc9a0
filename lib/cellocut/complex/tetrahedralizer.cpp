#include "cellocut/complex/tetrahedralizer.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "cellocut/base/errors.h"
#include "cellocut/base/predicates.h"

namespace cellocut {

namespace {

// first_copy[i] for every point; equal coordinates by ==, so -0.0 and 0.0 are one point.
std::vector<std::uint32_t> find_first_copies(const std::vector<Point3>& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    if (points[i] != points[j]) return points[i] < points[j];
    return i < j;
  });
  std::vector<std::uint32_t> first_copy(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool copy = k > 0 && points[order[k]] == points[order[k - 1]];
    first_copy[order[k]] = copy ? first_copy[order[k - 1]] : order[k];
  }
  return first_copy;
}

// Whether the distinct points span space, decided exactly: some libraries abort the process
// otherwise.
bool spans_space(const std::vector<Point3>& points) {
  const Point3& a = points[0];
  const Point3& b = points[1];
  std::size_t k = 2;
  while (k < points.size() && collinear(a, b, points[k])) ++k;
  if (k == points.size()) return false;
  const Point3& c = points[k];
  return std::any_of(points.begin(), points.end(),
                     [&](const Point3& d) { return orientation(a, b, c, d) != 0; });
}

}  // namespace

TetComplex Tetrahedralizer::tetrahedralize(std::vector<Point3> points) const {
  for (const Point3& p : points) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
      throw InputError("tetrahedralization: a coordinate is not finite");
    }
  }
  std::vector<std::uint32_t> first_copy = find_first_copies(points);
  std::vector<std::uint32_t> distinct;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (first_copy[i] == i) distinct.push_back(i);
  }
  if (distinct.size() < 4) {
    throw InputError("tetrahedralization needs four distinct points, got " +
                     std::to_string(distinct.size()));
  }
  std::vector<Point3> unique_points;
  unique_points.reserve(distinct.size());
  for (const std::uint32_t i : distinct) unique_points.push_back(points[i]);
  if (!spans_space(unique_points)) {
    throw InputError("tetrahedralization: all points lie in one plane");
  }
  std::vector<std::array<std::uint32_t, 4>> cells = do_tetrahedralize(unique_points);
  for (std::array<std::uint32_t, 4>& cell : cells) {
    for (std::uint32_t& corner : cell) corner = distinct[corner];
  }
  return make_canonical(std::move(points), std::move(cells), std::move(first_copy));
}

}  // namespace cellocut
