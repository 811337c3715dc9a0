// The interface of a labelling as a surface of cell facets, made manifold by splitting.
#include "cellocut/surface/interface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "cellocut/validity/surface_report.h"
#include "support/tiny_complexes.h"

namespace cellocut::testing {
namespace {

using Cube = std::array<int, 3>;

CellLabels interior_cubes(const TetComplex& grid, const std::vector<Cube>& cubes) {
  CellLabels labels(grid.cells.size(), kExterior);
  for (const Cube& cube : cubes) {
    for (const std::uint32_t c : cells_of_cube(grid, cube[0], cube[1], cube[2])) {
      labels[c] = kInterior;
    }
  }
  return labels;
}

double interior_volume(const TetComplex& complex, const CellLabels& labels) {
  double volume = 0;
  for (std::uint32_t c = 0; c < labels.size(); ++c) {
    if (labels[c] == kInterior) volume += cell_volume(complex, c);
  }
  return volume;
}

// Checks what holds for every labelling; returns the report for the rest.
SurfaceReport expect_solid(const TetComplex& complex, const CellLabels& labels) {
  const TriangleSoup surface = extract_interface_cells(complex, labels);
  const SurfaceReport report = inspect_surface(surface);
  EXPECT_EQ(report.by_index.boundary_edges, 0);
  EXPECT_EQ(report.by_index.nonmanifold_edges, 0);
  EXPECT_EQ(report.by_index.misoriented_edges, 0);
  EXPECT_EQ(report.by_index.nonmanifold_vertices, 0);
  EXPECT_EQ(report.intersecting_pairs, 0);
  EXPECT_EQ(report.degenerate_faces, 0);
  EXPECT_TRUE(report.valid());
  EXPECT_NEAR(report.volume, interior_volume(complex, labels), 1e-9);
  // Every facet of the interface, once, where it was.
  const std::vector<InterfaceFacet> interface = list_interface(complex, labels);
  const auto places = [](const TriangleSoup& soup) {
    std::multiset<std::array<Point3, 3>> triangles;
    for (const Triangle& t : soup.triangles) {
      std::array<Point3, 3> corners{soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]};
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      triangles.insert(corners);
    }
    return triangles;
  };
  EXPECT_EQ(places(surface), places(interface_triangles(complex, interface)));
  EXPECT_EQ(report.points, static_cast<std::int64_t>(surface.points.size()));
  return report;
}

TEST(Interface, ListsTheFacetsBetweenInteriorAndExterior) {
  const TetComplex grid = cube_grid({3, 3, 3});
  const CellLabels labels = random_labels(grid, 0.4, 8);
  std::set<std::pair<std::uint32_t, int>> expected;
  for (std::uint32_t c = 0; c < grid.cells.size(); ++c) {
    for (int k = 0; k < 4; ++k) {
      const std::int32_t other = grid.neighbours[c][k];
      const std::uint8_t beyond = other == kOutside ? kExterior : labels[other];
      if (labels[c] == kInterior && beyond == kExterior) expected.insert({c, k});
    }
  }
  std::vector<std::pair<std::uint32_t, int>> listed;
  for (const InterfaceFacet& f : list_interface(grid, labels))
    listed.emplace_back(f.cell, f.corner);
  EXPECT_TRUE(std::is_sorted(listed.begin(), listed.end()));
  EXPECT_EQ(std::set(listed.begin(), listed.end()), expected);
  EXPECT_EQ(listed.size(), expected.size());
}

TEST(Interface, NoInteriorNoSurface) {
  const TetComplex grid = cube_grid({2, 1, 1});
  const CellLabels labels(grid.cells.size(), kExterior);
  EXPECT_TRUE(list_interface(grid, labels).empty());
  EXPECT_TRUE(extract_interface_cells(grid, labels).empty());
}

TEST(Interface, OfAllCellsIsTheHull) {
  const TetComplex grid = cube_grid({2, 3, 2}, 0.0);
  const SurfaceReport report = expect_solid(grid, CellLabels(grid.cells.size(), kInterior));
  EXPECT_EQ(report.components.size(), 1U);
  EXPECT_EQ(report.euler, 2);
  EXPECT_EQ(report.touching_edges, 0);
  EXPECT_EQ(report.touching_vertices, 0);
  EXPECT_NEAR(report.volume, 12, 1e-12);
}

TEST(Interface, CubesThatMeetInAnEdgeAreSplit) {
  const TetComplex grid = cube_grid({2, 2, 1});
  const SurfaceReport report = expect_solid(grid, interior_cubes(grid, {{0, 0, 0}, {1, 1, 0}}));
  EXPECT_EQ(report.components.size(), 2U);
  EXPECT_EQ(report.euler, 4);
  EXPECT_EQ(report.touching_edges, 1);
  EXPECT_EQ(report.touching_vertices, 2);
  EXPECT_EQ(report.by_position.nonmanifold_edges, 1);
}

TEST(Interface, CubesThatMeetInAVertexAreSplit) {
  const TetComplex grid = cube_grid({2, 2, 2});
  const SurfaceReport report = expect_solid(grid, interior_cubes(grid, {{0, 0, 0}, {1, 1, 1}}));
  EXPECT_EQ(report.components.size(), 2U);
  EXPECT_EQ(report.touching_edges, 0);
  EXPECT_EQ(report.touching_vertices, 1);
}

TEST(Interface, CellsThatMeetInAnEdgeAreSplit) {
  // Of the six cells around the diagonal of a cube, two opposite ones.
  const TetComplex grid = cube_grid({1, 1, 1});
  CellLabels labels(grid.cells.size(), kExterior);
  labels[0] = kInterior;
  int touching = 0;
  for (std::uint32_t c = 1; c < labels.size(); ++c) {
    if (std::count(grid.neighbours[0].begin(), grid.neighbours[0].end(),
                   static_cast<std::int32_t>(c)) != 0) {
      continue;
    }
    CellLabels two = labels;
    two[c] = kInterior;
    const SurfaceReport report = expect_solid(grid, two);
    EXPECT_EQ(report.components.size(), 2U);
    touching += report.touching_edges > 0 ? 1 : 0;
  }
  EXPECT_EQ(touching, 3);
}

TEST(Interface, ARingThatTouchesItselfAlongAnEdgeStaysOneSolid) {
  const TetComplex grid = cube_grid({2, 2, 2});
  const SurfaceReport report = expect_solid(
      grid, interior_cubes(grid, {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}}));
  EXPECT_EQ(report.components.size(), 1U);
  EXPECT_EQ(report.touching_edges, 1);
  EXPECT_GT(report.touching_vertices, 0);
}

