#include <tbb/parallel_pipeline.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
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

// Calls append(bytes, i) for each i below count, in parallel, and gives the bytes to the sink in
// order, a few megabytes at a time.
template <class Append>
void stream_all(const ByteSink& sink, std::size_t count, const Append& append) {
  constexpr std::size_t kChunk = 1 << 14;
  constexpr std::size_t kChunksAtOnce = 128;  // more than the threads there are
  std::size_t begin = 0;
  tbb::parallel_pipeline(
      kChunksAtOnce,
      tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                          [&](tbb::flow_control& flow) {
                                            if (begin >= count) flow.stop();
                                            return std::exchange(begin, begin + kChunk);
                                          }) &
          tbb::make_filter<std::size_t, std::string>(tbb::filter_mode::parallel,
                                                     [&](std::size_t first) {
                                                       std::string bytes;
                                                       const std::size_t end =
                                                           std::min(count, first + kChunk);
                                                       for (std::size_t i = first; i < end; ++i) {
                                                         append(bytes, i);
                                                       }
                                                       return bytes;
                                                     }) &
          tbb::make_filter<std::string, void>(tbb::filter_mode::serial_in_order,
                                              [&](const std::string& bytes) { sink(bytes); }));
}

void stream_points(const ByteSink& sink, const char* prefix, const TriangleSoup& mesh) {
  stream_all(sink, mesh.points.size(), [&](std::string& bytes, std::size_t i) {
    append_point(bytes, prefix, mesh.points[i]);
  });
}

void stream_triangles(const ByteSink& sink, const char* prefix, const TriangleSoup& mesh,
                      std::uint64_t first_index) {
  stream_all(sink, mesh.triangles.size(), [&](std::string& bytes, std::size_t f) {
    append_triangle(bytes, prefix, mesh.triangles[f], first_index);
  });
}

// 0 to 1; any four decimals would read back as the same byte.
void append_obj_colour(std::string& bytes, const Rgb& colour) {
  for (const std::uint8_t component : colour) {
    bytes += ' ';
    append_number(bytes, static_cast<float>(component) / 255.0F);
  }
}

void stream_obj(const ByteSink& sink, const TriangleSoup& mesh) {
  stream_all(sink, mesh.points.size(), [&](std::string& bytes, std::size_t i) {
    append_coordinates(bytes, "v ", mesh.points[i]);
    if (!mesh.colours.empty()) append_obj_colour(bytes, mesh.colours[i]);
    bytes += '\n';
  });
  stream_triangles(sink, "f ", mesh, 1);
}

void stream_off(const ByteSink& sink, const TriangleSoup& mesh) {
  sink("OFF\n" + std::to_string(mesh.points.size()) + ' ' + std::to_string(mesh.triangles.size()) +
       " 0\n");
  stream_points(sink, "", mesh);
  stream_triangles(sink, "3 ", mesh, 0);
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

void stream_ply_ascii(const ByteSink& sink, const TriangleSoup& mesh, Attributes attributes) {
  sink(ply_header(mesh, attributes, "ascii"));
  stream_all(sink, mesh.points.size(), [&](std::string& bytes, std::size_t i) {
    append_coordinates(bytes, "", mesh.points[i]);
    const auto append_value = [&bytes](auto value) {
      bytes += ' ';
      append_number(bytes, value);
    };
    if (!mesh.colours.empty()) {
      for (const std::uint8_t component : mesh.colours[i]) append_value(int{component});
    }
    for (const VertexAttribute& attribute : attributes) {
      std::visit([&](const auto& values) { append_value(widened(values[i])); }, attribute.values);
    }
    bytes += '\n';
  });
  stream_triangles(sink, "3 ", mesh, 0);
}

void stream_ply(const ByteSink& sink, const TriangleSoup& mesh, Attributes attributes) {
  sink(ply_header(mesh, attributes, "binary_little_endian"));
  stream_all(sink, mesh.points.size(), [&](std::string& bytes, std::size_t i) {
    for (const double coordinate : mesh.points[i]) append_little_endian(bytes, coordinate);
    if (!mesh.colours.empty()) {
      for (const std::uint8_t component : mesh.colours[i]) append_little_endian(bytes, component);
    }
    for (const VertexAttribute& attribute : attributes) {
      std::visit([&](const auto& values) { append_little_endian(bytes, values[i]); },
                 attribute.values);
    }
  });
  stream_all(sink, mesh.triangles.size(), [&](std::string& bytes, std::size_t f) {
    bytes += '\3';
    for (const std::uint32_t corner : mesh.triangles[f]) append_little_endian(bytes, corner);
  });
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

void stream_stl(const ByteSink& sink, const TriangleSoup& mesh) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw LimitError("a binary STL file holds at most 4294967295 triangles");
  }
  std::string header(80, ' ');
  append_little_endian(header, static_cast<std::uint32_t>(mesh.triangles.size()));
  sink(header);
  stream_all(sink, mesh.triangles.size(), [&](std::string& bytes, std::size_t f) {
    const Triangle& triangle = mesh.triangles[f];
    for (const float x : facet_normal(mesh, triangle)) append_little_endian(bytes, x);
    for (const std::uint32_t corner : triangle) {
      for (const double x : mesh.points[corner]) {
        append_little_endian(bytes, static_cast<float>(x));
      }
    }
    append_little_endian(bytes, std::uint16_t{0});
  });
}

void stream_stl_ascii(const ByteSink& sink, const TriangleSoup& mesh) {
  sink("solid\n");
  stream_all(sink, mesh.triangles.size(), [&](std::string& bytes, std::size_t f) {
    const Triangle& triangle = mesh.triangles[f];
    bytes += "facet normal";
    for (const float x : facet_normal(mesh, triangle)) {
      bytes += ' ';
      append_number(bytes, x);
    }
    bytes += "\nouter loop\n";
    for (const std::uint32_t corner : triangle) append_point(bytes, "vertex ", mesh.points[corner]);
    bytes += "endloop\nendfacet\n";
  });
  sink("endsolid\n");
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

void stream_mesh(const TriangleSoup& mesh, MeshFormat format,
                 std::span<const VertexAttribute> attributes, const ByteSink& sink) {
  check_values(mesh, attributes, format);
  switch (format) {
    case MeshFormat::obj:
      return stream_obj(sink, mesh);
    case MeshFormat::off:
      return stream_off(sink, mesh);
    case MeshFormat::ply:
      return stream_ply(sink, mesh, attributes);
    case MeshFormat::ply_ascii:
      return stream_ply_ascii(sink, mesh, attributes);
    case MeshFormat::stl:
      return stream_stl(sink, mesh);
    case MeshFormat::stl_ascii:
      return stream_stl_ascii(sink, mesh);
  }
  throw UsageError("unknown mesh format");
}

std::string encode_mesh(const TriangleSoup& mesh, MeshFormat format,
                        std::span<const VertexAttribute> attributes) {
  std::string bytes;
  stream_mesh(mesh, format, attributes, [&bytes](std::string_view part) { bytes += part; });
  return bytes;
}

Coordinates coordinates_of(MeshFormat format) {
  return format == MeshFormat::stl ? Coordinates::floats : Coordinates::doubles;
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
      const Point3 point = kept(mesh.points[triangle[k]], coordinates_of(format));
      merged[k] = merger.index_of(point, seen.points);
    }
    seen.triangles.push_back(merged);
  }
  return seen;
}

}  // namespace cellocut
