// Points on a surface, with or without normals, as scanners deliver them.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cellocut/mesh/mesh_file.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct PointCloud {
  std::vector<Point3> points;
  // One for each point, of any length (zero: that point has none); or none at all.
  std::vector<Point3> normals;
};

// Reads the vertices of a PLY file, text or binary: x y z, and nx ny nz where all three are there.
// Every other property and element is skipped. O(size of the file).
// Errors: InputError with the path and what is wrong: not there, empty, truncated, malformed, no
// points, a coordinate or a normal that is not finite.
PointCloud read_point_cloud(const std::string& path);

// The bytes of a binary PLY file: doubles x y z, and floats nx ny nz where there are normals.
// Precondition: as many normals as points, or none. O(n).
std::string encode_point_cloud(const PointCloud& cloud);

// A mesh as read_mesh() reads it, or, where a PLY file has no faces, its points.
// Errors: as read_mesh() and read_point_cloud().
std::variant<TriangleSoup, PointCloud> read_mesh_or_cloud(const std::string& path,
                                                          std::optional<MeshFormat> format = {});

}  // namespace cellocut
