// A star is never said to be embedded of which two faces meet elsewhere, and most stars of a smooth
// surface are said to be.
#include "cellocut/validity/embedded_stars.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cellocut/validity/incidence.h"
#include "cellocut/validity/triangle_pair.h"
#include "support/defective_meshes.h"

namespace cellocut {
namespace {

EmbeddedStars stars_of(const TriangleSoup& mesh) {
  return {mesh.points, mesh.triangles, corners_by_point(mesh.triangles, mesh.points.size())};
}

// Faces (0, k, k + 1) around point 0, closed, or open where the last is left out.
TriangleSoup wheel(const std::vector<Point3>& rim, bool closed) {
  TriangleSoup mesh;
  mesh.points = {{0, 0, 0}};
  mesh.points.insert(mesh.points.end(), rim.begin(), rim.end());
  const auto count = static_cast<std::uint32_t>(rim.size());
  for (std::uint32_t k = 0; k + (closed ? 0 : 1) < count; ++k) {
    mesh.triangles.push_back({0, 1 + k, 1 + (k + 1) % count});
  }
  return mesh;
}

// Points on a ring around the origin, `rounds` times around, at changing heights.
std::vector<Point3> ring(int count, int rounds, double height) {
  std::vector<Point3> points;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * 3.14159265358979 * rounds * k / count + 0.1;
    points.push_back({std::cos(angle), std::sin(angle), height * ((k * 7) % 5 - 2)});
  }
  return points;
}

bool faces_meet(const TriangleSoup& mesh) {
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (std::size_t g = 0; g < f; ++g) {
      if (faces_intersect(mesh.points, mesh.triangles[f], mesh.triangles[g])) return true;
    }
  }
  return false;
}

bool has_degenerate_face(const TriangleSoup& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
    return is_degenerate(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
  });
}

TEST(EmbeddedStars, KnowsAFanThatGoesAroundOnce) {
  EXPECT_TRUE(stars_of(wheel(ring(7, 1, 0.1), true)).embedded(0));
  EXPECT_TRUE(stars_of(wheel(ring(3, 1, 0), true)).embedded(0));
  EXPECT_FALSE(stars_of(wheel(ring(7, 1, 0.1), false)).embedded(0)) << "open";
  EXPECT_FALSE(stars_of(wheel(ring(7, 2, 0.1), true)).embedded(0)) << "twice around";
  EXPECT_FALSE(stars_of(wheel(ring(17, 1, 0.1), true)).embedded(0))
      << "more faces than it looks at";
  for (std::uint32_t v = 1; v < 8; ++v) {
    EXPECT_FALSE(stars_of(wheel(ring(7, 1, 0.1), true)).embedded(v)) << "on the border";
  }
  TriangleSoup doubled = wheel(ring(5, 1, 0.1), true);
  const std::vector<Triangle> faces = doubled.triangles;
  doubled.triangles.insert(doubled.triangles.end(), faces.begin(), faces.end());
  EXPECT_FALSE(stars_of(doubled).embedded(0));
}

// Rims of lattice points: spokes coincide, faces fold back, stand upright, lie in one plane.
TEST(EmbeddedStars, NeverSaysSoOfFacesThatMeet) {
  std::mt19937_64 random(3);
  int proved = 0;
  int meeting = 0;
  for (int round = 0; round < 40000; ++round) {
    const bool smooth = round % 2 == 0;
    std::vector<Point3> rim = ring(3 + static_cast<int>(random() % 5), 1 + round % 3 / 2, 0.1);
    for (Point3& p : rim) {
      for (double& x : p) {
        const double noise = (static_cast<double>(random() % 5) - 2) / 3;
        x = smooth ? x + noise : noise;
      }
    }
    const TriangleSoup mesh = wheel(rim, round % 7 != 0);
    const bool embedded = stars_of(mesh).embedded(0);
    if (has_degenerate_face(mesh)) {
      EXPECT_FALSE(embedded) << "round " << round;
      continue;
    }
    const bool meet = faces_meet(mesh);
    EXPECT_FALSE(meet && embedded) << "round " << round;
    proved += embedded ? 1 : 0;
    meeting += meet ? 1 : 0;
  }
  EXPECT_GT(proved, 2000);
  EXPECT_GT(meeting, 10000);
}

TEST(EmbeddedStars, KnowsMostOfASmoothSurface) {
  const TriangleSoup sphere = test::icosphere(4);
  const EmbeddedStars stars = stars_of(sphere);
  std::size_t embedded = 0;
  for (std::uint32_t v = 0; v < sphere.points.size(); ++v) embedded += stars.embedded(v) ? 1 : 0;
  EXPECT_EQ(embedded, sphere.points.size());
}

// Eight faces at once, against a look at each pair; a vertex whose star is not proved says nothing.
TEST(StarsOfFaces, SettlesFacesAtACommonVertex) {
  TriangleSoup sphere = test::icosphere(3);
  sphere.triangles.pop_back();  // the stars of three vertices are open
  const EmbeddedStars stars = stars_of(sphere);
  std::mt19937_64 random(5);
  int settled = 0;
  int not_proved = 0;
  for (std::size_t count = 1; count <= 8; ++count) {
    for (int round = 0; round < 50; ++round) {
      std::vector<std::uint32_t> ids(count);
      for (std::uint32_t& id : ids) {
        id = static_cast<std::uint32_t>(sphere.triangles.size() - 1 - random() % 40);
      }
      const StarsOfFaces faces(stars, sphere.triangles, ids);
      for (const Triangle& other : sphere.triangles) {
        unsigned expected = 0;
        for (std::size_t i = 0; i < count; ++i) {
          for (const std::uint32_t v : sphere.triangles[ids[i]]) {
            if (std::find(other.begin(), other.end(), v) == other.end()) continue;
            if (stars.embedded(v)) expected |= 1U << i;
            not_proved += stars.embedded(v) ? 0 : 1;
          }
        }
        ASSERT_EQ(faces.settled(other), expected);
        settled += expected != 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(settled, 1000);
  EXPECT_GT(not_proved, 100);
}

}  // namespace
}  // namespace cellocut
