#include "cellocut/surface/provenance.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

using Weights = std::array<double, 3>;

// Below this height, relative to the longest edge, the weights of a triangle would be mostly
// rounding.
constexpr double kFlat = 1e-10;

// The corners nearly on a line (the longest edge has length 1): weights along the path i, k, j,
// where k is the corner between the others.
Weights weights_on_a_line(const std::array<Point3, 3>& corners, std::size_t longest,
                          const Point3& p) {
  const std::size_t i = (longest + 1) % 3;
  const std::size_t j = (longest + 2) % 3;
  const Point3 direction = corners[j] - corners[i];
  const double middle = std::clamp(dot(corners[longest] - corners[i], direction), 0.0, 1.0);
  const double at = std::clamp(dot(p - corners[i], direction), 0.0, 1.0);
  Weights weights{};
  if (at < middle) {
    weights[longest] = at / middle;
    weights[i] = 1 - weights[longest];
  } else {
    weights[j] = at > middle ? (at - middle) / (1 - middle) : 0;
    weights[longest] = 1 - weights[j];
  }
  return weights;
}

// Barycentric coordinates: not negative, sum 1. Edge k lies opposite corner k.
Weights barycentric(const Point3& a, const Point3& b, const Point3& c, const Point3& p) {
  const std::array<double, 3> lengths{norm(c - b), norm(a - c), norm(b - a)};
  const auto longest =
      static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
  if (!(lengths[longest] > 0)) return {1, 0, 0};
  // Relative to the longest edge, so that neither squares nor areas leave the range of a double.
  const double scale = 1 / lengths[longest];
  const std::array<Point3, 3> corners{Point3{}, scale * (b - a), scale * (c - a)};
  const Point3 q = scale * (p - a);
  const Point3 normal = cross(corners[1], corners[2]);
  const double squared = squared_norm(normal);
  if (!(squared > kFlat * kFlat)) return weights_on_a_line(corners, longest, q);
  Weights weights{};
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3& from = corners[(k + 1) % 3];
    const Point3& to = corners[(k + 2) % 3];
    weights[k] = std::max(0.0, dot(cross(to - from, q - from), normal) / squared);
    sum += weights[k];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

std::vector<VertexAttribute> Provenance::attributes() const {
  return {{"nearest_face", nearest_face}, {"distance", distance}, {"supported", supported}};
}

Rgb colour_at(const TriangleSoup& mesh, const Triangle& triangle, const Point3& p) {
  const Weights weights =
      barycentric(mesh.points[triangle[0]], mesh.points[triangle[1]], mesh.points[triangle[2]], p);
  Rgb colour{};
  for (std::size_t component = 0; component < 3; ++component) {
    double value = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      value += weights[k] * mesh.colours[triangle[k]][component];
    }
    colour[component] = static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
  }
  return colour;
}

Provenance trace_provenance(const TriangleSoup& surface, std::vector<std::uint8_t> supported,
                            const TriangleSoup& input, const NearestTriangle& nearest, bool colours,
                            Observer& observer) {
  if (input.triangles.size() > std::size_t{std::numeric_limits<std::int32_t>::max()}) {
    throw LimitError("provenance numbers faces up to 2147483647, the input has " +
                     std::to_string(input.triangles.size()));
  }
  const std::size_t count = surface.points.size();
  Provenance provenance;
  provenance.nearest_face.resize(count);
  provenance.distance.resize(count);
  provenance.supported = std::move(supported);
  provenance.colours.resize(colours ? count : 0);
  observer.check();
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t v) {
    const NearestPoint found = nearest(surface.points[v]);
    if (!found.found()) {
      provenance.nearest_face[v] = -1;
      provenance.distance[v] = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    provenance.nearest_face[v] = static_cast<std::int32_t>(found.face);
    provenance.distance[v] = found.distance;
    if (colours) provenance.colours[v] = colour_at(input, input.triangles[found.face], found.point);
  });
  observer.check();
  return provenance;
}

}  // namespace cellocut
