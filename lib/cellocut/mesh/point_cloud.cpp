#include "cellocut/mesh/point_cloud.h"

#include <algorithm>

#include "cellocut/base/byte_order.h"
#include "cellocut/base/read_file.h"
#include "cellocut/mesh/mesh_readers.h"
#include "cellocut/mesh/ply_body.h"
#include "cellocut/mesh/ply_header.h"

namespace cellocut {
namespace {

using mesh_io::PlyColumn;
using mesh_io::PlyElement;
using mesh_io::PlyHeader;

std::vector<PlyColumn> cloud_columns(const PlyElement& vertex) {
  std::vector<PlyColumn> columns = mesh_io::coordinate_columns(vertex);
  std::vector<PlyColumn> normal;
  for (const char* name : {"nx", "ny", "nz"}) {
    const std::size_t property = mesh_io::find_property(vertex, name, false);
    if (property != mesh_io::kAbsent) normal.push_back({property, "a normal"});
  }
  if (normal.size() == 3) columns.insert(columns.end(), normal.begin(), normal.end());
  return columns;
}

// What stands before the vertices is skipped, what comes after them is not looked at.
template <class Body>
void read_vertices(Body body, const PlyHeader& header, const PlyElement& vertex,
                   PointCloud& cloud) {
  const std::vector<PlyColumn> columns = cloud_columns(vertex);
  for (const PlyElement& element : header.elements) {
    body.require_all(element);
    if (&element == &vertex) break;
    body.skip(element);
  }
  mesh_io::read_columns(body, vertex, columns, [&](std::span<const double> n) {
    cloud.points.push_back({n[0], n[1], n[2]});
    if (n.size() == 6) cloud.normals.push_back({n[3], n[4], n[5]});
  });
}

PointCloud parse_cloud(std::string_view bytes, const PlyHeader& header) {
  const PlyElement* vertex = mesh_io::find_element(header, "vertex");
  if (vertex == nullptr) throw InputError("no element 'vertex'");
  if (vertex->count == 0) throw InputError("no points");
  PointCloud cloud;
  // The least that three values can take; the header is not believed.
  cloud.points.reserve(std::min(vertex->count, (bytes.size() - header.bytes) / 3));
  if (header.encoding == mesh_io::PlyEncoding::text) {
    read_vertices(mesh_io::TextBody(bytes, header), header, *vertex, cloud);
  } else {
    read_vertices(mesh_io::BinaryBody(bytes, header), header, *vertex, cloud);
  }
  return cloud;
}

}  // namespace

std::string encode_point_cloud(const PointCloud& cloud) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                      std::to_string(cloud.points.size()) + "\n";
  for (const char* name : {"x", "y", "z"}) {
    bytes.append("property double ").append(name).append("\n");
  }
  if (!cloud.normals.empty()) {
    for (const char* name : {"nx", "ny", "nz"}) {
      bytes.append("property float ").append(name).append("\n");
    }
  }
  bytes += "end_header\n";
  bytes.reserve(bytes.size() + 36 * cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    for (const double x : cloud.points[i]) append_little_endian(bytes, x);
    if (cloud.normals.empty()) continue;
    for (const double x : cloud.normals[i]) append_little_endian(bytes, static_cast<float>(x));
  }
  return bytes;
}

PointCloud read_point_cloud(const std::string& path) {
  const std::string bytes = read_file(path);
  try {
    return parse_cloud(bytes, mesh_io::read_ply_header(bytes));
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  }
}

std::variant<TriangleSoup, PointCloud> read_mesh_or_cloud(const std::string& path,
                                                          std::optional<MeshFormat> format) {
  if (!format) format = format_of_path(path);
  if (format != MeshFormat::ply && format != MeshFormat::ply_ascii) return read_mesh(path, format);
  const std::string bytes = read_file(path);
  try {
    const PlyHeader header = mesh_io::read_ply_header(bytes);
    if (mesh_io::has_faces(header)) return mesh_io::read_ply(bytes);
    return parse_cloud(bytes, header);
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  }
}

}  // namespace cellocut
