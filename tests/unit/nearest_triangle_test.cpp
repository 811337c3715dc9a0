// The nearest point of a soup against all of its triangles, one by one.
#include "cellocut/measure/nearest_triangle.h"

#include <gtest/gtest.h>

#include <random>

#include "support/defective_meshes.h"

namespace cellocut {
namespace {

TriangleSoup random_soup(int faces, double size, double scale, const Point3& offset,
                         unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  TriangleSoup soup;
  for (int f = 0; f < faces; ++f) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    const Point3 at{coordinate(random), coordinate(random), coordinate(random)};
    for (int k = 0; k < 3; ++k) {
      const Point3 side{coordinate(random), coordinate(random), coordinate(random)};
      soup.points.push_back(offset + scale * (at + size * side));
    }
    soup.triangles.push_back({first, first + 1, f % 7 == 0 ? first : first + 2});
  }
  return soup;
}

void expect_minimum_over_all_faces(double size, double scale) {
  const TriangleSoup soup = random_soup(300, size, scale, Point3{scale, 5 * scale, -scale}, 5);
  const NearestTriangle nearest(soup);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> coordinate(-3, 8);
  for (int n = 0; n < 2000; ++n) {
    const Point3 p = scale * Point3{coordinate(random), coordinate(random), coordinate(random)};
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : soup.triangles) {
      const Point3 q = (1 / scale) * p;
      const Point3 on =
          nearest_on_triangle(q, (1 / scale) * soup.points[t[0]], (1 / scale) * soup.points[t[1]],
                              (1 / scale) * soup.points[t[2]]);
      least = std::min(least, norm(q - on));
    }
    const NearestPoint found = nearest(p);
    ASSERT_TRUE(found.found());
    EXPECT_NEAR(found.distance / scale, least, 1e-13);
    EXPECT_NEAR(norm((1 / scale) * (p - found.point)), least, 1e-13);
  }
}

TEST(NearestTriangle, IsTheMinimumOverAllFaces) {
  for (const double scale : {1e-40, 1.0, 1e90}) {
    for (const double size : {0.05, 0.2, 1.0}) expect_minimum_over_all_faces(size, scale);
  }
}

TEST(NearestTriangle, KeepsToTheLimit) {
  TriangleSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}, {2, 1, 0}};
  const NearestTriangle nearest(soup);
  EXPECT_FALSE(nearest({0.25, 0.25, 2}, 1.99).found());
  const NearestPoint found = nearest({0.25, 0.25, 2}, 2.01);
  ASSERT_TRUE(found.found());
  EXPECT_EQ(found.face, 0U) << "the lower of two at the same distance";
  EXPECT_EQ(found.point, (Point3{0.25, 0.25, 0}));
  EXPECT_EQ(found.distance, 2);
}

TEST(NearestTriangle, SeparatesWhatLiesOnBothSidesOfAFace) {
  const NearestTriangle sphere(test::icosphere(3));
  EXPECT_TRUE(sphere.may_separate({0.9, 0.1, 0.2}, {1.2, 0.1, 0.2}));
  EXPECT_FALSE(sphere.may_separate({0.2, 0.1, 0.2}, {0.5, 0.1, 0.2}));
  EXPECT_FALSE(sphere.may_separate({1.05, -0.3, 0.1}, {1.05, 0.3, 0.1})) << "outside";
  // Corner to corner and along an edge: it touches, so it may.
  const TriangleSoup soup = test::icosphere(1);
  const NearestTriangle coarse(soup);
  for (const Triangle& t : soup.triangles) {
    const Point3 corner = soup.points[t[0]];
    EXPECT_TRUE(coarse.may_separate(0.9 * corner, 1.1 * corner));
    EXPECT_TRUE(coarse.may_separate(corner, soup.points[t[1]]));
    EXPECT_FALSE(coarse.may_separate(1.1 * corner, 1.2 * corner));
  }
}

TEST(NearestTriangle, OfNothingIsNotFound) {
  EXPECT_FALSE(NearestTriangle(TriangleSoup{})({0, 0, 0}).found());
  TriangleSoup soup;
  soup.points = {{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<double>::quiet_NaN(), 0}};
  soup.triangles = {{0, 1, 2}};
  EXPECT_FALSE(NearestTriangle(soup)({0, 0, 0}).found());
}

TEST(NearestOnTriangle, RegionsOfATriangle) {
  const Point3 a{0, 0, 0};
  const Point3 b{2, 0, 0};
  const Point3 c{0, 2, 0};
  EXPECT_EQ(nearest_on_triangle({0.5, 0.5, 3}, a, b, c), (Point3{0.5, 0.5, 0}));
  EXPECT_EQ(nearest_on_triangle({-1, -1, 1}, a, b, c), a);
  EXPECT_EQ(nearest_on_triangle({5, -1, 1}, a, b, c), b);
  EXPECT_EQ(nearest_on_triangle({1, -1, 1}, a, b, c), (Point3{1, 0, 0}));
  EXPECT_EQ(nearest_on_triangle({2, 2, 1}, a, b, c), (Point3{1, 1, 0}));
  EXPECT_EQ(nearest_on_triangle({1, 1, 1}, a, a, a), a);
  EXPECT_EQ(nearest_on_triangle({1, 5, 1}, a, b, Point3{1, 0, 0}), (Point3{1, 0, 0}));
}

}  // namespace
}  // namespace cellocut
