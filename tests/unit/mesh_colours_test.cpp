// Colours and attributes of vertices, through the readers and the writers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "cellocut/base/byte_order.h"
#include "cellocut/base/errors.h"
#include "cellocut/mesh/mesh_file.h"
#include "support/temporary_folder.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;
using Colours = std::vector<Rgb>;

constexpr Rgb kWhite{255, 255, 255};

TriangleSoup read(const std::string& name, const std::string& content) {
  const test::TemporaryFolder folder;
  return read_mesh(folder.file(name, content));
}

// Three vertices with `colours` after x y z, each as it stands.
Colours obj_colours(const std::string& a, const std::string& b, const std::string& c) {
  const TriangleSoup soup =
      read("a.obj", "v 0 0 0" + a + "\nv 1 0 0" + b + "\nv 0 1 0" + c + "\nf 1 2 3\n");
  EXPECT_EQ(soup.points, (std::vector<Point3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  return soup.colours;
}

TEST(ReadColours, Obj) {
  EXPECT_EQ(obj_colours(" 1 0 0", " 0 0.5 1", " 0.2 0.4 0.6 # comment"),
            (Colours{{255, 0, 0}, {0, 128, 255}, {51, 102, 153}}));
  EXPECT_EQ(obj_colours(" 255 0 0", " 1 2.6 300", " 0 -4 128"),
            (Colours{{255, 0, 0}, {1, 3, 255}, {0, 0, 128}}))
      << "one value above 1 makes the whole file 0 to 255";
  EXPECT_EQ(obj_colours(" 1 0 0 0.5", " 0 1 0 1", " 0 0 1 0"),
            (Colours{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}))
      << "the opacity is left out";
}

TEST(ReadColours, ObjWithoutColours) {
  EXPECT_TRUE(obj_colours("", "", "").empty());
  EXPECT_TRUE(obj_colours(" 1", " 0.5", " 1").empty()) << "weights";
  EXPECT_TRUE(obj_colours(" 1 0 0 0 1", " 1 2", "").empty()) << "nobody knows what these are";
  EXPECT_TRUE(obj_colours(" red green blue", " nan 0 0", " 0 0 1e999").empty());
}

TEST(ReadColours, VerticesWithoutOneAreWhite) {
  EXPECT_EQ(obj_colours("", " 0 0 1", ""), (Colours{kWhite, {0, 0, 255}, kWhite}));
  EXPECT_EQ(obj_colours(" 1 0 0", " x 0 1", " 0 nan 1"), (Colours{{255, 0, 0}, kWhite, kWhite}));
  EXPECT_EQ(obj_colours(" +1 0 0", " 0 0", " 0 0 1e999"), (Colours{{255, 0, 0}, kWhite, kWhite}));
}

Colours off_colours(const std::string& keyword, const std::string& a, const std::string& b) {
  return read("a.off",
              keyword + "\n3 1 0\n0 0 0" + a + "\n1 0 0" + b + "\n0 1 0" + b + "\n3 0 1 2\n")
      .colours;
}

TEST(ReadColours, Off) {
  EXPECT_EQ(off_colours("COFF", " 255 128 0 255", " 1 2 3 255"),
            (Colours{{255, 128, 0}, {1, 2, 3}, {1, 2, 3}}));
  EXPECT_EQ(off_colours("COFF", " 0 0 0 255", " 1 0 0 255"),
            (Colours{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}))
      << "the opacity tells the range";
  EXPECT_EQ(off_colours("COFF", " 1 0.5 0 1", " 0 0 0.2"),
            (Colours{{255, 128, 0}, {0, 0, 51}, {0, 0, 51}}));
  EXPECT_EQ(off_colours("STCNOFF", " 0 0 9 0 1 0 1 0.5 0.5", " 0 0 9 0 0 1 1 7 7"),
            (Colours{{0, 255, 0}, {0, 0, 255}, {0, 0, 255}}))
      << "after the normal, before the texture";
  EXPECT_TRUE(off_colours("OFF", " 255 128 0 255", " 1 2 3 255").empty()) << "no C, no colour";
  EXPECT_TRUE(off_colours("COFF", " red", "").empty());
}

std::string ply_text(const std::string& type, const std::string& prefix, const std::string& a) {
  std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n";
  for (const char* name : {"red", "green", "blue"}) {
    header.append("property ").append(type).append(" ").append(prefix).append(name).append("\n");
  }
  return header +
         "property float y\nproperty float z\nelement face 1\nproperty list uchar int "
         "vertex_indices\nend_header\n0 " +
         a + " 0 0\n1 0 0 1 0 0\n0 1 0 0 1 0\n3 0 1 2\n";
}

TEST(ReadColours, Ply) {
  EXPECT_EQ(read("a.ply", ply_text("uchar", "", "255 128 7")).colours,
            (Colours{{255, 128, 7}, {0, 0, 1}, {1, 0, 0}}));
  EXPECT_EQ(read("a.ply", ply_text("uchar", "", "1 1 0")).colours,
            (Colours{{1, 1, 0}, {0, 0, 1}, {1, 0, 0}}))
      << "integers are 0 to 255, whatever they are";
  EXPECT_EQ(read("a.ply", ply_text("float", "diffuse_", "0.5 1 0")).colours,
            (Colours{{128, 255, 0}, {0, 0, 255}, {255, 0, 0}}));
  EXPECT_EQ(read("a.ply", ply_text("float", "", "128 7 255")).colours,
            (Colours{{128, 7, 255}, {0, 0, 1}, {1, 0, 0}}));
  EXPECT_EQ(read("a.ply", ply_text("ushort", "", "65535 32768 257")).colours,
            (Colours{{255, 128, 1}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_TRUE(read("a.ply", ply_text("uchar", "ambient_", "1 2 3")).colours.empty());
}

TEST(ReadColours, MalformedInPlyIsWhiteAndMissingIsTruncated) {
  EXPECT_EQ(read("a.ply", ply_text("float", "", "nan 0 0")).colours,
            (Colours{kWhite, {0, 0, 255}, {255, 0, 0}}));
  EXPECT_EQ(read("a.ply", ply_text("uchar", "", "x y z")).colours,
            (Colours{kWhite, {0, 0, 1}, {1, 0, 0}}));
  EXPECT_THROW(read("a.ply", ply_text("uchar", "", "1 2")), InputError);
  EXPECT_THROW(read("a.ply", ply_text("uchar", "", "1 2 3 4")), InputError);
  std::string text = ply_text("float", "", "1 2 3");
  text.replace(text.find("property float green"), 20, "property float grey_");
  EXPECT_TRUE(read("a.ply", text).colours.empty()) << "two of three are none";
}

TEST(ReadColours, BinaryPlyWithColoursThatAreNotNumbers) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float red\nproperty float green\nproperty float blue\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < 3; ++i) {
    for (const float x : {i == 1 ? 1.0F : 0.0F, i == 2 ? 1.0F : 0.0F, 0.0F, 1.0F,
                          i == 1 ? std::numeric_limits<float>::infinity() : 0.0F, 0.5F}) {
      append_little_endian(bytes, x);
    }
  }
  bytes += '\3';
  for (const std::int32_t corner : {0, 1, 2}) append_little_endian(bytes, corner);
  EXPECT_EQ(read("a.ply", bytes).colours, (Colours{{255, 0, 128}, kWhite, {255, 0, 128}}));
}

// All 256 values of a component.
TriangleSoup coloured_mesh() {
  TriangleSoup mesh;
  for (int i = 0; i < 256; ++i) {
    mesh.points.push_back({0.1 * i, 1.0 / (i + 1), 0});
    mesh.colours.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(255 - i),
                            static_cast<std::uint8_t>((7 * i) % 256)});
  }
  mesh.triangles = {{0, 1, 2}, {3, 4, 255}};
  return mesh;
}

TEST(WriteColours, ReadBackAsTheyAre) {
  const test::TemporaryFolder folder;
  TriangleSoup mesh = coloured_mesh();
  for (const MeshFormat format : {MeshFormat::obj, MeshFormat::ply, MeshFormat::ply_ascii}) {
    const TriangleSoup back = read_mesh(folder.file("mesh", encode_mesh(mesh, format)), format);
    EXPECT_EQ(back.points, mesh.points);
    EXPECT_EQ(back.triangles, mesh.triangles);
    EXPECT_EQ(back.colours, mesh.colours);
    EXPECT_EQ(as_read_back(mesh, format).colours, mesh.colours);
  }
  for (Rgb& colour : mesh.colours) colour = {0, 255, 0};  // nothing but 0 and 1 in OBJ
  EXPECT_EQ(
      read_mesh(folder.file("mesh", encode_mesh(mesh, MeshFormat::obj)), MeshFormat::obj).colours,
      mesh.colours);
  for (Rgb& colour : mesh.colours) colour = {};
  EXPECT_EQ(
      read_mesh(folder.file("mesh", encode_mesh(mesh, MeshFormat::obj)), MeshFormat::obj).colours,
      mesh.colours);
}

TEST(WriteColours, FormatsWithoutThem) {
  const test::TemporaryFolder folder;
  const TriangleSoup mesh = coloured_mesh();
  TriangleSoup plain = mesh;
  plain.colours.clear();
  for (const MeshFormat format : {MeshFormat::off, MeshFormat::stl, MeshFormat::stl_ascii}) {
    EXPECT_EQ(encode_mesh(mesh, format), encode_mesh(plain, format));
    EXPECT_TRUE(as_read_back(mesh, format).colours.empty());
  }
}

TEST(WriteAttributes, ReadersSkipThemAndTheirValuesAreThere) {
  const test::TemporaryFolder folder;
  for (const bool coloured : {false, true}) {
    TriangleSoup mesh = coloured_mesh();
    if (!coloured) mesh.colours.clear();
    std::vector<std::int32_t> face;
    std::vector<double> distance;
    std::vector<std::uint8_t> supported;
    for (int i = 0; i < 256; ++i) {
      face.push_back(1000000 * i - 5);
      distance.push_back(1.0 / (3 + i));
      supported.push_back(static_cast<std::uint8_t>(i));
    }
    const std::vector<VertexAttribute> attributes{
        {"nearest_face", face}, {"distance", distance}, {"supported", supported}};
    for (const MeshFormat format : {MeshFormat::ply, MeshFormat::ply_ascii}) {
      const std::string bytes = encode_mesh(mesh, format, attributes);
      const TriangleSoup back = read_mesh(folder.file("mesh", bytes), format);
      EXPECT_EQ(back.points, mesh.points);
      EXPECT_EQ(back.triangles, mesh.triangles);
      EXPECT_EQ(back.colours, mesh.colours);
      EXPECT_THAT(bytes, HasSubstr("property int nearest_face\nproperty double distance\n"
                                   "property uchar supported\nelement face 2\n"));
      // Our own reader again, with an attribute under the name of what it reads.
      std::string renamed = bytes;
      renamed.replace(renamed.find("double x"), 8, "double q");
      renamed.replace(renamed.find("double distance"), 15, "double x");
      const TriangleSoup shifted = read_mesh(folder.file("renamed", renamed), format);
      for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(shifted.points[i][0], distance[i]);
    }
    const std::string text = encode_mesh(mesh, MeshFormat::ply_ascii, attributes);
    EXPECT_THAT(text, HasSubstr(coloured ? "\n0.1 0.5 0 1 254 7 999995 0.25 1\n"
                                         : "\n0.1 0.5 0 999995 0.25 1\n"));
  }
}

TEST(WriteAttributes, WrongOnesAreRefused) {
  TriangleSoup mesh = coloured_mesh();
  const std::vector<double> values(256, 0.0);
  const auto encode = [&mesh](std::vector<VertexAttribute> attributes, MeshFormat format) {
    return encode_mesh(mesh, format, attributes);
  };
  EXPECT_THROW(encode({{"d", values}}, MeshFormat::obj), UsageError);
  EXPECT_THROW(encode({{"d", values}}, MeshFormat::stl), UsageError);
  for (const char* name : {"", "a b", "x", "red", "line\n"}) {
    EXPECT_THROW(encode({{name, values}}, MeshFormat::ply), InputError) << name;
  }
  EXPECT_THROW(encode({{"d", values}, {"d", values}}, MeshFormat::ply), InputError);
  EXPECT_THROW(encode({{"d", std::vector<double>(255)}}, MeshFormat::ply), InputError);
  mesh.colours.pop_back();
  EXPECT_THROW(encode({}, MeshFormat::ply), InputError);
}

}  // namespace
}  // namespace cellocut
