#include "support/soup_operations.h"

#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace cellocut::test {
namespace {

// Fisher-Yates on the raw output of the generator: std::shuffle and the standard distributions are
// not the same in every library.
template <class Range>
void shuffle(Range& range, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::size_t i = range.size(); i > 1; --i) std::swap(range[i - 1], range[random() % i]);
}

}  // namespace

void append(TriangleSoup& whole, const TriangleSoup& part) {
  const auto offset = static_cast<std::uint32_t>(whole.points.size());
  whole.colours.clear();  // the parts may differ in having any
  whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
  for (const Triangle& t : part.triangles) {
    whole.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
}

TriangleSoup scaled(TriangleSoup soup, double factor) {
  for (Point3& point : soup.points) point = factor * point;
  return soup;
}

TriangleSoup translated(TriangleSoup soup, const Point3& offset) {
  for (Point3& point : soup.points) point = point + offset;
  return soup;
}

// Rodrigues' formula.
TriangleSoup rotated(TriangleSoup soup, const Point3& axis, double angle) {
  const Point3 k = (1 / norm(axis)) * axis;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  for (Point3& p : soup.points) p = c * p + s * cross(k, p) + ((1 - c) * dot(k, p)) * k;
  return soup;
}

TriangleSoup with_faces_permuted(TriangleSoup soup, std::uint64_t seed) {
  shuffle(soup.triangles, seed);
  return soup;
}

TriangleSoup with_corners_rotated(TriangleSoup soup, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (Triangle& t : soup.triangles) {
    for (std::uint64_t turns = random() % 3; turns > 0; --turns) t = {t[1], t[2], t[0]};
  }
  return soup;
}

TriangleSoup with_faces_flipped(TriangleSoup soup, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (Triangle& t : soup.triangles) {
    if (random() % 2 == 0) std::swap(t[1], t[2]);
  }
  return soup;
}

TriangleSoup with_points_permuted(const TriangleSoup& soup, std::uint64_t seed) {
  std::vector<std::uint32_t> place(soup.points.size());
  std::iota(place.begin(), place.end(), 0u);
  shuffle(place, seed);
  TriangleSoup result;
  result.points.resize(soup.points.size());
  for (std::size_t i = 0; i < place.size(); ++i) result.points[place[i]] = soup.points[i];
  for (const Triangle& t : soup.triangles) {
    result.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  }
  return result;
}

TriangleSoup inside_out(TriangleSoup soup) {
  for (Triangle& t : soup.triangles) std::swap(t[1], t[2]);
  return soup;
}

}  // namespace cellocut::test
