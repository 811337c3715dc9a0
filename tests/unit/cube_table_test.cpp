// The 256 cases of the iso-surface, alone and in pairs across a face, with vertices anywhere inside
// their edges, judged by exact predicates.
#include "cellocut/surface/cube_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "cellocut/base/predicates.h"
#include "cellocut/surface/iso_surface.h"
#include "cellocut/validity/surface_report.h"

namespace cellocut::testing {
namespace {

using DirectedEdge = std::pair<int, int>;
using Offset = std::array<int, 3>;

bool inside(int pattern, int corner) { return ((pattern >> corner) & 1) != 0; }
Offset corner_offset(int corner) { return {corner & 1, (corner >> 1) & 1, corner >> 2}; }
int high_corner(int edge) { return edge_low_corner(edge) + (1 << edge_axis(edge)); }
bool is_cut(int pattern, int edge) {
  return inside(pattern, edge_low_corner(edge)) != inside(pattern, high_corner(edge));
}

Point3 middle(int edge) {
  const Offset low = corner_offset(edge_low_corner(edge));
  Point3 p{static_cast<double>(low[0]), static_cast<double>(low[1]), static_cast<double>(low[2])};
  p[edge_axis(edge)] += 0.5;
  return p;
}

// Whether an edge lies in the face of the cell across `axis` at `side`.
bool edge_in_face(int edge, int axis, int side) {
  return edge_axis(edge) != axis && corner_offset(edge_low_corner(edge))[axis] == side;
}
// Whether a corner of a triangle does; the inner point lies in none.
bool vertex_in_face(int vertex, int axis, int side) {
  return vertex != kInnerPoint && edge_in_face(vertex, axis, side);
}

// The segments of one face by their definition: two cut edges are joined; of four, those that meet
// in an outside corner. Directed so that the outside is on the right seen from outside the cell,
// which is how a surface with its normal to the outside meets the face.
std::set<DirectedEdge> expected_segments(int pattern, int axis, int side) {
  std::vector<int> cut;
  for (int e = 0; e < 12; ++e) {
    if (edge_in_face(e, axis, side) && is_cut(pattern, e)) cut.push_back(e);
  }
  std::set<DirectedEdge> segments;
  const auto join = [&](int a, int b) {
    Point3 normal{};
    normal[axis] = side == 0 ? -1 : 1;
    const Point3 to_outside = cross(normal, middle(b) - middle(a));
    const Offset low = corner_offset(edge_low_corner(a));
    const Point3 low_end{static_cast<double>(low[0]), static_cast<double>(low[1]),
                         static_cast<double>(low[2])};
    const double sense = inside(pattern, edge_low_corner(a)) ? 1 : -1;
    const bool right_way = sense * dot(to_outside, middle(a) - low_end) > 0;
    segments.insert(right_way ? DirectedEdge{a, b} : DirectedEdge{b, a});
  };
  if (cut.size() == 2) join(cut[0], cut[1]);
  if (cut.size() == 4) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        for (const int corner : {edge_low_corner(cut[i]), high_corner(cut[i])}) {
          const bool shared = corner == edge_low_corner(cut[j]) || corner == high_corner(cut[j]);
          if (shared && !inside(pattern, corner)) join(cut[i], cut[j]);
        }
      }
    }
  }
  return segments;
}

TEST(CubeTable, EdgesHaveTheirOwnPlaces) {
  std::set<std::pair<int, int>> edges;
  for (int e = 0; e < 12; ++e) {
    EXPECT_EQ(edge_low_corner(e) & (1 << edge_axis(e)), 0);
    edges.insert({edge_low_corner(e), high_corner(e)});
  }
  EXPECT_EQ(edges.size(), 12U);
}

TEST(CubeTable, TheBoundaryOfEachCaseIsTheSegmentsOfItsFaces) {
  for (int pattern = 0; pattern < 256; ++pattern) {
    SCOPED_TRACE(pattern);
    std::multiset<DirectedEdge> edges;
    for (const auto& t : cube_table()[pattern].triangles) {
      for (int k = 0; k < 3; ++k) edges.insert({t[k], t[(k + 1) % 3]});
    }
    std::set<DirectedEdge> boundary;
    for (const auto& [a, b] : edges) {
      EXPECT_EQ(edges.count({a, b}), 1U);
      if (edges.count({b, a}) == 0) boundary.insert({a, b});
    }
    std::set<DirectedEdge> expected;
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) expected.merge(expected_segments(pattern, axis, side));
    }
    EXPECT_EQ(boundary, expected);
  }
}

