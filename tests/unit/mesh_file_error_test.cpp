// What read_mesh() says about files that hold no mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "cellocut/base/errors.h"
#include "cellocut/mesh/mesh_file.h"
#include "support/defective_meshes.h"
#include "support/temporary_folder.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;

// The message for a file of that content; empty where it was read.
std::string error_of(const std::string& name, const std::string& content) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file(name, content);
  try {
    read_mesh(path);
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), path);
    EXPECT_THAT(error.what(), ::testing::Not(HasSubstr(path)));
    return error.what();
  }
  return "";
}

TEST(MeshFileErrors, NoFile) {
  const test::TemporaryFolder folder;
  EXPECT_THAT([&] { read_mesh(folder.path("none.obj")); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("No such file or directory")));
  std::filesystem::create_directory(folder.path("folder.obj"));
  EXPECT_THAT([&] { read_mesh(folder.path("folder.obj")); },
              ::testing::ThrowsMessage<InputError>("is a directory"));
  for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl"}) {
    EXPECT_EQ(error_of(name, ""), "the file is empty");
  }
}

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(MeshFileErrors, Obj) {
  EXPECT_EQ(error_of("a.obj", kTriangle), "no faces");
  EXPECT_EQ(error_of("a.obj", kTriangle + "f 1 2 4\n"),
            "line 4: a face names vertex 4, but the vertices are 1 to 3");
  EXPECT_EQ(error_of("a.obj", kTriangle + "f 1 2 3\nf 3 2 5\nf 1 2 9\nf 9 1 2"),
            "line 6: a face names vertex 9, but the vertices are 1 to 3");
  EXPECT_EQ(error_of("a.obj", "f 1 2 3\n"),
            "line 1: a face names vertex 3, but there are no vertices");
  EXPECT_EQ(error_of("a.obj", kTriangle + "f 1 2 -4\n"),
            "line 4: vertex index -4, but there are only 3 vertices so far");
  EXPECT_EQ(error_of("a.obj", kTriangle + "f 0 1 2\n"),
            "line 4: vertex index 0, but OBJ counts from 1");
  EXPECT_EQ(error_of("a.obj", kTriangle + "f 1 2 99999999999\n"),
            "line 4: vertex index 99999999999 is out of range");
  EXPECT_EQ(error_of("a.obj", kTriangle + "f 1 2 99999999999999999999\n"),
            "line 4: a vertex index is out of range: '99999999999999999999'");
  EXPECT_EQ(error_of("a.obj", kTriangle + "f 1 2\n"), "no faces");
  EXPECT_EQ(error_of("a.obj", kTriangle + "f 1 2 1.5\n"),
            "line 4: expected a vertex index, found '1.5'");
  EXPECT_EQ(error_of("a.obj", kTriangle + "f 1 2 3/a\n"),
            "line 4: expected a vertex index, found '3/a'");
  EXPECT_EQ(error_of("a.obj", "v 0 0\n"), "line 1: expected a coordinate, the line ends");
  EXPECT_EQ(error_of("a.obj", "v 0 \\\n0\nv 0 0 x\n"),
            "line 1: expected a coordinate, the line ends");
  EXPECT_EQ(error_of("a.obj", "v 0 0 1,5\n"), "line 1: expected a coordinate, found '1,5'");
  EXPECT_EQ(error_of("a.obj", "v 0 0 -\n"), "line 1: expected a coordinate, found '-'");
  EXPECT_EQ(error_of("a.obj", kTriangle + "v nan 0 0\n"),
            "line 4: a coordinate is not finite: 'nan'");
  EXPECT_EQ(error_of("a.obj", kTriangle + "v 0 -inf 0\n"),
            "line 4: a coordinate is not finite: '-inf'");
  EXPECT_EQ(error_of("a.obj", kTriangle + "v 0 1e999 0\n"),
            "line 4: a coordinate is not finite: '1e999'");
  EXPECT_THAT(error_of("a.obj", std::string("\x7F"
                                            "ELF\0\1\2\n",
                                            8)),
              HasSubstr("binary data"));
}

