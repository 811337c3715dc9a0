#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "cellocut/base/byte_order.h"
#include "cellocut/base/errors.h"
#include "cellocut/mesh/mesh_file.h"
#include "cellocut/mesh/point_merger.h"

namespace cellocut {
namespace {

// The shortest decimals that read back as the same number.
template <class Number>
void append_number(std::string& bytes, Number value) {
  std::array<char, 32> digits;  // the longest double takes 24
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  bytes.append(digits.data(), result.ptr);
}

void append_coordinates(std::string& bytes, const char* prefix, const Point3& point) {
  bytes += prefix;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) bytes += ' ';
    append_number(bytes, point[axis]);
  }
}

void append_point(std::string& bytes, const char* prefix, const Point3& point) {
  append_coordinates(bytes, prefix, point);
  bytes += '\n';
}

void append_triangle(std::string& bytes, const char* prefix, const Triangle& triangle,
                     std::uint64_t first_index) {
  bytes += prefix;
  for (int k = 0; k < 3; ++k) {
    if (k > 0) bytes += ' ';
    append_number(bytes, triangle[k] + first_index);
  }
  bytes += '\n';
}

// Appends `append(bytes, i)` for each i below count, in order; made in parallel.
template <class Append>
void append_all(std::string& bytes, std::size_t count, const Append& append) {
  constexpr std::size_t kChunk = 1 << 15;
  std::vector<std::string> chunks((count + kChunk - 1) / kChunk);
  tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t c) {
    for (std::size_t i = c * kChunk; i < std::min(count, (c + 1) * kChunk); ++i) {
      append(chunks[c], i);
    }
  });
  std::size_t size = bytes.size();
  for (const std::string& chunk : chunks) size += chunk.size();
  bytes.reserve(size);
  for (std::string& chunk : chunks) {
    bytes += chunk;
    std::string().swap(chunk);
  }
}

void append_points(std::string& bytes, const char* prefix, const TriangleSoup& mesh) {
  append_all(bytes, mesh.points.size(), [&](std::string& chunk, std::size_t i) {
    append_point(chunk, prefix, mesh.points[i]);
  });
}

void append_triangles(std::string& bytes, const char* prefix, const TriangleSoup& mesh,
                      std::uint64_t first_index) {
  append_all(bytes, mesh.triangles.size(), [&](std::string& chunk, std::size_t f) {
    append_triangle(chunk, prefix, mesh.triangles[f], first_index);
  });
}

// 0 to 1; any four decimals would read back as the same byte.
void append_obj_colour(std::string& bytes, const Rgb& colour) {
  for (const std::uint8_t component : colour) {
    bytes += ' ';
    append_number(bytes, static_cast<float>(component) / 255.0F);
  }
}

std::string encode_obj(const TriangleSoup& mesh) {
  std::string bytes;
  append_all(bytes, mesh.points.size(), [&](std::string& chunk, std::size_t i) {
    append_coordinates(chunk, "v ", mesh.points[i]);
    if (!mesh.colours.empty()) append_obj_colour(chunk, mesh.colours[i]);
    chunk += '\n';
  });
  append_triangles(bytes, "f ", mesh, 1);
  return bytes;
}

std::string encode_off(const TriangleSoup& mesh) {
  std::string bytes = "OFF\n" + std::to_string(mesh.points.size()) + ' ' +
                      std::to_string(mesh.triangles.size()) + " 0\n";
  append_points(bytes, "", mesh);
  append_triangles(bytes, "3 ", mesh, 0);
  return bytes;
}

// A byte as a number: to_chars takes none that may be a character.
int widened(std::uint8_t value) { return value; }
int widened(std::int32_t value) { return value; }
double widened(double value) { return value; }

using Attributes = std::span<const VertexAttribute>;

