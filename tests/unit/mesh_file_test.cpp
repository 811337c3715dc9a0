#include "cellocut/mesh/mesh_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "cellocut/base/errors.h"
#include "support/temporary_folder.h"

namespace cellocut {
namespace {

TriangleSoup read_text(const std::string& name, const std::string& content) {
  const test::TemporaryFolder folder;
  return read_mesh(folder.file(name, content));
}

const std::vector<Point3> kFourPoints{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.25, 1e-3}};
const std::string kFourVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.1 0.25 1e-3\n";

TEST(MeshFormat, OfPathAndName) {
  EXPECT_EQ(format_of_path("a/b.c/mesh.OBJ"), MeshFormat::obj);
  EXPECT_EQ(format_of_path("mesh.Off"), MeshFormat::off);
  EXPECT_EQ(format_of_path("x.ply"), MeshFormat::ply);
  EXPECT_EQ(format_of_path("x.stl"), MeshFormat::stl);
  EXPECT_FALSE(format_of_path("folder.obj/mesh"));
  EXPECT_FALSE(format_of_path("mesh.obj.gz"));
  EXPECT_FALSE(format_of_path("-"));
  EXPECT_EQ(format_of_name("ply-ascii"), MeshFormat::ply_ascii);
  EXPECT_EQ(format_of_name("stl-ascii"), MeshFormat::stl_ascii);
  EXPECT_THROW(format_of_name("fbx"), UsageError);
  EXPECT_THROW(read_mesh("-"), UsageError);
  EXPECT_THROW(read_mesh("mesh.fbx"), UsageError);
}

TEST(ReadObj, CornerForms) {
  const TriangleSoup soup = read_text(
      "a.obj", "# made by hand\r\nmtllib a.mtl\r\n" + kFourVertices +
                   "vt 0 0\nvn 0 0 1\no thing\ng a b\ns off\nusemtl red\nl 1 2\np 1\n"
                   "f 1 2 3\nf 1/1 2/1 3/1\nf 1/1/1 2/1/1 3/1/1\nf 1//1 2//1 3//1\n"
                   "f -4 -3 -1\nf -4/-1/-1 -3/-1/-1 -1/-1/-1\n  f\t2 3 4 # why\r\nf +1 +2 +4");
  EXPECT_EQ(soup.points, kFourPoints);
  const std::vector<Triangle> expected{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2},
                                       {0, 1, 3}, {0, 1, 3}, {1, 2, 3}, {0, 1, 3}};
  EXPECT_EQ(soup.triangles, expected);
}

TEST(ReadObj, ExtraNumbersAfterTheCoordinates) {
  const TriangleSoup soup =
      read_text("a.obj", "v 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 0 0 1\nf 1 2 3\n");
  EXPECT_EQ(soup.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(ReadObj, ContinuedLines) {
  const TriangleSoup soup =
      read_text("a.obj", kFourVertices + "# C:\\meshes\\\nf 1 \\\n2 \\\r\n 3\nf 2 3 4\n");
  EXPECT_EQ(soup.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}}));
}

TEST(ReadObj, FacesBeforeTheirVertices) {
  EXPECT_EQ(read_text("a.obj", "f 1 2 4\n" + kFourVertices).triangles.front(), (Triangle{0, 1, 3}));
}

TEST(ReadObj, ByteOrderMarkAndMacLineEnds) {
  EXPECT_EQ(read_text("a.obj", "\xEF\xBB\xBFv 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r").points.size(),
            3u);
}

TEST(ReadObj, EverythingIsKept) {
  // A duplicate, an opposite duplicate, repeated corners, and a point that no face uses.
  const TriangleSoup soup =
      read_text("a.obj", kFourVertices + "f 1 2 3\nf 2 3 1\nf 3 2 1\nf 1 1 2\nf 3 3 3\n");
  EXPECT_EQ(soup.points.size(), 4u);
  EXPECT_EQ(soup.triangles,
            (std::vector<Triangle>{{0, 1, 2}, {1, 2, 0}, {2, 1, 0}, {0, 0, 1}, {2, 2, 2}}));
}

