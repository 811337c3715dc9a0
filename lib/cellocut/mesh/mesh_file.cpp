// A mesh file is read whole before it is parsed; the bytes are freed as soon as the soup is there.
#include "cellocut/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "cellocut/base/atomic_file.h"
#include "cellocut/base/errors.h"
#include "cellocut/base/read_file.h"
#include "cellocut/mesh/mesh_readers.h"

namespace cellocut {
namespace {

constexpr std::array<std::pair<std::string_view, MeshFormat>, 6> kFormatNames{{
    {"obj", MeshFormat::obj},
    {"off", MeshFormat::off},
    {"ply", MeshFormat::ply},
    {"ply-ascii", MeshFormat::ply_ascii},
    {"stl", MeshFormat::stl},
    {"stl-ascii", MeshFormat::stl_ascii},
}};

std::string_view without_byte_order_mark(std::string_view bytes) {
  constexpr std::string_view kUtf8 = "\xEF\xBB\xBF";
  return bytes.starts_with(kUtf8) ? bytes.substr(kUtf8.size()) : bytes;
}

TriangleSoup parse(std::string_view bytes, MeshFormat format) {
  switch (format) {
    case MeshFormat::obj:
      return mesh_io::read_obj(without_byte_order_mark(bytes));
    case MeshFormat::off:
      return mesh_io::read_off(without_byte_order_mark(bytes));
    case MeshFormat::ply:
    case MeshFormat::ply_ascii:
      return mesh_io::read_ply(bytes);
    case MeshFormat::stl:
    case MeshFormat::stl_ascii:
      return mesh_io::read_stl(bytes);
  }
  throw UsageError("unknown mesh format");
}

}  // namespace

std::optional<MeshFormat> format_of_path(std::string_view path) {
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string_view::npos || path[dot] == '/') return std::nullopt;
  std::string ending(path.substr(dot + 1));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [name, format] : kFormatNames) {
    if (name == ending && name.size() == 3) return format;
  }
  return std::nullopt;
}

MeshFormat format_of_name(std::string_view name) {
  std::string known;
  for (const auto& [format_name, format] : kFormatNames) {
    if (format_name == name) return format;
    known += (known.empty() ? "" : ", ") + std::string(format_name);
  }
  throw UsageError("unknown mesh format '" + std::string(name) + "'; known: " + known);
}

TriangleSoup read_mesh(const std::string& path, std::optional<MeshFormat> format) {
  if (!format) format = format_of_path(path);
  if (!format) {
    throw UsageError(path == "-"
                         ? std::string("standard input needs --format")
                         : "cannot tell the mesh format of '" + path +
                               "' from its name (.obj .off .ply .stl); name it with --format");
  }
  const std::string bytes = read_file(path);
  try {
    return parse(bytes, *format);
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  }
}

void write_mesh(const TriangleSoup& mesh, const std::string& path, MeshFormat format,
                std::span<const VertexAttribute> attributes) {
  AtomicFile file(path);
  stream_mesh(mesh, format, attributes, [&file](std::string_view part) { file.write(part); });
  file.commit();
}

}  // namespace cellocut
