// Point sets with known properties, and the properties that a Delaunay complex must have, each
// checked by code that shares nothing with the backends.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "cellocut/base/predicates.h"
#include "cellocut/complex/tet_complex.h"

namespace cellocut::testing_complex {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Points = std::vector<Point3>;

inline Kernel::Point_3 to_cgal(const Point3& p) { return {p[0], p[1], p[2]}; }

// ---- point sets
// -------------------------------------------------------------------------------------

// Uniform in a box of edge `scale` with its low corner at (offset, offset, offset).
inline Points random_points(std::size_t count, unsigned seed, double scale = 1, double offset = 0) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Points points(count);
  for (Point3& p : points) {
    for (double& x : p) x = offset + scale * uniform(random);
  }
  return points;
}

inline Points cube_grid(int per_edge) {
  Points points;
  for (int x = 0; x < per_edge; ++x) {
    for (int y = 0; y < per_edge; ++y) {
      for (int z = 0; z < per_edge; ++z) {
        points.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
      }
    }
  }
  return points;
}

// All integer points at the same distance from the origin: exactly co-spherical.
inline Points integer_sphere(int squared_radius) {
  Points points;
  const int r = static_cast<int>(std::sqrt(squared_radius)) + 1;
  for (int x = -r; x <= r; ++x) {
    for (int y = -r; y <= r; ++y) {
      for (int z = -r; z <= r; ++z) {
        if (x * x + y * y + z * z == squared_radius) {
          points.push_back(
              {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
        }
      }
    }
  }
  return points;
}

// ---- properties
// -------------------------------------------------------------------------------------

// Volume of the convex hull by CGAL's quickhull.
inline double hull_volume(const Points& points) {
  std::vector<Kernel::Point_3> input;
  for (const Point3& p : points) input.push_back(to_cgal(p));
  CGAL::Surface_mesh<Kernel::Point_3> hull;
  CGAL::convex_hull_3(input.begin(), input.end(), hull);
  double six = 0;
  const Point3 apex = points[0];
  for (const auto face : hull.faces()) {
    std::vector<Point3> corners;
    for (const auto vertex : hull.vertices_around_face(hull.halfedge(face))) {
      const Kernel::Point_3& p = hull.point(vertex);
      corners.push_back({p.x(), p.y(), p.z()});
    }
    for (std::size_t k = 2; k < corners.size(); ++k) {
      six += six_volumes(apex, corners[0], corners[k - 1], corners[k]);
    }
  }
  return std::abs(six) / 6;
}

inline double total_volume(const TetComplex& complex) {
  double sum = 0;
  for (std::uint32_t c = 0; c < complex.cells.size(); ++c) sum += cell_volume(complex, c);
  return sum;
}

inline void expect_symmetric_neighbours(const TetComplex& complex) {
  ASSERT_EQ(complex.neighbours.size(), complex.cells.size());
  for (std::uint32_t c = 0; c < complex.cells.size(); ++c) {
    for (int k = 0; k < 4; ++k) {
      const std::int32_t other = complex.neighbours[c][k];
      if (other == kOutside) continue;
      ASSERT_GE(other, 0);
      ASSERT_LT(static_cast<std::size_t>(other), complex.cells.size());
      ASSERT_NE(static_cast<std::uint32_t>(other), c);
      int back = 0;
      for (int j = 0; j < 4; ++j) {
        if (complex.neighbours[other][j] != static_cast<std::int32_t>(c)) continue;
        ++back;
        ASSERT_EQ(facet_corners(complex, static_cast<std::uint32_t>(other), j),
                  facet_corners(complex, c, k));
      }
      ASSERT_EQ(back, 1) << "cells " << c << " and " << other;
    }
  }
}

inline void expect_positive_cells(const TetComplex& complex) {
  for (const auto& cell : complex.cells) {
    ASSERT_EQ(orientation(complex.points[cell[0]], complex.points[cell[1]], complex.points[cell[2]],
                          complex.points[cell[3]]),
              1);
  }
}

inline void expect_canonical_order(const TetComplex& complex) {
  std::array<std::uint32_t, 4> previous{};
  for (std::array<std::uint32_t, 4> cell : complex.cells) {
    ASSERT_LT(cell[0], std::min(cell[1], std::min(cell[2], cell[3])));
    ASSERT_LT(cell[1], std::min(cell[2], cell[3]));
    std::sort(cell.begin(), cell.end());
    ASSERT_LT(previous, cell);
    previous = cell;
  }
}

// Every first copy is a corner, nothing else is.
inline void expect_corners_are_first_copies(const TetComplex& complex) {
  ASSERT_EQ(complex.first_copy.size(), complex.points.size());
  std::vector<bool> corner(complex.points.size(), false);
  for (const auto& cell : complex.cells) {
    for (const std::uint32_t v : cell) {
      ASSERT_LT(v, complex.points.size());
      corner[v] = true;
    }
  }
  for (std::uint32_t i = 0; i < complex.points.size(); ++i) {
    ASSERT_LE(complex.first_copy[i], i);
    ASSERT_EQ(complex.points[i], complex.points[complex.first_copy[i]]);
    ASSERT_EQ(corner[i], complex.first_copy[i] == i) << "point " << i;
  }
}

// No neighbour's far corner lies strictly inside a cell's sphere: by Delaunay's lemma this local
// property at every facet is the global one. Returns how many facets are co-spherical ties.
inline std::size_t expect_locally_delaunay(const TetComplex& complex) {
  std::size_t ties = 0;
  for (std::uint32_t c = 0; c < complex.cells.size(); ++c) {
    const auto& cell = complex.cells[c];
    for (int k = 0; k < 4; ++k) {
      const std::int32_t other = complex.neighbours[c][k];
      if (other == kOutside) continue;
      for (const std::uint32_t v : complex.cells[other]) {
        if (std::find(cell.begin(), cell.end(), v) != cell.end()) continue;
        const CGAL::Oriented_side side = CGAL::side_of_oriented_sphere(
            to_cgal(complex.points[cell[0]]), to_cgal(complex.points[cell[1]]),
            to_cgal(complex.points[cell[2]]), to_cgal(complex.points[cell[3]]),
            to_cgal(complex.points[v]));
        EXPECT_NE(side, CGAL::ON_POSITIVE_SIDE) << "cell " << c << ", point " << v;
        ties += side == CGAL::ON_ORIENTED_BOUNDARY ? 1 : 0;
      }
    }
  }
  return ties;
}

// The same by its definition: every cell against every point.
inline void expect_empty_spheres(const TetComplex& complex) {
  for (const auto& cell : complex.cells) {
    for (const Point3& p : complex.points) {
      ASSERT_NE(CGAL::side_of_oriented_sphere(
                    to_cgal(complex.points[cell[0]]), to_cgal(complex.points[cell[1]]),
                    to_cgal(complex.points[cell[2]]), to_cgal(complex.points[cell[3]]), to_cgal(p)),
                CGAL::ON_POSITIVE_SIDE);
    }
  }
}

// Returns the number of co-spherical ties.
inline std::size_t expect_delaunay_complex(const TetComplex& complex, const Points& points) {
  EXPECT_EQ(complex.points, points);
  EXPECT_FALSE(complex.cells.empty());
  expect_symmetric_neighbours(complex);
  expect_positive_cells(complex);
  expect_canonical_order(complex);
  expect_corners_are_first_copies(complex);
  const double expected = hull_volume(points);
  EXPECT_NEAR(total_volume(complex), expected, 1e-9 * expected);
  return expect_locally_delaunay(complex);
}

inline bool same_arrays(const TetComplex& a, const TetComplex& b) {
  return a.points == b.points && a.cells == b.cells && a.neighbours == b.neighbours &&
         a.first_copy == b.first_copy;
}

}  // namespace cellocut::testing_complex
