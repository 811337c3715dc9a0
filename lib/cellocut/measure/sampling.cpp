#include "cellocut/measure/sampling.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

// The output function of SplitMix64.
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

// The stream of a seed, open at any place. The seed is mixed first: streams whose starts differ by
// a few steps are shifts of one another.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : start_(mix(seed + kStep)) {}
  // Number n, uniform in [0, 1): a multiple of 2^-53. Not std::uniform_real_distribution, whose
  // result depends on the library.
  [[nodiscard]] double operator()(std::uint64_t n) const {
    return static_cast<double>(mix(start_ + (n + 1) * kStep) >> 11) * 0x1p-53;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15U;
  std::uint64_t start_;
};

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
