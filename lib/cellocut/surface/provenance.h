// Where each vertex of a surface comes from, so that colours, texture or anything else that the
// input carries can be brought over.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/mesh/vertex_attribute.h"

namespace cellocut {

// One value for each vertex of the surface.
struct Provenance {
  // Nearest triangle of the input as it was read: from 0, in the order of the file, where a polygon
  // of n corners counts as n - 2. -1 where the input has no triangle of finite corners.
  std::vector<std::int32_t> nearest_face;
  std::vector<double> distance;         // to that triangle, in input units; NaN where there is none
  std::vector<std::uint8_t> supported;  // 1: follows the input; 0: the cut completed it here
  std::vector<Rgb> colours;             // at the nearest point; empty where not asked for

  [[nodiscard]] bool empty() const { return nearest_face.empty(); }
  // nearest_face, distance and supported, under these names, as files hold them.
  [[nodiscard]] std::vector<VertexAttribute> attributes() const;
};

// The colour at `p`, a point of the triangle: its corners' colours weighted by barycentric
// coordinates, component by component, rounded to nearest. A triangle without area is taken for the
// path over its corners, in the order in which they lie on a line. Precondition: one colour for
// each point.
Rgb colour_at(const TriangleSoup& mesh, const Triangle& triangle, const Point3& p);

// The provenance of a surface (input units). `nearest` is of `input`; `supported` has one value for
// each point of the surface. Parallel, the same bits for any number of threads; O(n log n).
// Preconditions: `colours` only with an input that has some. Errors: LimitError where faces of the
// input have numbers above 2147483647; Cancelled.
Provenance trace_provenance(const TriangleSoup& surface, std::vector<std::uint8_t> supported,
                            const TriangleSoup& input, const NearestTriangle& nearest, bool colours,
                            Observer& observer = silent_observer());

}  // namespace cellocut
