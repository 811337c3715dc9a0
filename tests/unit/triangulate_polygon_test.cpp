#include "cellocut/mesh/triangulate_polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "support/soup_operations.h"

namespace cellocut::mesh_io {
namespace {

struct Result {
  std::vector<Triangle> triangles;
  double area = 0;       // of all triangles
  Point3 vector_area{};  // equal length means that no triangle is turned over
  bool boundary_matches = false;
};

// Triangulates the polygon through `points` in order, or through the points that `corners` names.
Result triangulated(const std::vector<Point3>& points, std::vector<std::uint32_t> corners = {}) {
  if (corners.empty()) {
    corners.resize(points.size());
    std::iota(corners.begin(), corners.end(), 0u);
  }
  Result result;
  result.triangles.resize(corners.size() - 2);
  triangulate_polygon(points, corners, result.triangles);
  // Every inner edge is passed once each way, every edge of the outline once its own way.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    ++edges[{corners[i], corners[(i + 1) % corners.size()]}];
  }
  for (const Triangle& t : result.triangles) {
    const Point3 normal = 0.5 * cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    result.area += norm(normal);
    result.vector_area = result.vector_area + normal;
    for (int k = 0; k < 3; ++k) ++edges[{t[(k + 1) % 3], t[k]}];
  }
  result.boundary_matches = true;
  for (const auto& [edge, count] : edges) {
    const auto opposite = edges.find({edge.second, edge.first});
    if (opposite == edges.end() || opposite->second != count) result.boundary_matches = false;
  }
  return result;
}

void expect_area(const Result& result, double area) {
  EXPECT_TRUE(result.boundary_matches);
  EXPECT_NEAR(result.area, area, 1e-12 * area);
  EXPECT_NEAR(norm(result.vector_area), area, 1e-12 * area);
}

TEST(TriangulatePolygon, ConvexIsAFan) {
  std::vector<Point3> hexagon;
  for (int i = 0; i < 6; ++i) {
    hexagon.push_back({std::cos(i * std::numbers::pi / 3), 0, std::sin(i * std::numbers::pi / 3)});
  }
  EXPECT_EQ(triangulated(hexagon).triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}));
}

TEST(TriangulatePolygon, ReflexCornerOppositeToTheFan) {
  // An arrowhead: the fan around its first corner would leave the polygon.
  const std::vector<Point3> arrow{{0, 0, 0}, {-1, -1, 0}, {2, 0, 0}, {-1, 1, 0}};
  expect_area(triangulated(arrow), 2);
  const std::vector<Point3> from_another_corner{{-1, -1, 0}, {2, 0, 0}, {-1, 1, 0}, {0, 0, 0}};
  const Result result = triangulated(from_another_corner);
  expect_area(result, 2);
  for (const Triangle& t : result.triangles) {
    EXPECT_EQ(std::count(t.begin(), t.end(), 3u) + std::count(t.begin(), t.end(), 1u), 2);
  }
}

TEST(TriangulatePolygon, OrientationIsThatOfThePolygonInAnyDirection) {
  // The letter L in space; both ways around.
  TriangleSoup letter;
  letter.points = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  std::mt19937_64 random(5);
  for (int i = 0; i < 50; ++i) {
    const Point3 axis{static_cast<double>(random() % 7) - 3, static_cast<double>(random() % 7) - 3,
                      static_cast<double>(random() % 7) - 3.5};
    std::vector<Point3> points = test::rotated(letter, axis, i * 0.37).points;
    const Result result = triangulated(points);
    expect_area(result, 4);
    std::reverse(points.begin(), points.end());
    const Result reversed = triangulated(points);
    expect_area(reversed, 4);
    EXPECT_NEAR(norm(result.vector_area + reversed.vector_area), 0, 1e-12);
  }
}

TEST(TriangulatePolygon, CornersInTheMiddleOfEdges) {
  // A square with collinear corners, the first of them on an edge: the plain fan has flat
  // triangles.
  const std::vector<Point3> square{{1, 0, 0}, {2, 0, 0}, {2, 2, 0},
                                   {1, 2, 0}, {0, 2, 0}, {0, 0, 0}};
  const Result result = triangulated(square);
  expect_area(result, 4);
  for (const Triangle& t : result.triangles) {
    EXPECT_GT(triangle_area(square[t[0]], square[t[1]], square[t[2]]), 0.1);
  }
}

TEST(TriangulatePolygon, HoleOnABridge) {
  // The outline goes in along an edge, around the hole, and out along the same edge.
  const std::vector<Point3> points{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0},
                                   {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}};
  expect_area(triangulated(points, {0, 1, 2, 3, 0, 4, 5, 6, 7, 4}), 12);
}

TEST(TriangulatePolygon, ManyCorners) {
  // A star with 200 reflex corners.
  std::vector<Point3> star;
  double area = 0;
  for (int i = 0; i < 400; ++i) {
    const double radius = i % 2 == 0 ? 1 : 0.3;
    star.push_back({radius * std::cos(i * std::numbers::pi / 200),
                    radius * std::sin(i * std::numbers::pi / 200), 7});
  }
  for (int i = 0; i < 400; ++i) area += 0.5 * 0.3 * std::sin(std::numbers::pi / 200);
  const Result result = triangulated(star);
  EXPECT_TRUE(result.boundary_matches);
  EXPECT_NEAR(result.area, area, 1e-9);
}

TEST(TriangulatePolygon, WithoutATriangulationItIsAFan) {
  const std::vector<Triangle> fan{{0, 1, 2}, {0, 2, 3}};
  // Crosses itself, with and without a net area; all on a line; all in one point.
  EXPECT_EQ(triangulated({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).triangles, fan);
  EXPECT_EQ(triangulated({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 3, 0}}).triangles, fan);
  EXPECT_EQ(triangulated({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}}).triangles, fan);
  EXPECT_EQ(triangulated({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}).triangles, fan);
  // A corner twice in a row, an edge there and back, a corner on an edge far away.
  EXPECT_EQ(triangulated({{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {0, 2, 0}}).triangles, fan);
  EXPECT_EQ(triangulated({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {0, 1, 2, 1}).triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 1}}));
  EXPECT_EQ(triangulated({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 0, 0}, {0, 4, 0}}).triangles.size(),
            3u);
  // Too large for the normal to be finite.
  EXPECT_EQ(triangulated({{0, 0, 0}, {1e300, 0, 0}, {1e300, 1e300, 0}, {0, 1e300, 0}}).triangles,
            fan);
  // A pentagram: every turn is to the left, and yet it is not convex.
  std::vector<Point3> pentagram;
  for (int i = 0; i < 5; ++i) {
    pentagram.push_back(
        {std::cos(i * 0.8 * std::numbers::pi), std::sin(i * 0.8 * std::numbers::pi), 0});
  }
  EXPECT_EQ(triangulated(pentagram).triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

}  // namespace
}  // namespace cellocut::mesh_io
