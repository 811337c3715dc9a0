#include "cellocut/complex/tet_complex.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "cellocut/base/buckets.h"
#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

// The corners other than k, in the order in which they are seen counter-clockwise from outside.
constexpr int kOutward[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

// A facet among those with the same smallest corner.
struct FacetKey {
  std::uint64_t others;  // its other corners, the smaller first
  std::uint32_t side;    // 4 * cell + corner that the facet is opposite to
  bool operator<(const FacetKey& b) const {
    return others != b.others ? others < b.others : side < b.side;
  }
};

std::uint64_t pair_key(std::uint32_t first, std::uint32_t second) {
  return std::uint64_t{first} << 32U | second;
}

// Ascending corners, the last two swapped where that order is negatively oriented: the number of
// transpositions that sort a positively oriented quadruple tells which.
void sort_corners(std::array<std::uint32_t, 4>& cell) {
  bool odd = false;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3 - i; ++j) {
      if (cell[j] > cell[j + 1]) {
        std::swap(cell[j], cell[j + 1]);
        odd = !odd;
      }
    }
  }
  if (odd) std::swap(cell[2], cell[3]);
}

std::array<std::uint32_t, 4> ascending(std::array<std::uint32_t, 4> cell) {
  if (cell[2] > cell[3]) std::swap(cell[2], cell[3]);
  return cell;
}

}  // namespace

std::array<std::uint32_t, 3> facet_outward(const TetComplex& complex, std::uint32_t cell, int k) {
  const std::array<std::uint32_t, 4>& corners = complex.cells[cell];
  return {corners[kOutward[k][0]], corners[kOutward[k][1]], corners[kOutward[k][2]]};
}

std::array<std::uint32_t, 3> facet_corners(const TetComplex& complex, std::uint32_t cell, int k) {
  std::array<std::uint32_t, 3> corners = facet_outward(complex, cell, k);
  std::sort(corners.begin(), corners.end());
  return corners;
}

Point3 cell_centroid(const TetComplex& complex, std::uint32_t cell) {
  const std::array<std::uint32_t, 4> c = ascending(complex.cells[cell]);
  return 0.25 * (((complex.points[c[0]] + complex.points[c[1]]) + complex.points[c[2]]) +
                 complex.points[c[3]]);
}

double cell_volume(const TetComplex& complex, std::uint32_t cell) {
  const std::array<std::uint32_t, 4>& c = complex.cells[cell];
  return six_volumes(complex.points[c[0]], complex.points[c[1]], complex.points[c[2]],
                     complex.points[c[3]]) /
         6;
}

namespace {

// In the order of their ascending corners. (By the first of them: each point has a few such cells.)
std::vector<std::array<std::uint32_t, 4>> sorted(
    const std::vector<std::array<std::uint32_t, 4>>& cells, std::size_t points) {
  const Buckets by_first(points, cells.size(), [&](std::size_t c) { return cells[c][0]; });
  std::vector<std::array<std::uint32_t, 4>> result(cells.size());
  tbb::parallel_for(std::size_t{0}, points, [&](std::size_t point) {
    const auto begin = result.begin() + static_cast<std::ptrdiff_t>(by_first.begin(point));
    auto end = begin;
    for (const std::uint32_t c : by_first[point]) *end++ = cells[c];
    std::sort(begin, end, [](const auto& cell, const auto& other) {
      const std::array<std::uint32_t, 4> a = ascending(cell);
      const std::array<std::uint32_t, 4> b = ascending(other);
      const std::uint64_t key = pair_key(a[1], a[2]);
      const std::uint64_t other_key = pair_key(b[1], b[2]);
      return key != other_key ? key < other_key : a[3] < b[3];
    });
  });
  return result;
}

// Precondition: the facets are sorted, so that equal ones are next to each other.
void link(const std::vector<FacetKey>& facets,
          std::vector<std::array<std::int32_t, 4>>& neighbours) {
  for (std::size_t f = 0; f + 1 < facets.size(); ++f) {
    if (facets[f].others != facets[f + 1].others) continue;
    if (f + 2 < facets.size() && facets[f].others == facets[f + 2].others) {
      throw Error("tetrahedralization: a facet belongs to three cells");
    }
    const std::uint32_t a = facets[f].side;
    const std::uint32_t b = facets[f + 1].side;
    neighbours[a / 4][a % 4] = static_cast<std::int32_t>(b / 4);
    neighbours[b / 4][b % 4] = static_cast<std::int32_t>(a / 4);
  }
}

}  // namespace

TetComplex make_canonical(std::vector<Point3> points,
                          std::vector<std::array<std::uint32_t, 4>> cells,
                          std::vector<std::uint32_t> first_copy) {
  tbb::parallel_for(std::size_t{0}, cells.size(), [&](std::size_t c) { sort_corners(cells[c]); });
  TetComplex complex;
  complex.points = std::move(points);
  complex.cells = sorted(cells, complex.points.size());
  complex.first_copy = std::move(first_copy);
  complex.neighbours.assign(complex.cells.size(), {kOutside, kOutside, kOutside, kOutside});

  // The two sides of a facet have the same smallest corner.
  const Buckets by_smallest(complex.points.size(), 4 * complex.cells.size(), [&](std::size_t side) {
    const std::array<std::uint32_t, 4>& corners = complex.cells[side / 4];
    return side % 4 == 0 ? corners[1] : corners[0];
  });
  const tbb::blocked_range<std::size_t> all(0, complex.points.size(), 64);
  tbb::parallel_for(all, [&](const auto& range) {
    std::vector<FacetKey> facets;
    for (std::size_t point = range.begin(); point < range.end(); ++point) {
      facets.clear();
      for (const std::uint32_t side : by_smallest[point]) {
        const std::array<std::uint32_t, 4>& corners = complex.cells[side / 4];
        const std::uint32_t k = side % 4;
        const auto [second, third] = std::minmax(corners[k < 2 ? 2 : 1], corners[k == 3 ? 2 : 3]);
        facets.push_back({pair_key(second, third), side});
      }
      std::sort(facets.begin(), facets.end());
      link(facets, complex.neighbours);
    }
  });
  return complex;
}

double differing_cell_share(const TetComplex& a, const TetComplex& b) {
  const auto quadruples = [](const TetComplex& complex) {
    auto cells = complex.cells;
    for (auto& cell : cells) std::sort(cell.begin(), cell.end());
    std::sort(cells.begin(), cells.end());
    return cells;
  };
  const auto cells_a = quadruples(a);
  const auto cells_b = quadruples(b);
  std::vector<std::array<std::uint32_t, 4>> common;
  std::set_intersection(cells_a.begin(), cells_a.end(), cells_b.begin(), cells_b.end(),
                        std::back_inserter(common));
  return 1 - static_cast<double>(common.size()) /
                 static_cast<double>(std::max(cells_a.size(), cells_b.size()));
}

}  // namespace cellocut
