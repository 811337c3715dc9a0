// Brings a decimated surface back to within a distance of phi = 0 by inserting vertices of the full
// surface where it departs.
#pragma once

#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct Refinement {
  std::vector<Triangle> faces;      // all within the tolerance
  double largest_distance = 0;      // measured max of |phi| over them, in grid steps
  std::int64_t faces_restored = 0;  // of the full surface, where inserting did not help
};

// `faces` are corners into surface.points (index coordinates), |phi| is measured on a raster of
// half a grid step on every face, edges and corners included. An edge further away than `tolerance`
// is split at the vertex of `surface` nearest to its worst point, at all of its faces, so that the
// faces go on to cover what they covered; a face that is too far away only inside is split into
// three. Again, for a few rounds; faces that this does not cure give way to the faces of `surface`
// around them.
// Preconditions: the faces depart by a few grid steps at most (further away no vertex is looked
// for, and no face of the full surface is near); the vertices of `surface` are within `tolerance`
// of phi = 0. Errors: Cancelled. O(n log n) and one raster point per quarter of a squared grid
// step.
Refinement refine_to_surface(const TriangleSoup& surface, const std::vector<Triangle>& faces,
                             const SparseField& phi, double tolerance, Observer& observer);

}  // namespace cellocut
