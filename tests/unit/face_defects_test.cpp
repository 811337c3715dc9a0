// Which faces are part of a defect, by hand, and against the counts of the surface report.
#include "cellocut/validity/face_defects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cellocut/validity/surface_report.h"
#include "support/defective_meshes.h"

namespace cellocut::testing {
namespace {

using Flags = std::vector<std::uint8_t>;

// Three faces on one edge, a face apart that the first one crosses, one without area and one with a
// corner at infinity.
TEST(FaceDefects, OfAMeshByHand) {
  TriangleSoup mesh;
  mesh.points = {{0, 0, 0},   {1, 0, 0},      {0.5, 1, 0},   {0.5, -1, 0},
                 {0.5, 0, 1}, {0.5, 0.2, -1}, {0.6, 0.2, 1}, {0.4, 0.3, 1},
                 {5, 5, 5},   {6, 6, 6},      {7, 7, 7},     {8, 8, INFINITY}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 1, 4}, {5, 6, 7}, {8, 9, 10}, {8, 9, 11}};
  const FaceDefects defects = find_face_defects(mesh);
  EXPECT_EQ(defects.nonmanifold, (Flags{1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(defects.intersecting, (Flags{1, 0, 0, 1, 0, 0}));
  EXPECT_EQ(defects.degenerate, (Flags{0, 0, 0, 0, 1, 1}));
  EXPECT_EQ(defects.boundary, (Flags{1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(defects.gravest(), (Flags{4, 2, 2, 4, 3, 3}));
}

// Corners that have their own points, as in STL, are no boundary.
TEST(FaceDefects, OfASolidWithoutSharedPointsAreNone) {
  const TriangleSoup whole{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                           {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}},
                           {}};
  TriangleSoup soup;
  for (const Triangle& t : whole.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (const std::uint32_t v : t) soup.points.push_back(whole.points[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  for (const TriangleSoup& mesh : {whole, soup}) {
    EXPECT_EQ(find_face_defects(mesh).gravest(), Flags(4, 0));
  }
}

TEST(FaceDefects, AreThereWhereTheReportCountsThem) {
  for (const TriangleSoup& mesh :
       {test::two_crossing_boxes(), test::sphere_with_hole(), test::moebius_strip()}) {
    const SurfaceReport report = inspect_surface(mesh, {.max_pairs = 1U << 20U});
    const FaceDefects defects = find_face_defects(mesh);
    const auto some = [](const Flags& flags) { return std::count(flags.begin(), flags.end(), 1); };
    EXPECT_EQ(some(defects.boundary) > 0, report.by_position.boundary_edges > 0);
    EXPECT_LE(some(defects.boundary), report.by_position.boundary_edges);
    EXPECT_EQ(some(defects.nonmanifold) > 0, report.by_position.nonmanifold_edges > 0);
    Flags in_pairs(mesh.triangles.size(), 0);
    for (const auto& [f, g] : report.pairs) in_pairs[f] = in_pairs[g] = 1;
    EXPECT_EQ(defects.intersecting, in_pairs);
  }
}

}  // namespace
}  // namespace cellocut::testing
