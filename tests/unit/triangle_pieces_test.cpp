// Pieces cover their triangles, and are as short or as many as asked.
#include "cellocut/measure/triangle_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace cellocut {
namespace {

using Corners = std::array<Point3, 3>;

double area(const Corners& t) { return 0.5 * norm(cross(t[1] - t[0], t[2] - t[0])); }

double longest_edge(const Corners& t) {
  return std::max({norm(t[1] - t[0]), norm(t[2] - t[1]), norm(t[0] - t[2])});
}

const std::vector<Corners> kTriangles = {
    Corners{Point3{0, 0, 0}, Point3{0.9, 0.1, 0}, Point3{0.2, 0.7, 0.5}},
    Corners{Point3{0, 0, 0}, Point3{0.05, 0, 0}, Point3{0, 0.05, 0}},
    Corners{Point3{0, 0, 0}, Point3{1, 0.001, 0}, Point3{0.3, 0, 0.001}},
    Corners{Point3{0, 0, 1}, Point3{1, 0, 1}, Point3{0.5, 0, 1}}};

std::map<std::uint32_t, std::vector<Corners>> by_triangle(
    const std::vector<TrianglePiece>& pieces) {
  std::map<std::uint32_t, std::vector<Corners>> sorted;
  for (const TrianglePiece& piece : pieces) sorted[piece.triangle].push_back(piece.corners);
  return sorted;
}

TEST(TrianglePieces, CoverTheLongTrianglesAndNoOthers) {
  const auto pieces = by_triangle(cut_long_triangles(kTriangles, 0.1, 10'000));
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(pieces.count(1), 0U) << "a short one";
  for (const auto& [triangle, parts] : pieces) {
    double sum = 0;
    for (const Corners& part : parts) {
      sum += area(part);
      EXPECT_LE(longest_edge(part), 0.1);
    }
    EXPECT_NEAR(sum, area(kTriangles[triangle]), 1e-13);
    for (const Point3& corner : kTriangles[triangle]) {
      EXPECT_TRUE(std::any_of(parts.begin(), parts.end(),
                              [&](const Corners& part) {
                                return std::find(part.begin(), part.end(), corner) != part.end();
                              }))
          << "no piece at a corner of " << triangle;
    }
  }
}

TEST(TrianglePieces, AreNoMoreThanAsked) {
  const std::vector<TrianglePiece> pieces = cut_long_triangles(kTriangles, 1e-3, 50);
  EXPECT_EQ(pieces.size(), 50U);
  double sum = 0;
  for (const TrianglePiece& piece : pieces) sum += area(piece.corners);
  double whole = 0;
  for (const Corners& t : kTriangles) whole += area(t);
  EXPECT_NEAR(sum, whole, 1e-13);
  EXPECT_TRUE(cut_long_triangles(kTriangles, 1e-3, 3).empty()) << "four are long";
  EXPECT_TRUE(cut_long_triangles({}, 1, 10).empty());
}

}  // namespace
}  // namespace cellocut
