#include "cellocut/measure/sampling.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cellocut/base/errors.h"
#include "cellocut/base/random_stream.h"

namespace cellocut {

namespace {

Point3 face_cross(const TriangleSoup& soup, const Triangle& t) {
  const Point3& a = soup.points[t[0]];
  return cross(soup.points[t[1]] - a, soup.points[t[2]] - a);
}

Point3 unit_normal(const TriangleSoup& soup, const Triangle& t) {
  const Point3 normal = face_cross(soup, t);
  const double length = norm(normal);
  if (!(length > 0)) return {0, 0, 0};
  return {normal[0] / length, normal[1] / length, normal[2] / length};
}

// Twice the area of all faces up to each.
std::vector<double> cumulative_areas(const TriangleSoup& soup) {
  std::vector<double> sums(soup.triangles.size());
  tbb::parallel_for(std::size_t{0}, sums.size(),
                    [&](std::size_t f) { sums[f] = norm(face_cross(soup, soup.triangles[f])); });
  double sum = 0;
  for (double& value : sums) value = sum += value;
  return sums;
}

}  // namespace

std::vector<Point3> unit_normals(const TriangleSoup& soup) {
  std::vector<Point3> normals(soup.triangles.size());
  tbb::parallel_for(std::size_t{0}, normals.size(),
                    [&](std::size_t f) { normals[f] = unit_normal(soup, soup.triangles[f]); });
  return normals;
}

Samples sample_surface(const TriangleSoup& soup, std::size_t count, std::uint64_t seed) {
  const std::vector<double> sums = cumulative_areas(soup);
  if (sums.empty() || !(sums.back() > 0)) throw InputError("no face has an area");
  const RandomStream random(seed);
  Samples samples;
  samples.points.resize(count);
  samples.normals.resize(count);
  samples.faces.resize(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    // The first face whose sum is larger: one without area never is. There is one, for a number
    // below 1 times the total rounds to less than the total.
    const auto found = std::upper_bound(sums.begin(), sums.end(), random(3 * i) * sums.back());
    const auto f = static_cast<std::size_t>(found - sums.begin());
    double u = random(3 * i + 1);
    double v = random(3 * i + 2);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Triangle& t = soup.triangles[f];
    const Point3& a = soup.points[t[0]];
    samples.points[i] = a + (u * (soup.points[t[1]] - a) + v * (soup.points[t[2]] - a));
    samples.normals[i] = unit_normal(soup, t);
    samples.faces[i] = static_cast<std::uint32_t>(f);
  });
  return samples;
}

}  // namespace cellocut