TEST(ReadObj, LooseEdgesAreCounted) {
  const TriangleSoup soup = read_text("a.obj", kFourVertices + "f 1 2\nf 1 2 3\nf 4\nf\n");
  EXPECT_EQ(soup.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(soup.skipped_polygons, 3u);
}

TEST(ReadObj, CorrectlyRoundedDoubles) {
  // Decimal fractions next to the middle between two doubles, and the ends of the range.
  const TriangleSoup soup =
      read_text("a.obj",
                "v 9007199254740993 1.00000000000000011102230246251565404 1e-400\n"
                "v 2.2250738585072014e-308 1.7976931348623157e308 -0\n"
                "v +.5 5e-1 4.9406564584124654e-324\nf 1 2 3\n");
  EXPECT_EQ(soup.points[0], (Point3{9007199254740992.0, 1.0, 0.0}));
  EXPECT_EQ(soup.points[1][0], 0x1p-1022);
  EXPECT_EQ(soup.points[1][1], 0x1.fffffffffffffp1023);
  EXPECT_TRUE(std::signbit(soup.points[1][2]));
  EXPECT_EQ(soup.points[2], (Point3{0.5, 0.5, 0x1p-1074}));
}

TEST(ReadOff, Variants) {
  const std::string body = "0 0 0\n1 0 0\n0 1 0\n0.1 0.25 1e-3\n3 0 1 2\n3 1 2 3\n";
  const std::vector<Triangle> faces{{0, 1, 2}, {1, 2, 3}};
  const std::string coloured =
      "0 0 0 255 0 0 255\n1 0 0 1 1 1\n0 1 0\n\n0.1 0.25 1e-3 7\n"
      "3 0 1 2 255 0 0\n# a comment\n3 1 2 3 0.5 0.5 0.5 1 # another\n";
  for (const std::string& content :
       {"OFF\n4 2 0\n" + body, "OFF4 2 0\n" + body, "OFF 4 2 5\n" + body, "OFF\n4 2\n" + body,
        "# first\nOFF # off\n\n# second\n4 2 0\n" + body, "4 2 0\n" + body,
        "COFF\r\n4 2 0\r\n" + coloured, "NOFF\n4 2 0\n" + coloured, "STCNOFF 4 2 0\n" + coloured,
        "OFF\n4 2 0\n" + body.substr(0, body.size() - 1)}) {
    const TriangleSoup soup = read_text("a.off", content);
    EXPECT_EQ(soup.points, kFourPoints) << content;
    EXPECT_EQ(soup.triangles, faces) << content;
  }
}

template <class Number>
void append(std::string& bytes, Number value, std::endian order) {
  std::array<char, sizeof(Number)> raw{};
  std::memcpy(raw.data(), &value, sizeof(Number));
  if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

TEST(ReadPly, TextWithFurtherElementsAndProperties) {
  const TriangleSoup soup =
      read_text("a.ply",
                "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info none\r\n"
                "element camera 1\nproperty float f\nproperty list uchar float k\n"
                "element vertex 4\nproperty uchar red\nproperty double x\nproperty float64 z\n"
                "property list uchar int near\nproperty float y\n"
                "element face 2\nproperty uchar flags\nproperty list uint8 uint32 vertex_index\n"
                "property list uchar float texcoord\nelement edge 1\nproperty int a\nend_header\r\n"
                "1 2 3 4\n9 0 0 0 0\n9 1 0 2 7 8 0\n\n9 0 0 0 1\n9 0.1 1e-3 1 5 0.25\n"
                "1 3 0 1 2 0\n1 3 1 2 3 2 0.5 0.5\n7\n");
  EXPECT_EQ(soup.points, kFourPoints);
  EXPECT_EQ(soup.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}}));
}

