// How far faces depart from phi = 0.
#pragma once

#include <cmath>
#include <vector>

#include "cellocut/base/point.h"
#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Where |phi| is largest among the samples of a raster of half a grid step.
struct Departure {
  double distance = 0;  // |phi| there, in grid steps
  Point3 at{};
};

// For each face (corners into `points`, index coordinates): over all of it, its edges and corners
// included. Parallel.
std::vector<Departure> measure_faces(const std::vector<Point3>& points,
                                     const std::vector<Triangle>& faces, const SparseField& phi);

Departure measure_edge(const Point3& a, const Point3& b, const SparseField& phi);

double largest_distance(const std::vector<Departure>& departures);

}  // namespace cellocut
