// Points from PLY files, and what is said about files that hold none.
#include "cellocut/mesh/point_cloud.h"

#include <gtest/gtest.h>

#include <limits>

#include "cellocut/base/byte_order.h"
#include "cellocut/base/errors.h"
#include "support/defective_meshes.h"
#include "support/temporary_folder.h"

namespace cellocut {
namespace {

PointCloud cloud_from(const std::string& content) {
  const test::TemporaryFolder folder;
  return read_point_cloud(folder.file("cloud.ply", content));
}

std::string error_of(const std::string& content) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("cloud.ply", content);
  try {
    read_point_cloud(path);
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), path);
    return error.what();
  }
  return "";
}

const std::string kXyz = "property double x\nproperty double y\nproperty double z\n";
const std::string kNormal = "property float nx\nproperty float ny\nproperty float nz\n";

std::string ply(const std::string& encoding, const std::string& header, const std::string& body) {
  return "ply\nformat " + encoding + " 1.0\n" + header + "end_header\n" + body;
}

TEST(PointCloud, Text) {
  const PointCloud bare = cloud_from(ply("ascii", "element vertex 2\n" + kXyz, "1 2 3\n4 5 6\n"));
  EXPECT_EQ(bare.points, (std::vector<Point3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_TRUE(bare.normals.empty());
  const PointCloud full = cloud_from(
      ply("ascii", "element vertex 2\n" + kNormal + kXyz, "0 0 2 1 2 3\n0 -1 0 4 5 6\n"));
  EXPECT_EQ(full.points, bare.points);
  EXPECT_EQ(full.normals, (std::vector<Point3>{{0, 0, 2}, {0, -1, 0}}));
}

TEST(PointCloud, OtherPropertiesAndElementsAreSkipped) {
  const std::string header =
      "element camera 1\nproperty list uchar float view\nelement vertex 2\nproperty uchar red\n" +
      kXyz + "property list uchar int seen\nproperty float nx\nelement face 0\n" +
      "property list uchar int vertex_indices\nelement more 5\nproperty int x\n";
  const PointCloud cloud =
      cloud_from(ply("ascii", header, "2 0 0\n9 1 2 3 2 7 7 0.5\n9 4 5 6 0 0.5\n"));
  EXPECT_EQ(cloud.points, (std::vector<Point3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_TRUE(cloud.normals.empty()) << "nx alone is no normal";
}

TEST(PointCloud, Binary) {
  std::string body;
  for (const double v : {1.0, 2.0, 1e-300}) append_little_endian(body, v);
  for (const float v : {0.0F, 0.5F, -1.0F}) append_little_endian(body, v);
  const std::string header = "element vertex 1\n" + kXyz + kNormal;
  const PointCloud cloud = cloud_from(ply("binary_little_endian", header, body));
  EXPECT_EQ(cloud.points, (std::vector<Point3>{{1, 2, 1e-300}}));
  EXPECT_EQ(cloud.normals, (std::vector<Point3>{{0, 0.5, -1}}));
  EXPECT_EQ(error_of(ply("binary_little_endian", header, body.substr(1))),
            "the header promises 1 instances of 'vertex' of 36 bytes, the file has 35 bytes left "
            "for them (truncated)");
}

TEST(PointCloud, MeshOrCloud) {
  const test::TemporaryFolder folder;
  const TriangleSoup box = test::box({0, 0, 0}, {1, 1, 1});
  for (const char* name : {"a.ply", "a.obj"}) {
    const std::string path = folder.path(name);
    write_mesh(box, path, *format_of_path(path));
    const auto read = read_mesh_or_cloud(path);
    ASSERT_TRUE(std::holds_alternative<TriangleSoup>(read));
    EXPECT_EQ(std::get<TriangleSoup>(read).triangles, box.triangles);
  }
  EXPECT_EQ(read_point_cloud(folder.path("a.ply")).points, box.points) << "without its faces";
  const std::string cloud = ply("ascii", "element vertex 1\n" + kXyz + "element face 0\n", "1 2 3");
  const auto read = read_mesh_or_cloud(folder.file("Cloud.PLY", cloud));
  ASSERT_TRUE(std::holds_alternative<PointCloud>(read));
  EXPECT_EQ(std::get<PointCloud>(read).points.size(), 1U);
  EXPECT_NO_THROW(read_mesh_or_cloud(folder.file("cloud.txt", cloud), MeshFormat::ply));
  EXPECT_THROW(read_mesh_or_cloud(folder.path("cloud.txt")), UsageError);
  EXPECT_THROW(read_mesh_or_cloud(folder.path("none.ply")), InputError);
  EXPECT_THROW(read_mesh_or_cloud(folder.file("bad.ply", "ply")), InputError);
}

TEST(PointCloudErrors, NameWhatIsWrong) {
  const std::string two = "element vertex 2\n" + kXyz;
  EXPECT_EQ(error_of(""), "the file is empty");
  EXPECT_EQ(error_of("OFF\n"), "not a PLY file: it does not begin with 'ply'");
  EXPECT_EQ(error_of(ply("ascii", "", "")), "no element 'vertex'");
  EXPECT_EQ(error_of(ply("ascii", "element vertex 0\n" + kXyz, "")), "no points");
  EXPECT_EQ(error_of(ply("ascii", "element vertex 1\nproperty float x\nproperty float y\n", "1 2")),
            "the element 'vertex' has no property 'z'");
  EXPECT_EQ(error_of(ply("ascii", two, "1 2 3\n")),
            "the header promises 2 instances of 'vertex', the file ends after 1 (truncated)");
  EXPECT_EQ(error_of(ply("ascii", two, "1 2 3\n1 2\n")),
            "line 9: expected a coordinate, the line ends");
  EXPECT_EQ(error_of(ply("ascii", two, "1 2 3 4\n")),
            "line 8: more values than the header names: '4'");
  EXPECT_EQ(error_of(ply("ascii", two, "1 nan 3\n")), "line 8: a coordinate is not finite: 'nan'");
  EXPECT_EQ(error_of(ply("ascii", "element vertex 1\n" + kXyz + kNormal, "1 2 3 0 0 inf\n")),
            "line 11: a normal is not finite: 'inf'");
  EXPECT_EQ(error_of(ply("ascii", "element vertex 1\n" + kXyz + kNormal, "1 2 3 0 0 up\n")),
            "line 11: expected a normal, found 'up'");
  std::string body;
  for (const double v : {1.0, std::numeric_limits<double>::infinity(), 3.0}) {
    append_little_endian(body, v);
  }
  EXPECT_EQ(error_of(ply("binary_little_endian", "element vertex 1\n" + kXyz, body)),
            "vertex 0 (counted from 0): a coordinate is not finite");
  EXPECT_EQ(error_of(ply("ascii", "element vertex 9000000000000000000\n" + kXyz, "1 2 3\n")),
            "the header promises 9000000000000000000 instances of 'vertex', the file ends after 1 "
            "(truncated)");
}

}  // namespace
}  // namespace cellocut
