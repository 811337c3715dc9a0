#include "support/tiny_complexes.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace cellocut::testing {

namespace {

// In [0, 1). The standard distributions differ between libraries, the engine does not.
double uniform(std::mt19937_64& engine) {
  return static_cast<double>(engine() >> 11U) / 9007199254740992.0;
}

TetComplex canonical(std::vector<Point3> points, std::vector<std::array<std::uint32_t, 4>> cells) {
  std::vector<std::uint32_t> first_copy(points.size());
  std::iota(first_copy.begin(), first_copy.end(), 0U);
  return make_canonical(std::move(points), std::move(cells), std::move(first_copy));
}

}  // namespace

TetComplex cube_grid(const std::array<std::uint32_t, 3>& counts, double jitter,
                     std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto index = [&](const std::array<std::uint32_t, 3>& at) {
    return (at[0] * (counts[1] + 1) + at[1]) * (counts[2] + 1) + at[2];
  };
  std::vector<Point3> points;
  std::vector<std::array<std::uint32_t, 4>> cells;
  for (std::uint32_t x = 0; x <= counts[0]; ++x) {
    for (std::uint32_t y = 0; y <= counts[1]; ++y) {
      for (std::uint32_t z = 0; z <= counts[2]; ++z) {
        Point3 point{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        for (double& coordinate : point) coordinate += jitter * (2 * uniform(engine) - 1);
        points.push_back(point);
        if (x == counts[0] || y == counts[1] || z == counts[2]) continue;
        // One tetrahedron for each order in which a path takes the three axes.
        std::array<int, 3> axes{0, 1, 2};
        do {
          std::array<std::uint32_t, 3> at{x, y, z};
          std::array<std::uint32_t, 4> cell{index(at)};
          for (int step = 0; step < 3; ++step) {
            ++at[axes[step]];
            cell[step + 1] = index(at);
          }
          const bool even = (axes[1] + 3 - axes[0]) % 3 == 1;
          if (!even) std::swap(cell[2], cell[3]);
          cells.push_back(cell);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
    }
  }
  return canonical(std::move(points), std::move(cells));
}

std::vector<std::uint32_t> cells_of_cube(const TetComplex& grid, double x, double y, double z) {
  std::vector<std::uint32_t> inside;
  for (std::uint32_t c = 0; c < grid.cells.size(); ++c) {
    const Point3 centre = cell_centroid(grid, c);
    if (centre[0] > x && centre[0] < x + 1 && centre[1] > y && centre[1] < y + 1 && centre[2] > z &&
        centre[2] < z + 1) {
      inside.push_back(c);
    }
  }
  return inside;
}

TetComplex regular_bipyramid() {
  return canonical({{0, 0, 0}, {3, 3, 0}, {3, 0, 3}, {0, 3, 3}, {4, 4, 4}},
                   {{0, 1, 3, 2}, {1, 2, 4, 3}});
}

FacetAreas labelled_areas(const TetComplex& complex, const FacetList& facets,
                          const CellLabels& initial, double unit, int area_bits) {
  FacetAreas areas = quantise_areas(complex, facets, unit, area_bits);
  areas.supported = support_by_labels(facets, areas, initial);
  return areas;
}

CellLabels random_labels(const TetComplex& complex, double share, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  CellLabels labels(complex.cells.size());
  for (std::uint8_t& label : labels) label = uniform(engine) < share ? kInterior : kExterior;
  return labels;
}

}  // namespace cellocut::testing