TEST(MeshFileErrors, Off) {
  EXPECT_EQ(error_of("a.off", "OFF\n"), "the file ends before the number of vertices");
  EXPECT_EQ(error_of("a.off", "OFF 3 0 0\n0 0 0\n1 0 0\n0 1 0\n"), "no faces");
  EXPECT_EQ(
      error_of("a.off", "OFF 4 1 0\n0 0 0\n1 0 0\n"),
      "the header promises 4 vertices, the file ends after 2 (truncated, or not on a line each)");
  EXPECT_EQ(
      error_of("a.off", "OFF 3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
      "the header promises 2 faces, the file ends after 1 (truncated, or not on a line each)");
  EXPECT_EQ(error_of("a.off", "OFF 9000000000000000000 9000000000000000000 0\n0 0 0\n"),
            "the header promises 9000000000000000000 vertices, the file ends after 1 (truncated, "
            "or not on a line each)");
  EXPECT_EQ(error_of("a.off", "OFF 3 -1 0\n"), "line 1: the number of faces is negative: -1");
  EXPECT_EQ(error_of("a.off", "COFF\nx y z\n"),
            "line 2: expected the number of vertices, found 'x'");
  EXPECT_EQ(error_of("a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"),
            "line 5: expected a vertex index, the line ends");
  EXPECT_EQ(error_of("a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n"),
            "line 5: a face with 2 corners, at least 3 are needed");
  EXPECT_EQ(error_of("a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "line 5: a face names vertex 3, but the vertices are 0 to 2");
  EXPECT_EQ(error_of("a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
            "line 5: vertex index -1 is out of range");
  EXPECT_EQ(error_of("a.off", "OFF 3 1 0\n0 0 0\n1 0 nan\n"),
            "line 3: a coordinate is not finite: 'nan'");
  EXPECT_EQ(error_of("a.off", "OFF BINARY\n"), "line 1: binary OFF files are not read");
  EXPECT_EQ(error_of("a.off", "4OFF\n"), "line 1: only OFF files in three dimensions are read");
}

std::string ply(const std::string& encoding, const std::string& vertices, const std::string& faces,
                const std::string& body) {
  return "ply\nformat " + encoding + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n" + body;
}

TEST(MeshFileErrors, PlyHeader) {
  EXPECT_EQ(error_of("a.ply", "solid"), "not a PLY file: it does not begin with 'ply'");
  EXPECT_EQ(error_of("a.ply", "ply\nformat ascii 1.0\n"),
            "the header has no 'end_header' (truncated, or not a PLY file)");
  EXPECT_EQ(error_of("a.ply", "ply\nformat utf8 1.0\nend_header\n"),
            "line 2: unknown encoding 'utf8'");
  EXPECT_EQ(error_of("a.ply", "ply\nend_header\n"), "the header has no 'format'");
  EXPECT_EQ(error_of("a.ply", "ply\nformat ascii 1.0\nend_header\n"), "no faces");
  EXPECT_EQ(error_of("a.ply", ply("ascii", "3", "0", "0 0 0\n1 0 0\n0 1 0\n")), "no faces");
  EXPECT_EQ(error_of("a.ply", ply("ascii", "-3", "1", "")),
            "line 3: the number of instances is negative: -3");
  EXPECT_EQ(
      error_of("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n"),
      "line 4: unknown type 'real'");
}

TEST(MeshFileErrors, PlyBody) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(error_of("a.ply", ply("ascii", "3", "2", points + "3 0 1 2\n")),
            "the header promises 2 instances of 'face', the file ends after 1 (truncated)");
  EXPECT_EQ(error_of("a.ply", ply("ascii", "3", "1", points + "3 0 1 3\n")),
            "line 13: a face names vertex 3, but the vertices are 0 to 2");
  EXPECT_EQ(error_of("a.ply", ply("ascii", "3", "1", points + "2 0 1\n")),
            "line 13: a face with 2 corners, at least 3 are needed");
  EXPECT_EQ(error_of("a.ply", ply("ascii", "3", "1", "0 0 0\n1 0\n")),
            "line 11: expected a coordinate, the line ends");
  EXPECT_EQ(error_of("a.ply", ply("ascii", "3", "1", "0 0 0 0\n")),
            "line 10: more values than the header names: '0'");
  EXPECT_EQ(error_of("a.ply", ply("ascii", "3", "1", "0 0 inf\n")),
            "line 10: a coordinate is not finite: 'inf'");
  const std::string zeros(36, '\0');
  EXPECT_EQ(
      error_of("a.ply", ply("binary_little_endian", "4", "1", zeros)),
      "the header promises 4 instances of 'vertex' of 12 bytes, the file has 36 bytes left for "
      "them (truncated)");
  EXPECT_EQ(
      error_of("a.ply", ply("binary_big_endian", "9000000000000000000", "1", zeros)),
      "the header promises 9000000000000000000 instances of 'vertex' of 12 bytes, the file has "
      "36 bytes left for them (truncated)");
  EXPECT_EQ(error_of("a.ply", ply("binary_little_endian", "3", "9000000000000000000",
                                  zeros + '\3' + std::string(12, '\0'))),
            "the header promises 9000000000000000000 instances of 'face', the file ends after 1 "
            "(truncated)");
  EXPECT_EQ(error_of("a.ply", ply("binary_little_endian", "3", "1", zeros + "\3\1\2")),
            "the header promises 1 instances of 'face', the file ends after 0 (truncated)");
  EXPECT_EQ(error_of("a.ply", ply("binary_little_endian", "3", "1", zeros + '\1' + zeros)),
            "face 1: a face with 1 corners, at least 3 are needed");
  EXPECT_EQ(error_of("a.ply",
                     ply("binary_little_endian", "3", "1", zeros + '\3' + std::string(12, '\1'))),
            "face 1: a face names vertex 16843009, but the vertices are 0 to 2");
  EXPECT_EQ(error_of("a.ply",
                     ply("binary_little_endian", "3", "1", zeros + '\3' + std::string(12, '\xFF'))),
            "face 1: a vertex index is out of range");
  EXPECT_EQ(error_of("a.ply", ply("binary_little_endian", "3", "1", std::string(48, '\xFF'))),
            "vertex 0 (counted from 0): a coordinate is not finite");
}

TEST(MeshFileErrors, Stl) {
  std::string whole = encode_mesh(test::icosphere(1), MeshFormat::stl);
  ASSERT_EQ(whole.size(), 84u + 50u * 80u);
  EXPECT_EQ(error_of("a.stl", whole.substr(0, 1000)),
            "expected 84 + 50 x 80 = 4084 bytes, the file has 1000 (truncated)");
  EXPECT_EQ(error_of("a.stl", whole.substr(0, 4083)),
            "expected 84 + 50 x 80 = 4084 bytes, the file has 4083 (truncated)");
  EXPECT_EQ(error_of("a.stl", whole + whole),
            "expected 84 + 50 x 80 = 4084 bytes, the file has 8168 (too long)");
  EXPECT_THAT(error_of("a.stl", whole.substr(0, 83)),
              HasSubstr("at least 84 bytes, the file has 83"));
  EXPECT_EQ(error_of("a.stl", std::string(84, '\0')), "no faces");
  EXPECT_EQ(error_of("a.stl", std::string(84, '\xFF')),
            "expected 84 + 50 x 4294967295 = 214748364834 bytes, the file has 84 (truncated)");
  std::string with_header = whole.substr(0, 1000);
  with_header.replace(0, 10, "solid cube");
  EXPECT_THAT(error_of("a.stl", with_header), HasSubstr("(truncated)"));
  whole.replace(84 + 50 + 12, 4, "\xFF\xFF\xFF\x7F");
  EXPECT_EQ(error_of("a.stl", whole), "facet 2 of 80: a coordinate is not finite");

  const std::string start = "solid\nfacet normal 0 0 1\nouter loop\n";
  const std::string triangle =
      start + "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  EXPECT_EQ(error_of("a.stl", "solid\nendsolid\n"), "no faces");
  EXPECT_EQ(error_of("a.stl", triangle), "line 8: the file ends inside a solid (truncated)");
  EXPECT_EQ(error_of("a.stl", start + "vertex 0 0 0\nvertex 1 0"),
            "line 5: the file ends inside a solid (truncated)");
  EXPECT_EQ(error_of("a.stl", start + "vertex 0 0 0\nendloop\nendfacet\nendsolid\n"),
            "line 5: a facet with 1 corners, at least 3 are needed");
  EXPECT_EQ(error_of("a.stl", start + "vertex 0 0 nan\n"),
            "line 4: a coordinate is not finite: 'nan'");
  EXPECT_EQ(error_of("a.stl", triangle + "hello\n"), "line 9: expected 'endsolid', found 'hello'");
}

// Whatever the bytes, the reader ends with a mesh or an InputError.
TEST(MeshFileErrors, DamagedFilesNeverCrash) {
  const test::TemporaryFolder folder;
  const TriangleSoup mesh = test::icosphere(1);
  std::mt19937_64 random(11);
  for (const MeshFormat format : {MeshFormat::obj, MeshFormat::off, MeshFormat::ply,
                                  MeshFormat::ply_ascii, MeshFormat::stl, MeshFormat::stl_ascii}) {
    const std::string whole = encode_mesh(mesh, format);
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
      std::string bytes = whole.substr(0, i % 3 == 0 ? random() % whole.size() : whole.size());
      for (int k = 0; k < i % 7 && !bytes.empty(); ++k) {
        // Half of the damage near the start, where the counts are.
        const std::size_t span =
            random() % 2 == 0 ? std::min<std::size_t>(200, bytes.size()) : bytes.size();
        bytes[random() % span] = static_cast<char>(random());
      }
      try {
        EXPECT_FALSE(read_mesh(folder.file("damaged", bytes), format).empty());
      } catch (const InputError&) {
        ++refused;
      }
    }
    EXPECT_GT(refused, 50);
  }
}

}  // namespace
}  // namespace cellocut
