// Provenance against all triangles one by one, and transferred colours with known answers.
#include "cellocut/surface/provenance.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <random>

namespace cellocut {
namespace {

TriangleSoup random_soup(int faces, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  TriangleSoup soup;
  for (int f = 0; f < faces; ++f) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    const Point3 at{coordinate(random), coordinate(random), coordinate(random)};
    for (int k = 0; k < 3; ++k) {
      const Point3 side{coordinate(random), coordinate(random), coordinate(random)};
      soup.points.push_back(at + 0.2 * side);
      soup.colours.push_back({static_cast<std::uint8_t>(random()),
                              static_cast<std::uint8_t>(random()),
                              static_cast<std::uint8_t>(random())});
    }
    soup.triangles.push_back({first, first + 1, f % 7 == 0 ? first : first + 2});
  }
  return soup;
}

TEST(Provenance, IsTheNearestOfAllFaces) {
  const TriangleSoup input = random_soup(200, 3);
  const TriangleSoup surface = random_soup(300, 4);
  std::vector<std::uint8_t> supported(surface.points.size());
  for (std::size_t v = 0; v < supported.size(); ++v) supported[v] = v % 3 == 0 ? 1 : 0;
  const Provenance found =
      trace_provenance(surface, supported, input, NearestTriangle(input), true);
  ASSERT_EQ(found.nearest_face.size(), surface.points.size());
  EXPECT_EQ(found.supported, supported);
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : input.triangles) {
      const Point3 on = nearest_on_triangle(surface.points[v], input.points[t[0]],
                                            input.points[t[1]], input.points[t[2]]);
      least = std::min(least, norm(surface.points[v] - on));
    }
    EXPECT_NEAR(found.distance[v], least, 1e-14);
    const auto face = static_cast<std::size_t>(found.nearest_face[v]);
    ASSERT_LT(face, input.triangles.size());
    const Triangle& t = input.triangles[face];
    const Point3 on = nearest_on_triangle(surface.points[v], input.points[t[0]], input.points[t[1]],
                                          input.points[t[2]]);
    EXPECT_NEAR(norm(surface.points[v] - on), least, 1e-14);
    const Rgb colour = colour_at(input, t, on);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found.colours[v][k], colour[k], 1);
  }
}

TEST(Provenance, SameForAnyNumberOfThreads) {
  const TriangleSoup input = random_soup(500, 5);
  const TriangleSoup surface = random_soup(2000, 6);
  const std::vector<std::uint8_t> supported(surface.points.size(), 1);
  const NearestTriangle nearest(input);
  const Provenance all = trace_provenance(surface, supported, input, nearest, true);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Provenance alone = trace_provenance(surface, supported, input, nearest, true);
  EXPECT_EQ(all.nearest_face, alone.nearest_face);
  EXPECT_EQ(all.distance, alone.distance);
  EXPECT_EQ(all.colours, alone.colours);
}

TEST(Provenance, AttributesUnderTheirNames) {
  const TriangleSoup input = random_soup(10, 5);
  const std::vector<std::uint8_t> supported(input.points.size(), 1);
  const Provenance found = trace_provenance(input, supported, input, NearestTriangle(input), false);
  EXPECT_TRUE(found.colours.empty());
  const std::vector<VertexAttribute> attributes = found.attributes();
  ASSERT_EQ(attributes.size(), 3u);
  EXPECT_EQ(attributes[0].name, "nearest_face");
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(attributes[0].values), found.nearest_face);
  EXPECT_EQ(attributes[1].name, "distance");
  EXPECT_EQ(std::get<std::vector<double>>(attributes[1].values), found.distance);
  EXPECT_EQ(attributes[2].name, "supported");
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(attributes[2].values), supported);
}

TEST(Provenance, OfAnInputWithoutFiniteFaces) {
  TriangleSoup input;
  input.points = {{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<double>::quiet_NaN(), 0}};
  input.triangles = {{0, 1, 2}};
  TriangleSoup surface;
  surface.points = {{0, 0, 0}};
  const Provenance found = trace_provenance(surface, {0}, input, NearestTriangle(input), false);
  EXPECT_EQ(found.nearest_face, std::vector<std::int32_t>{-1});
  EXPECT_TRUE(std::isnan(found.distance[0]));
}