TEST(CubeTable, UsesEveryCutEdgeAndNoTriangleLiesInAFace) {
  for (int pattern = 0; pattern < 256; ++pattern) {
    SCOPED_TRACE(pattern);
    const CubeCase& cube = cube_table()[pattern];
    std::set<int> used;
    bool has_inner_point = false;
    for (const auto& t : cube.triangles) {
      for (const std::uint8_t v : t) {
        if (v == kInnerPoint) {
          has_inner_point = true;
        } else {
          used.insert(v);
        }
      }
      for (int axis = 0; axis < 3; ++axis) {
        for (int side = 0; side < 2; ++side) {
          EXPECT_FALSE(std::all_of(t.begin(), t.end(),
                                   [&](int v) { return vertex_in_face(v, axis, side); }));
        }
      }
    }
    EXPECT_EQ(has_inner_point, !cube.inner_loop.empty());
    for (int e = 0; e < 12; ++e) EXPECT_EQ(used.count(e) == 1, is_cut(pattern, e)) << e;
  }
}

// Two inside corners that a cell joins or separates, by the number of components of the case.
TEST(CubeTable, JoinsTheInside) {
  for (int pattern = 0; pattern < 256; ++pattern) {
    // Components of outside corners along edges, of inside corners along edges and across faces.
    const auto components = [pattern](bool of_inside) {
      std::set<int> left;
      for (int c = 0; c < 8; ++c) {
        if (inside(pattern, c) == of_inside) left.insert(c);
      }
      int count = 0;
      while (!left.empty()) {
        std::vector<int> stack{*left.begin()};
        left.erase(left.begin());
        while (!stack.empty()) {
          const int c = stack.back();
          stack.pop_back();
          for (int d = 0; d < 8; ++d) {
            const int steps = __builtin_popcount(static_cast<unsigned>(c ^ d));
            if (steps <= (of_inside ? 3 : 1) && left.erase(d) != 0) stack.push_back(d);
          }
        }
        ++count;
      }
      return count;
    };
    // Sheets of the case.
    std::map<int, int> root;
    const std::function<int(int)> find = [&](int v) {
      return root.try_emplace(v, v).first->second == v ? v : find(root[v]);
    };
    for (const auto& t : cube_table()[pattern].triangles) {
      root[find(t[1])] = find(t[0]);
      root[find(t[2])] = find(t[0]);
    }
    int sheets = 0;
    for (const auto& [v, parent] : root) sheets += v == parent ? 1 : 0;
    // The inside is one piece; so each piece of the outside is behind a sheet of its own.
    const bool mixed = pattern != 0 && pattern != 255;
    EXPECT_EQ(sheets, mixed ? components(false) : 0) << pattern;
    if (mixed) {
      EXPECT_EQ(components(true), 1);
    }
  }
}

// Cells side by side, with shared vertices at given places on the grid edges.
class Assembly {
 public:
  // place(cell corner offset + cell, axis): where on its edge the vertex lies.
  using Place = std::function<double(const Offset&, int)>;

  // Adds a cell of the pattern at `at`; `group` keeps the cells of one example apart from the
  // others.
  void add(int group, const Offset& at, int pattern, const Place& place) {
    const CubeCase& cube = cube_table()[pattern];
    const double shift = 4.0 * group;
    const auto vertex = [&](int edge) {
      const Offset corner = corner_offset(edge_low_corner(edge));
      const Offset low{at[0] + corner[0], at[1] + corner[1], at[2] + corner[2]};
      const int axis = edge_axis(edge);
      const auto [found, fresh] =
          numbers_.try_emplace({group, low, axis}, static_cast<std::uint32_t>(soup_.points.size()));
      if (fresh) {
        Point3 p{shift + low[0], static_cast<double>(low[1]), static_cast<double>(low[2])};
        p[axis] += place(low, axis);
        soup_.points.push_back(p);
      }
      return found->second;
    };
    std::uint32_t inner = 0;
    if (!cube.inner_loop.empty()) {
      Point3 sum{};
      for (const std::uint8_t edge : cube.inner_loop) sum = sum + soup_.points[vertex(edge)];
      inner = static_cast<std::uint32_t>(soup_.points.size());
      soup_.points.push_back((1.0 / static_cast<double>(cube.inner_loop.size())) * sum);
      for (int axis = 0; axis < 3; ++axis) {
        const double low = at[axis] + (axis == 0 ? shift : 0);
        EXPECT_GT(soup_.points.back()[axis], low);
        EXPECT_LT(soup_.points.back()[axis], low + 1);
      }
    }
    for (const auto& t : cube.triangles) {
      Triangle face{};
      for (int k = 0; k < 3; ++k) face[k] = t[k] == kInnerPoint ? inner : vertex(t[k]);
      soup_.triangles.push_back(face);
    }
  }