struct PlyTypeName {
  const char* operator()(const std::vector<std::uint8_t>& /*values*/) const { return "uchar"; }
  const char* operator()(const std::vector<std::int32_t>& /*values*/) const { return "int"; }
  const char* operator()(const std::vector<double>& /*values*/) const { return "double"; }
};

std::string vertex_properties(const TriangleSoup& mesh, Attributes attributes) {
  std::string text = "property double x\nproperty double y\nproperty double z\n";
  if (!mesh.colours.empty()) {
    text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  for (const VertexAttribute& attribute : attributes) {
    text.append("property ").append(std::visit(PlyTypeName{}, attribute.values));
    text.append(" ").append(attribute.name).append("\n");
  }
  return text;
}

std::string ply_header(const TriangleSoup& mesh, Attributes attributes, const char* encoding) {
  // `int` is what readers expect; `uint` only where it is needed.
  const bool large = mesh.points.size() > std::size_t{std::numeric_limits<std::int32_t>::max()};
  return std::string("ply\nformat ") + encoding + " 1.0\nelement vertex " +
         std::to_string(mesh.points.size()) + "\n" + vertex_properties(mesh, attributes) +
         "element face " + std::to_string(mesh.triangles.size()) + "\nproperty list uchar " +
         (large ? "uint" : "int") + " vertex_indices\nend_header\n";
}

std::string encode_ply_ascii(const TriangleSoup& mesh, Attributes attributes) {
  std::string bytes = ply_header(mesh, attributes, "ascii");
  append_all(bytes, mesh.points.size(), [&](std::string& chunk, std::size_t i) {
    append_coordinates(chunk, "", mesh.points[i]);
    const auto append_value = [&chunk](auto value) {
      chunk += ' ';
      append_number(chunk, value);
    };
    if (!mesh.colours.empty()) {
      for (const std::uint8_t component : mesh.colours[i]) append_value(int{component});
    }
    for (const VertexAttribute& attribute : attributes) {
      std::visit([&](const auto& values) { append_value(widened(values[i])); }, attribute.values);
    }
    chunk += '\n';
  });
  append_triangles(bytes, "3 ", mesh, 0);
  return bytes;
}

std::string encode_ply(const TriangleSoup& mesh, Attributes attributes) {
  std::string bytes = ply_header(mesh, attributes, "binary_little_endian");
  bytes.reserve(bytes.size() + (27 + 8 * attributes.size()) * mesh.points.size() +
                13 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    for (const double coordinate : mesh.points[i]) append_little_endian(bytes, coordinate);
    if (!mesh.colours.empty()) {
      for (const std::uint8_t component : mesh.colours[i]) append_little_endian(bytes, component);
    }
    for (const VertexAttribute& attribute : attributes) {
      std::visit([&](const auto& values) { append_little_endian(bytes, values[i]); },
                 attribute.values);
    }
  }
  for (const Triangle& triangle : mesh.triangles) {
    bytes += '\3';
    for (const std::uint32_t corner : triangle) append_little_endian(bytes, corner);
  }
  return bytes;
}

// Unit normal, zero for a triangle without area.
std::array<float, 3> facet_normal(const TriangleSoup& mesh, const Triangle& triangle) {
  const Point3& a = mesh.points[triangle[0]];
  const Point3 normal = cross(mesh.points[triangle[1]] - a, mesh.points[triangle[2]] - a);
  const double length = norm(normal);
  if (!(length > 0) || !std::isfinite(length)) return {};
  return {static_cast<float>(normal[0] / length), static_cast<float>(normal[1] / length),
          static_cast<float>(normal[2] / length)};
}

std::string encode_stl(const TriangleSoup& mesh) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw LimitError("a binary STL file holds at most 4294967295 triangles");
  }
  std::string bytes(80, ' ');
  bytes.reserve(84 + 50 * mesh.triangles.size());
  append_little_endian(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& triangle : mesh.triangles) {
    for (const float x : facet_normal(mesh, triangle)) append_little_endian(bytes, x);
    for (const std::uint32_t corner : triangle) {
      for (const double x : mesh.points[corner]) {
        append_little_endian(bytes, static_cast<float>(x));
      }
    }
    append_little_endian(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string encode_stl_ascii(const TriangleSoup& mesh) {
  std::string bytes = "solid\n";
  for (const Triangle& triangle : mesh.triangles) {
    bytes += "facet normal";
    for (const float x : facet_normal(mesh, triangle)) {
      bytes += ' ';
      append_number(bytes, x);
    }
    bytes += "\nouter loop\n";
    for (const std::uint32_t corner : triangle) append_point(bytes, "vertex ", mesh.points[corner]);
    bytes += "endloop\nendfacet\n";
  }
  return bytes + "endsolid\n";
}

// Volatile, because g++ 12.2 wrongly drops a conversion to float and back where it vectorizes two
// of them (already at -O2).
double rounded_to_float(double x) {
  const volatile float rounded = static_cast<float>(x);
  return rounded;
}

void require_one_per_point(const std::string& what, std::size_t count, const TriangleSoup& mesh) {
  if (count == mesh.points.size()) return;
  throw InputError(what + " has " + std::to_string(count) + " values for " +
                   std::to_string(mesh.points.size()) + " vertices");
}

// That a reader will find every property, and no other of the same name.
void check_values(const TriangleSoup& mesh, Attributes attributes, MeshFormat format) {
  if (!mesh.colours.empty()) require_one_per_point("the colour", mesh.colours.size(), mesh);
  if (!attributes.empty() && format != MeshFormat::ply && format != MeshFormat::ply_ascii) {
    throw UsageError("only PLY files hold attributes of vertices");
  }
  std::vector<std::string> taken{"x", "y", "z", "red", "green", "blue"};
  for (const VertexAttribute& attribute : attributes) {
    require_one_per_point("attribute '" + attribute.name + "'", attribute.size(), mesh);
    const bool printable = std::all_of(attribute.name.begin(), attribute.name.end(),
                                       [](char c) { return c > ' ' && c <= '~'; });
    if (attribute.name.empty() || !printable ||
        std::find(taken.begin(), taken.end(), attribute.name) != taken.end()) {
      throw InputError("attribute '" + attribute.name +
                       "': the name is empty, not plain, or taken");
    }
    taken.push_back(attribute.name);
  }
}

}  // namespace

std::string encode_mesh(const TriangleSoup& mesh, MeshFormat format,
                        std::span<const VertexAttribute> attributes) {
  check_values(mesh, attributes, format);
  switch (format) {
    case MeshFormat::obj:
      return encode_obj(mesh);
    case MeshFormat::off:
      return encode_off(mesh);
    case MeshFormat::ply:
      return encode_ply(mesh, attributes);
    case MeshFormat::ply_ascii:
      return encode_ply_ascii(mesh, attributes);
    case MeshFormat::stl:
      return encode_stl(mesh);
    case MeshFormat::stl_ascii:
      return encode_stl_ascii(mesh);
  }
  throw UsageError("unknown mesh format");
}

TriangleSoup as_read_back(const TriangleSoup& mesh, MeshFormat format) {
  TriangleSoup seen;
  if (format != MeshFormat::stl && format != MeshFormat::stl_ascii) {
    seen = mesh;
    if (format == MeshFormat::off) seen.colours.clear();
    return seen;
  }
  seen.triangles.reserve(mesh.triangles.size());
  mesh_io::PointMerger merger;
  for (const Triangle& triangle : mesh.triangles) {
    Triangle merged{};
    for (int k = 0; k < 3; ++k) {
      Point3 point = mesh.points[triangle[k]];
      if (format == MeshFormat::stl) {
        for (double& x : point) x = rounded_to_float(x);
      }
      merged[k] = merger.index_of(point, seen.points);
    }
    seen.triangles.push_back(merged);
  }
  return seen;
}

}  // namespace cellocut