// Connected around both ends of the edge at which it touches itself: the two sheets cannot be told
// apart by their vertices, and have to be joined through the exterior.
TEST(Interface, ARingThatIsConnectedAtBothEndsOfAnEdge) {
  const TetComplex grid = cube_grid({2, 2, 3});
  const SurfaceReport report = expect_solid(grid, interior_cubes(grid, {{0, 0, 0},
                                                                        {1, 0, 0},
                                                                        {1, 1, 0},
                                                                        {0, 0, 1},
                                                                        {1, 1, 1},
                                                                        {0, 0, 2},
                                                                        {0, 1, 2},
                                                                        {1, 1, 2}}));
  EXPECT_EQ(report.components.size(), 1U);
  EXPECT_GT(report.touching_edges + report.touching_vertices, 0);
}

TEST(Interface, AVoidThatTouchesTheOutsideInAnEdge) {
  const TetComplex grid = cube_grid({3, 3, 1});
  CellLabels labels(grid.cells.size(), kInterior);
  for (const Cube& cube : {Cube{1, 1, 0}, Cube{2, 2, 0}}) {
    for (const std::uint32_t c : cells_of_cube(grid, cube[0], cube[1], cube[2])) {
      labels[c] = kExterior;
    }
  }
  const SurfaceReport report = expect_solid(grid, labels);
  EXPECT_GT(report.touching_edges + report.touching_vertices, 0);
}

class RandomLabels : public ::testing::TestWithParam<double> {};

TEST_P(RandomLabels, BecomeManifolds) {
  int touching = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    const auto size = static_cast<std::uint32_t>(2 + seed % 3);
    const TetComplex grid = cube_grid({size, 3, 2}, seed % 2 == 0 ? 0 : 0.08, seed);
    CellLabels labels = random_labels(grid, GetParam(), seed);
    if (seed % 3 == 0) {
      // Whole cubes: their long straight contacts.
      std::vector<Cube> cubes;
      for (int i = 0; i < static_cast<int>(size) * 6; ++i) {
        if (labels[i] == kInterior) cubes.push_back({i / 6, i / 2 % 3, i % 2});
      }
      const TetComplex plain = cube_grid({size, 3, 2});
      if (!cubes.empty()) expect_solid(plain, interior_cubes(plain, cubes));
    }
    if (std::count(labels.begin(), labels.end(), kInterior) == 0) continue;
    const SurfaceReport report = expect_solid(grid, labels);
    touching += report.touching_vertices > 0 ? 1 : 0;
    if (HasFailure()) break;
  }
  EXPECT_GT(touching, 100);
}

INSTANTIATE_TEST_SUITE_P(Interface, RandomLabels, ::testing::Values(0.15, 0.35, 0.5, 0.65, 0.85));

}  // namespace
}  // namespace cellocut::testing