  void expect_embedded() const {
    const SurfaceReport report = inspect_surface(soup_);
    EXPECT_EQ(report.intersecting_pairs, 0);
    EXPECT_EQ(report.degenerate_faces, 0);
    EXPECT_EQ(report.by_index.nonmanifold_edges, 0);
    EXPECT_EQ(report.by_index.misoriented_edges, 0);
    EXPECT_EQ(report.by_index.nonmanifold_vertices, 0);
    EXPECT_EQ(report.by_position.nonmanifold_edges, 0);
    EXPECT_EQ(report.by_position.nonmanifold_vertices, 0);
  }

  [[nodiscard]] const TriangleSoup& soup() const { return soup_; }

 private:
  TriangleSoup soup_;
  std::map<std::tuple<int, Offset, int>, std::uint32_t> numbers_;
};

double random_place(std::mt19937_64& random) {
  return kClearance + (1 - 2 * kClearance) * (static_cast<double>(random() >> 34U) / 0x1p30);
}
double extreme_place(std::mt19937_64& random) {
  return random() % 2 == 0 ? kClearance : 1 - kClearance;
}

// Every combination of vertices at the ends of their ranges: up to 4096 examples a case.
TEST(CubeTable, EveryCaseIsEmbeddedForAllExtremes) {
  for (int pattern = 1; pattern < 255; ++pattern) {
    SCOPED_TRACE(pattern);
    std::vector<int> cut;
    for (int e = 0; e < 12; ++e) {
      if (is_cut(pattern, e)) cut.push_back(e);
    }
    Assembly assembly;
    for (int choice = 0; choice < (1 << cut.size()); ++choice) {
      assembly.add(choice, {0, 0, 0}, pattern, [&](const Offset& low, int axis) {
        int edge = 4 * axis;
        while (corner_offset(edge_low_corner(edge)) != low) ++edge;
        const auto bit = std::find(cut.begin(), cut.end(), edge) - cut.begin();
        return ((choice >> bit) & 1) != 0 ? kClearance : 1 - kClearance;
      });
    }
    ASSERT_FALSE(assembly.soup().empty());
    assembly.expect_embedded();
  }
}

TEST(CubeTable, EveryCaseIsEmbeddedForRandomVertices) {
  std::mt19937_64 random(1);
  Assembly assembly;
  for (int pattern = 1; pattern < 255; ++pattern) {
    for (int example = 0; example < 100; ++example) {
      assembly.add(100 * pattern + example, {0, 0, 0}, pattern,
                   [&](const Offset&, int) { return random_place(random); });
    }
  }
  assembly.expect_embedded();
}

// All pairs of cases that agree at the face between them.
void expect_pairs_embedded(int axis) {
  std::mt19937_64 random(2);
  for (int first = 1; first < 255; ++first) {
    SCOPED_TRACE(first);
    Assembly assembly;
    int group = 0;
    for (int second = 0; second < 256; ++second) {
      bool agree = true;
      for (int c = 0; c < 8; ++c) {
        if (corner_offset(c)[axis] == 1) {
          agree = agree && inside(first, c) == inside(second, c - (1 << axis));
        }
      }
      if (!agree) continue;
      for (int example = 0; example < 6; ++example) {
        const auto place = [&](const Offset&, int) {
          return example % 2 == 0 ? random_place(random) : extreme_place(random);
        };
        Offset beyond{};
        beyond[axis] = 1;
        assembly.add(group, {0, 0, 0}, first, place);
        assembly.add(group, beyond, second, place);
        ++group;
      }
    }
    ASSERT_EQ(group, 6 * 16);
    assembly.expect_embedded();
  }
}

TEST(CubeTable, PairsAcrossAFaceAreEmbeddedAlongX) { expect_pairs_embedded(0); }
TEST(CubeTable, PairsAcrossAFaceAreEmbeddedAlongY) { expect_pairs_embedded(1); }
TEST(CubeTable, PairsAcrossAFaceAreEmbeddedAlongZ) { expect_pairs_embedded(2); }

}  // namespace
}  // namespace cellocut::testing
