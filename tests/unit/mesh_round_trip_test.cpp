// read(encode(mesh)) is as_read_back(mesh), bit for bit, in every format.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "cellocut/base/errors.h"
#include "cellocut/mesh/mesh_file.h"
#include "support/defective_meshes.h"
#include "support/temporary_folder.h"

namespace cellocut {
namespace {

constexpr std::array<std::pair<const char*, MeshFormat>, 6> kFormats{{
    {"obj", MeshFormat::obj},
    {"off", MeshFormat::off},
    {"ply", MeshFormat::ply},
    {"ply_ascii", MeshFormat::ply_ascii},
    {"stl", MeshFormat::stl},
    {"stl_ascii", MeshFormat::stl_ascii},
}};

std::vector<std::uint64_t> bits_of(const std::vector<Point3>& points) {
  std::vector<std::uint64_t> bits;
  for (const Point3& point : points) {
    for (const double x : point) bits.push_back(std::bit_cast<std::uint64_t>(x));
  }
  return bits;
}

void expect_round_trip(const TriangleSoup& mesh, MeshFormat format,
                       const test::TemporaryFolder& folder) {
  const TriangleSoup read = read_mesh(folder.file("mesh", encode_mesh(mesh, format)), format);
  const TriangleSoup expected = as_read_back(mesh, format);
  EXPECT_EQ(bits_of(read.points), bits_of(expected.points));
  EXPECT_EQ(read.triangles, expected.triangles);
}

// Coordinates of every kind: any finite bits (`any`), a few values that repeat, zeros of both
// signs.
double random_coordinate(std::mt19937_64& random, bool any) {
  static constexpr std::array<double, 6> kRepeated{0.0, -0.0, 1.0, -1.0, 0.1, 1.0 / 3};
  if (random() % 2 == 0) return kRepeated[random() % kRepeated.size()];
  if (!any) return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
  double value = 0;
  do {
    value = std::bit_cast<double>(random());
  } while (!std::isfinite(value));
  return value;
}

class MeshRoundTrip : public ::testing::TestWithParam<std::pair<const char*, MeshFormat>> {};

TEST_P(MeshRoundTrip, RandomMeshes) {
  const test::TemporaryFolder folder;
  // A double beyond the floats has no place in binary STL.
  const bool any = GetParam().second != MeshFormat::stl;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    std::mt19937_64 random(seed);
    TriangleSoup mesh;
    const std::size_t point_count = 1 + random() % 60;
    for (std::size_t i = 0; i < point_count; ++i) {
      mesh.points.push_back({random_coordinate(random, any), random_coordinate(random, any),
                             random_coordinate(random, any)});
    }
    for (std::size_t i = 1 + random() % 90; i > 0; --i) {
      Triangle triangle{};
      for (std::uint32_t& corner : triangle) {
        corner = static_cast<std::uint32_t>(random() % point_count);
      }
      mesh.triangles.push_back(triangle);
    }
    expect_round_trip(mesh, GetParam().second, folder);
  }
}

TEST_P(MeshRoundTrip, DefectiveMeshes) {
  const test::TemporaryFolder folder;
  for (const test::NamedSoup& mesh : test::all_defective_meshes()) {
    SCOPED_TRACE(mesh.name);
    expect_round_trip(mesh.soup, GetParam().second, folder);
  }
}

TEST_P(MeshRoundTrip, ReadingBackTwiceChangesNothing) {
  const TriangleSoup once = as_read_back(test::degenerate_faces(), GetParam().second);
  const TriangleSoup twice = as_read_back(once, GetParam().second);
  EXPECT_EQ(bits_of(twice.points), bits_of(once.points));
  EXPECT_EQ(twice.triangles, once.triangles);
}

TEST_P(MeshRoundTrip, WriteMesh) {
  const test::TemporaryFolder folder;
  const TriangleSoup mesh = test::icosphere(2);
  write_mesh(mesh, folder.path("out"), GetParam().second);
  EXPECT_EQ(test::content_of(folder.path("out")), encode_mesh(mesh, GetParam().second));
  EXPECT_THROW(write_mesh(mesh, folder.path("none/out"), GetParam().second), OutputError);
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshRoundTrip, ::testing::ValuesIn(kFormats),
                         [](const auto& format) { return std::string(format.param.first); });

TEST(AsReadBack, StlMergesEqualPoints) {
  TriangleSoup mesh;
  // Four points, of which two are equal as they are and a third becomes so as float.
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {-0.0, 0, 0}, {1 + 1e-12, 0, 0}, {0, 1, 0}, {9, 9, 9}};
  mesh.triangles = {{0, 1, 4}, {2, 3, 4}};
  EXPECT_EQ(as_read_back(mesh, MeshFormat::obj).points.size(), 6u);
  EXPECT_EQ(as_read_back(mesh, MeshFormat::stl_ascii).triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 3, 2}}));
  const TriangleSoup binary = as_read_back(mesh, MeshFormat::stl);
  EXPECT_EQ(binary.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}));
  EXPECT_EQ(binary.points.size(), 3u);
}

// Large files are made in parts, side by side, and come out in order.
TEST(EncodeMesh, KeepsTheOrderOfManyFaces) {
  TriangleSoup mesh;
  for (std::uint32_t i = 0; i < 50000; ++i) {
    mesh.points.push_back({static_cast<double>(i), 0.5 * i, 0});
    mesh.triangles.push_back({i, (i + 7) % 50000, (i + 1) % 50000});
  }
  const test::TemporaryFolder folder;
  for (const auto& [name, format] : kFormats) expect_round_trip(mesh, format, folder);
}

TEST(EncodeMesh, ShortestDecimals) {
  TriangleSoup mesh;
  mesh.points = {{0.1, 1.0 / 3, 1e300}, {-0.0, 5e-324, 123456}, {1, 2, 3}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_EQ(encode_mesh(mesh, MeshFormat::obj),
            "v 0.1 0.3333333333333333 1e+300\nv -0 5e-324 123456\nv 1 2 3\nf 1 2 3\n");
}

}  // namespace
}  // namespace cellocut
