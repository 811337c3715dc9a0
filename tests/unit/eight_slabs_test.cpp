// What is said to lie beyond a face's slab never meets the face, at any scale; and the other side
// of a thin sheet is said to.
#include "cellocut/validity/eight_slabs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cellocut/validity/triangle_pair.h"

namespace cellocut {
namespace {

using Ids = std::vector<std::uint32_t>;

unsigned beyond(const EightSlabs& slabs, const TriangleSoup& mesh, std::uint32_t face) {
  const Triangle& t = mesh.triangles[face];
  return slabs.certainly_beyond(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
}

TriangleSoup random_faces(std::mt19937_64& random, std::size_t count, double scale, double flat) {
  TriangleSoup mesh;
  const auto coordinate = [&] { return scale * (static_cast<double>(random() >> 11) * 0x1p-53); };
  for (std::uint32_t f = 0; f < count; ++f) {
    for (int k = 0; k < 3; ++k)
      mesh.points.push_back({coordinate(), coordinate(), flat * coordinate()});
    mesh.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  return mesh;
}

TEST(EightSlabs, WhatLiesBeyondNeverMeetsTheFace) {
  std::mt19937_64 random(7);
  for (const double scale : {1e-30, 1e-6, 1.0, 1e6, 1e25}) {
    int proved = 0;
    int meeting = 0;
    for (int round = 0; round < 400; ++round) {
      // Lattice corners now and then: faces touch, or lie in one plane.
      TriangleSoup mesh = random_faces(random, 16, scale, round % 3 == 0 ? 1e-7 : 1.0);
      if (round % 4 == 1) {
        for (Point3& p : mesh.points) {
          for (double& x : p) x = scale * std::floor(4 * x / scale);
        }
      }
      Ids ids(1 + random() % 8);
      for (std::uint32_t i = 0; i < ids.size(); ++i) ids[i] = i;
      const EightSlabs slabs(mesh.points, mesh.triangles, ids);
      for (std::uint32_t other = 8; other < 16; ++other) {
        const unsigned bits = beyond(slabs, mesh, other);
        EXPECT_EQ(bits >> ids.size(), 0U) << "a face that is not there";
        for (std::uint32_t i = 0; i < ids.size(); ++i) {
          const Triangle& s = mesh.triangles[i];
          const Triangle& t = mesh.triangles[other];
          const auto degenerate = [&](const Triangle& f) {
            return is_degenerate(mesh.points[f[0]], mesh.points[f[1]], mesh.points[f[2]]);
          };
          if (degenerate(s) || degenerate(t)) continue;
          const bool meet = faces_intersect(mesh.points, s, t);
          const bool said = (bits >> i & 1U) != 0;
          EXPECT_FALSE(said && meet) << "scale " << scale << ", round " << round;
          proved += said ? 1 : 0;
          meeting += meet ? 1 : 0;
        }
      }
    }
    EXPECT_GT(proved, 1000) << scale;
    EXPECT_GT(meeting, 500) << scale;
  }
}

TEST(EightSlabs, SaysNothingOfFacesWithACommonCornerOrPlane) {
  TriangleSoup mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-3}, {5, 5, 0}, {6, 5, 0}, {5, 6, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {4, 5, 6}};
  const EightSlabs slabs(mesh.points, mesh.triangles, Ids{0});
  EXPECT_EQ(beyond(slabs, mesh, 1), 0U) << "a common edge";
  EXPECT_EQ(beyond(slabs, mesh, 2), 0U) << "in the plane, elsewhere";
}

// Faces at a height over a bumpy sheet, where it is a hundredth of their size.
TEST(EightSlabs, KnowsTheOtherSideOfASheet) {
  TriangleSoup mesh;
  const auto height = [](double x, double y) { return 0.1 * std::sin(x) * std::cos(y); };
  for (const double lift : {0.0, 0.01}) {
    for (int n = 0; n < 8; ++n) {
      const double x = 100 + 0.3 * n;
      for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {0.3, 0.0}, {0.0, 0.3}}) {
        mesh.points.push_back({x + dx, dy, 1000 + height(x, 0) + lift + 0.2 * dx});
      }
      const auto first = static_cast<std::uint32_t>(mesh.points.size() - 3);
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }
  const EightSlabs slabs(mesh.points, mesh.triangles, Ids{0, 1, 2, 3, 4, 5, 6, 7});
  for (std::uint32_t n = 0; n < 8; ++n) {
    EXPECT_NE(beyond(slabs, mesh, 8 + n) >> n & 1U, 0U) << n;
    EXPECT_EQ(beyond(slabs, mesh, n) >> n & 1U, 0U) << "itself";
  }
}

TEST(EightSlabs, MakesNoProofBeyondSinglePrecision) {
  TriangleSoup mesh;
  for (const double z : {0.0, 1e200}) {
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1e200, 0.0}, {0.0, 1e200}}) {
      mesh.points.push_back({x, y, z});
    }
  }
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(beyond(EightSlabs(mesh.points, mesh.triangles, Ids{0}), mesh, 1), 0U);
}

}  // namespace
}  // namespace cellocut
