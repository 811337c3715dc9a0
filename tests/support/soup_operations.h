// What may be done to a soup without changing the surface that it stands for, or only its size and
// place.
#pragma once

#include <cstdint>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut::test {

// Appends `part` to `whole`, sharing no points.
void append(TriangleSoup& whole, const TriangleSoup& part);

// `soup` with every coordinate multiplied; with an offset added.
TriangleSoup scaled(TriangleSoup soup, double factor);
TriangleSoup translated(TriangleSoup soup, const Point3& offset);
// Turned about `axis` (of any length but zero) through the origin, by an angle in radians.
TriangleSoup rotated(TriangleSoup soup, const Point3& axis, double angle);

// The same faces in another order; each face beginning at another corner; about half of the faces
// turned inside out; the points numbered in another order. Pseudo-random by `seed`, the same on
// every machine.
TriangleSoup with_faces_permuted(TriangleSoup soup, std::uint64_t seed);
TriangleSoup with_corners_rotated(TriangleSoup soup, std::uint64_t seed);
TriangleSoup with_faces_flipped(TriangleSoup soup, std::uint64_t seed);
TriangleSoup with_points_permuted(const TriangleSoup& soup, std::uint64_t seed);
// Every face turned inside out.
TriangleSoup inside_out(TriangleSoup soup);

}  // namespace cellocut::test
