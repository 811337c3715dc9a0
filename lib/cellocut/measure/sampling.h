// Random points on a surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Points on a shape, or any points that stand for one.
struct Samples {
  std::vector<Point3> points;
  // One unit vector for each point, zero where a point has none; or empty: no normals at all.
  std::vector<Point3> normals;
  std::vector<std::uint32_t> faces;  // of the soup, one for each point; empty for a point cloud

  [[nodiscard]] std::size_t size() const { return points.size(); }
};

// Unit normals of the faces, by their corners' order; zero where a face has no area. A face is
// without area where the cross product of two sides is zero in doubles. Parallel, O(n).
std::vector<Point3> unit_normals(const TriangleSoup& soup);

// `count` points, independent and uniform by area: the face by its share of the total area, the
// point in it by two numbers that are reflected into the triangle (Turk, Generating random points
// in triangles, Graphics Gems, 1990). Faces without area get none.
//
// Sample i takes numbers 3 i, 3 i + 1, 3 i + 2 of the generator SplitMix64 (Steele, Lea and Flood,
// Fast splittable pseudorandom number generators, 2014), which can begin at any of them: the same
// bits on every machine, for any number of threads, and the first samples are the same whatever the
// count. Different seeds give unrelated samples.
//
// Preconditions: coordinates are finite, their squares' squares neither overflow nor underflow.
// Errors: InputError where no face has an area. Parallel, O(n + count log n).
Samples sample_surface(const TriangleSoup& soup, std::size_t count, std::uint64_t seed);

}  // namespace cellocut