// A plate of two squares, the left one red, the right one blue, with points of their own.
TEST(TransferColour, PlateOfTwoColours) {
  TriangleSoup plate;
  for (const double x : {0.0, 1.0}) {
    const auto first = static_cast<std::uint32_t>(plate.points.size());
    for (const Point3& corner :
         {Point3{x, 0, 0}, Point3{x + 1, 0, 0}, Point3{x + 1, 1, 0}, Point3{x, 1, 0}}) {
      plate.points.push_back(corner);
      plate.colours.push_back(x == 0 ? Rgb{255, 0, 0} : Rgb{0, 0, 255});
    }
    plate.triangles.push_back({first, first + 1, first + 2});
    plate.triangles.push_back({first, first + 2, first + 3});
  }
  TriangleSoup surface;
  surface.points = {
      {0.5, 0.25, 0.1}, {0.25, 0.5, -0.1}, {1.5, 0.25, 0.1}, {1.25, 0.5, 2}, {9, 0, 0}};
  const Provenance found = trace_provenance(surface, std::vector<std::uint8_t>(5, 1), plate,
                                            NearestTriangle(plate), true);
  EXPECT_EQ(found.nearest_face, (std::vector<std::int32_t>{0, 1, 2, 3, 2}));
  const std::vector<double> distance{0.1, 0.1, 0.1, 2, 7};
  for (std::size_t v = 0; v < 5; ++v) EXPECT_NEAR(found.distance[v], distance[v], 1e-15);
  EXPECT_EQ(found.colours,
            (std::vector<Rgb>{{255, 0, 0}, {255, 0, 0}, {0, 0, 255}, {0, 0, 255}, {0, 0, 255}}));
}

TriangleSoup one_triangle(const Point3& a, const Point3& b, const Point3& c) {
  TriangleSoup soup;
  soup.points = {a, b, c};
  soup.triangles = {{0, 1, 2}};
  soup.colours = {{200, 0, 0}, {0, 100, 0}, {0, 0, 50}};
  return soup;
}

TEST(TransferColour, LinearInsideATriangle) {
  for (const double scale : {1e-90, 1.0, 1e90}) {
    const TriangleSoup soup = one_triangle({0, 0, 0}, {scale, 0, 0}, {0, scale, 0});
    const Triangle t = soup.triangles[0];
    EXPECT_EQ(colour_at(soup, t, soup.points[0]), (Rgb{200, 0, 0}));
    EXPECT_EQ(colour_at(soup, t, soup.points[1]), (Rgb{0, 100, 0}));
    EXPECT_EQ(colour_at(soup, t, soup.points[2]), (Rgb{0, 0, 50}));
    EXPECT_EQ(colour_at(soup, t, {scale / 2, 0, 0}), (Rgb{100, 50, 0}));
    EXPECT_EQ(colour_at(soup, t, {scale / 4, scale / 2, 0}), (Rgb{50, 25, 25}));
    EXPECT_EQ(colour_at(soup, t, {-scale, -scale, 0}), (Rgb{200, 0, 0})) << "outside: clamped";
  }
}

TEST(TransferColour, TrianglesWithoutArea) {
  // The third corner in the middle of the longest edge; whichever corner it is.
  const TriangleSoup middle_last = one_triangle({0, 0, 0}, {4, 4, 4}, {1, 1, 1});
  EXPECT_EQ(colour_at(middle_last, {0, 1, 2}, {1, 1, 1}), (Rgb{0, 0, 50}));
  EXPECT_EQ(colour_at(middle_last, {0, 1, 2}, {0.5, 0.5, 0.5}), (Rgb{100, 0, 25}));
  EXPECT_EQ(colour_at(middle_last, {1, 2, 0}, {2.5, 2.5, 2.5}), (Rgb{0, 50, 25}));
  EXPECT_EQ(colour_at(middle_last, {2, 0, 1}, {4, 4, 4}), (Rgb{0, 100, 0}));
  EXPECT_EQ(colour_at(middle_last, {2, 0, 1}, {0, 0, 0}), (Rgb{200, 0, 0}));
  // Two corners equal, or named twice; all equal.
  const TriangleSoup two = one_triangle({0, 0, 0}, {1, 0, 0}, {1, 0, 0});
  EXPECT_EQ(colour_at(two, {0, 1, 2}, {0.5, 0, 0})[0], 100);
  EXPECT_EQ(colour_at(two, {0, 1, 1}, {0.5, 0, 0}), (Rgb{100, 50, 0}));
  EXPECT_EQ(colour_at(two, {0, 0, 0}, {0, 0, 0}), (Rgb{200, 0, 0}));
  // A height that is mostly rounding.
  const TriangleSoup sliver = one_triangle({0, 0, 0}, {1, 0, 0}, {0.5, 1e-13, 0});
  EXPECT_EQ(colour_at(sliver, {0, 1, 2}, {0.5, 0, 0}), (Rgb{0, 0, 50}));
}

}  // namespace
}  // namespace cellocut
