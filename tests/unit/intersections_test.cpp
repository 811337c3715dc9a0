// The intersection test against two references: CGAL's own self_intersections(), and exact
// constructions.
#include "cellocut/validity/intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "cellocut/mesh/mesh_file.h"
#include "cellocut/validity/surface_report.h"
#include "cgal_intersections.h"
#include "validity_meshes.h"

namespace cellocut {
namespace {

using testing::box;
using testing::flipped;
using testing::icosphere;
using testing::joined;
using testing::moebius_strip;
using testing::torus;

SurfaceReport full_report(const TriangleSoup& soup) {
  SurfaceCheckOptions options;
  options.max_pairs = std::numeric_limits<std::size_t>::max();
  return inspect_surface(soup, options);
}

// Returns the number of pairs.
std::size_t expect_equals_construction(const TriangleSoup& soup) {
  const SurfaceReport report = full_report(soup);
  const std::vector<FacePair> reference = testing::pairs_by_construction(soup);
  EXPECT_EQ(report.pairs, reference);
  EXPECT_EQ(report.intersecting_pairs, static_cast<std::int64_t>(reference.size()));
  return reference.size();
}

std::size_t expect_equals_cgal(const TriangleSoup& soup) {
  const SurfaceReport report = full_report(soup);
  const testing::CgalIntersections reference = testing::pairs_by_cgal(soup);
  EXPECT_EQ(report.pairs, reference.pairs);
  EXPECT_EQ(report.intersecting_pairs, static_cast<std::int64_t>(reference.pairs.size()));
  EXPECT_EQ(report.degenerate_faces, static_cast<std::int64_t>(reference.degenerate.size()));
  return reference.pairs.size();
}

std::size_t expect_equals_both(const TriangleSoup& soup) {
  expect_equals_cgal(soup);
  return expect_equals_construction(soup);
}

// Faces between random points of a small lattice: nearly everything is coplanar, collinear or
// shared.
TriangleSoup lattice_soup(std::uint32_t seed, int side, std::size_t faces) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> coordinate(0, side);
  std::uniform_int_distribution<int> layer(0, side / 2);
  TriangleSoup soup;
  for (std::uint32_t f = 0; f < faces; ++f) {
    for (int k = 0; k < 3; ++k) {
      soup.points.push_back({static_cast<double>(coordinate(random)),
                             static_cast<double>(coordinate(random)),
                             static_cast<double>(layer(random))});
    }
    soup.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
  }
  return soup;
}

TEST(Intersections, LatticeSoups) {
  std::size_t pairs = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    pairs += expect_equals_both(lattice_soup(seed, 2 + static_cast<int>(seed % 5), 60));
  }
  EXPECT_GT(pairs, 500U);
}

TEST(Intersections, FlatSoups) {  // all in one tilted plane that doubles hold exactly
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    TriangleSoup soup = lattice_soup(seed, 6, 40);
    for (Point3& p : soup.points) p[2] = 2 * p[0] - 3 * p[1];
    EXPECT_GT(expect_equals_both(soup), 0U);
  }
}

TEST(Intersections, RandomSoups) {
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    TriangleSoup soup;
    for (int i = 0; i < 40; ++i) {
      soup.points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    }
    std::uniform_int_distribution<std::uint32_t> point(0, 39);  // corners are shared by index
    for (int f = 0; f < 100; ++f) {
      soup.triangles.push_back({point(random), point(random), point(random)});
    }
    EXPECT_GT(expect_equals_both(soup), 0U);
  }
}

// Sizes over six decades: large faces over many small ones, and small ones inside large ones.
TEST(Intersections, FacesOfManySizes) {
  for (std::uint32_t seed = 0; seed < 2; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> coordinate(-1, 1);
    std::uniform_real_distribution<double> exponent(-6, 0);
    TriangleSoup soup = icosphere(3, 0.5);
    for (int f = 0; f < 400; ++f) {
      const double size = std::pow(10, exponent(random));
      const Point3 centre = soup.points[random() % soup.points.size()];
      const auto first = static_cast<std::uint32_t>(soup.points.size());
      for (int k = 0; k < 3; ++k) {
        const Point3 offset{coordinate(random), coordinate(random), coordinate(random)};
        soup.points.push_back(centre + size * offset);
      }
      soup.triangles.push_back({first, first + 1, first + 2});
    }
    EXPECT_GT(expect_equals_both(soup), 400U);
  }
}

TEST(Intersections, NoneOnEmbeddedMeshes) {
  EXPECT_EQ(expect_equals_cgal(box()), 0U);
  EXPECT_EQ(expect_equals_cgal(icosphere(5)), 0U);
  EXPECT_EQ(expect_equals_cgal(torus(50, 20, 1, 0.3)), 0U);
  EXPECT_EQ(expect_equals_cgal(joined(icosphere(4), flipped(icosphere(4, 0.99)))), 0U);
  EXPECT_EQ(expect_equals_cgal(moebius_strip(40)), 0U);
}

TEST(Intersections, PlantedInSpheres) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    TriangleSoup soup = icosphere(4);
    for (int i = 0; i < 20;
         ++i) {  // push points through the opposite side, or just through a neighbour
      Point3& p = soup.points[random() % soup.points.size()];
      p = (i % 2 == 0 ? -1.2 : 0.3) * p;
    }
    EXPECT_GT(expect_equals_cgal(soup), 20U);
  }
  EXPECT_GT(expect_equals_cgal(joined(icosphere(4), icosphere(4, 1, {0.3, 0, 0}))), 100U);
}