template <class Coordinate, class Count, class Index>
void expect_binary_ply(const char* coordinate, const char* count, const char* index,
                       std::endian order) {
  std::string bytes =
      std::string("ply\nformat binary_") + (order == std::endian::big ? "big" : "little") +
      "_endian 1.0\nelement vertex 4\nproperty " + coordinate +
      " x\nproperty short quality\nproperty " + coordinate + " y\nproperty " + coordinate +
      " z\nelement strip 1\nproperty list ushort char s\n" + "element face 2\nproperty list " +
      count + " " + index + " vertex_indices\nproperty float area\nend_header\n";
  const std::vector<std::array<Coordinate, 3>> points{
      {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {Coordinate(0.1), Coordinate(0.25), Coordinate(-3)}};
  for (const auto& point : points) {
    append(bytes, point[0], order);
    append(bytes, std::int16_t{-5}, order);
    append(bytes, point[1], order);
    append(bytes, point[2], order);
  }
  append(bytes, std::uint16_t{3}, order);
  bytes += "abc";
  for (const Triangle& triangle : {Triangle{0, 1, 2}, Triangle{3, 2, 1}}) {
    append(bytes, Count{3}, order);
    for (const std::uint32_t corner : triangle) append(bytes, static_cast<Index>(corner), order);
    append(bytes, 1.5F, order);
  }
  const TriangleSoup soup = read_text("a.ply", bytes);
  ASSERT_EQ(soup.points.size(), 4u);
  EXPECT_EQ(soup.points[3], (Point3{Coordinate(0.1), Coordinate(0.25), -3}));
  EXPECT_EQ(soup.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 2, 1}}));
}

TEST(ReadPly, BinaryOfAnyTypesInBothByteOrders) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    expect_binary_ply<float, std::uint8_t, std::int32_t>("float", "uchar", "int", order);
    expect_binary_ply<double, std::uint8_t, std::uint32_t>("double", "uint8", "uint32", order);
    expect_binary_ply<float, std::int32_t, std::uint8_t>("float32", "int", "uchar", order);
    expect_binary_ply<double, std::uint16_t, std::int8_t>("float64", "ushort", "char", order);
    expect_binary_ply<float, std::uint32_t, std::int16_t>("float", "uint", "short", order);
    expect_binary_ply<float, std::int8_t, std::uint16_t>("float", "char", "ushort", order);
    expect_binary_ply<float, std::int16_t, float>("float", "int16", "float", order);
    expect_binary_ply<double, std::uint8_t, std::int64_t>("double", "uchar", "int64", order);
  }
}

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\n"
    "endfacet\n";
const std::string kNeighbour =
    "  FACET NORMAL nan nan nan OUTER LOOP VERTEX 1 0 0 VERTEX -0 0 0\nVERTEX 0.1 0.25 1e-3 "
    "ENDLOOP ENDFACET\n";

TEST(ReadStl, TextWithSeveralSolids) {
  const TriangleSoup soup =
      read_text("a.stl", "solid first facet vertex\n" + kFacet + "endsolid first\r\n\r\nsolid\r\n" +
                             kNeighbour + "endsolid\nsolid empty\nendsolid empty");
  EXPECT_EQ(soup.points, kFourPoints);
  EXPECT_EQ(soup.triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 0, 3}}));
}

TEST(ReadStl, BinaryWithAnyHeader) {
  for (const std::string& header :
       {std::string(80, ' '), "solid of facets" + std::string(65, ' '), std::string(80, '\0')}) {
    std::string bytes = header;
    append(bytes, std::uint32_t{2}, std::endian::little);
    for (const float height : {1.F, 2.F}) {
      for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.1F, height, 0.F}) {
        append(bytes, x, std::endian::little);
      }
      append(bytes, std::uint16_t{0xFFFF}, std::endian::little);
    }
    const TriangleSoup soup = read_text("a.stl", bytes);
    EXPECT_EQ(soup.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0.1F, 1, 0}, {0.1F, 2, 0}}));
    EXPECT_EQ(soup.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}}));
  }
}

}  // namespace
}  // namespace cellocut