TEST(Intersections, CrossingBoxes) {
  EXPECT_GT(expect_equals_both(joined(box(), box({0.25, 0.25, -1}, {0.75, 0.75, 2}))), 0U);
  // Coplanar sides, one inside the other; sides that coincide; boxes that share a part of a side.
  EXPECT_GT(expect_equals_both(joined(box(), box({0.25, 0.25, 1}, {0.75, 0.75, 2}))), 0U);
  EXPECT_GT(expect_equals_both(joined(box(), box({0, 0, 1}, {1, 1, 2}))), 0U);
  EXPECT_GT(expect_equals_both(joined(box(), box({0.5, 0.5, 1}, {2, 2, 2}))), 0U);
  EXPECT_GT(expect_equals_both(joined(box(), box())), 0U);
}

TEST(Intersections, FoldOverAtAnEdge) {
  const std::vector<Point3> points{{0, 0, 0},      {1, 0, 0},       {0, 1, 0},   {1, 1, 0},
                                   {1, 1, 1e-300}, {0.25, 0.25, 0}, {0.5, -1, 0}};
  EXPECT_EQ(expect_equals_both({points, {{0, 1, 2}, {1, 0, 3}}}), 1U);  // folded flat
  EXPECT_EQ(expect_equals_both({points, {{0, 1, 2}, {1, 0, 4}}}), 0U);  // nearly flat
  EXPECT_EQ(expect_equals_both({points, {{0, 1, 2}, {1, 0, 5}}}), 1U);  // one inside the other
  EXPECT_EQ(expect_equals_both({points, {{0, 1, 2}, {1, 0, 6}}}), 0U);  // side by side
}

TEST(Intersections, FoldOverAtACorner) {
  const std::vector<Point3> points{{0, 0, 0},  {4, 0, 0},   {0, 4, 0},   {1, 1, 0}, {1, 1, 1},
                                   {-1, 1, 0}, {1, -1, 0},  {8, 0, 0},   {8, 0, 1}, {3, 3, 1},
                                   {3, 3, -1}, {-1, -1, 0}, {-1, -2, 0}, {2, 0, 0}};
  const auto pairs = [&](const Triangle& t) {
    return expect_equals_both({points, {{0, 1, 2}, t}});
  };
  EXPECT_EQ(pairs({0, 3, 4}), 1U);    // an edge inside the face
  EXPECT_EQ(pairs({0, 5, 6}), 0U);    // coplanar; its side passes through the corner: degenerate
  EXPECT_EQ(pairs({0, 3, 6}), 1U);    // coplanar, overlapping
  EXPECT_EQ(pairs({0, 7, 8}), 1U);    // an edge that goes on along an edge of the face
  EXPECT_EQ(pairs({0, 13, 4}), 1U);   // an edge that lies in an edge of the face
  EXPECT_EQ(pairs({0, 9, 10}), 1U);   // cuts through
  EXPECT_EQ(pairs({0, 11, 12}), 0U);  // coplanar, apart
}

TEST(Intersections, CopiesAndDegenerateFaces) {
  TriangleSoup soup = icosphere(1);
  soup.triangles.push_back(soup.triangles[3]);
  soup.triangles.push_back({soup.triangles[4][0], soup.triangles[4][2], soup.triangles[4][1]});
  soup.triangles.push_back({0, 0, 1});
  soup.points.push_back({0, 0, 0});
  soup.points.push_back(-1.0 * soup.points[5]);
  const auto last = static_cast<std::uint32_t>(soup.points.size()) - 1;
  soup.triangles.push_back({5, last - 1, last});  // a needle through the sphere
  EXPECT_EQ(expect_equals_both(soup), 2U);
}

TEST(Intersections, ExtremeScalesAndOffsets) {
  const TriangleSoup crossing = joined(icosphere(2), icosphere(2, 1, {0.5, 0.25, 0.125}));
  const std::vector<FacePair> reference = full_report(crossing).pairs;
  ASSERT_GT(reference.size(), 20U);
  for (const int exponent : {-1000, -300, -100, 100, 300, 1000}) {
    SCOPED_TRACE(exponent);
    TriangleSoup scaled = crossing;
    for (Point3& p : scaled.points) {
      for (double& coordinate : p) coordinate = std::ldexp(coordinate, exponent);
    }
    EXPECT_EQ(full_report(scaled).pairs, reference);
  }
  TriangleSoup distant =
      crossing;  // rounded by the offset, so compared with CGAL on the same points
  for (Point3& p : distant.points) p = p + Point3{1e8, -1e8, 1e8};
  expect_equals_cgal(distant);
}

// Real meshes: those of CELLOCUT_MESHES, or of ../shared/meshes beside the sources, where there are
// any.
std::vector<std::filesystem::path> mesh_files() {
  const char* folder = std::getenv("CELLOCUT_MESHES");
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(
           folder != nullptr ? folder : CELLOCUT_DEFAULT_MESHES, none)) {
    if (format_of_path(entry.path().string())) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string name_of(const ::testing::TestParamInfo<std::filesystem::path>& mesh) {
  std::string name = mesh.param.stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

class RealMesh : public ::testing::TestWithParam<std::filesystem::path> {};

TEST_P(RealMesh, EqualsCgal) {
  const std::size_t pairs = expect_equals_cgal(read_mesh(GetParam().string()));
  RecordProperty("pairs", std::to_string(pairs));
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RealMesh);
INSTANTIATE_TEST_SUITE_P(Files, RealMesh, ::testing::ValuesIn(mesh_files()), name_of);

}  // namespace
}  // namespace cellocut
