#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "cellocut/mesh/mesh_readers.h"
#include "cellocut/mesh/ply_body.h"
#include "cellocut/mesh/ply_header.h"
#include "cellocut/mesh/soup_builder.h"
#include "cellocut/mesh/text_scanner.h"

namespace cellocut::mesh_io {
namespace {

std::size_t corner_list(const PlyElement& face) {
  const std::size_t found = find_property(face, "vertex_indices", true);
  return found != kAbsent ? found : find_property(face, "vertex_index", true);
}

std::string face_with(std::size_t corners) {
  return "a face with " + std::to_string(corners) + " corners, at least 3 are needed";
}

void read_faces(TextBody& body, const PlyElement& element, SoupBuilder& builder) {
  const std::size_t list = corner_list(element);
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < element.count; ++i) {
    LineScanner line = body.next(element, i);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      if (p != list) {
        skip_value(line, element.properties[p]);
        continue;
      }
      const std::size_t count = list_length(line);
      if (count < 3) line.fail(face_with(count));
      corners.clear();
      for (std::size_t k = 0; k < count; ++k) {
        const std::int64_t corner = line.integer("a vertex index");
        if (corner < 0 || corner > std::numeric_limits<std::uint32_t>::max()) {
          line.fail("vertex index " + std::to_string(corner) + " is out of range");
        }
        corners.push_back(static_cast<std::uint32_t>(corner));
      }
    }
    require_end(line);
    builder.add_face(corners, line.line());
  }
}

void read_faces(BinaryBody& body, const PlyElement& element, SoupBuilder& builder) {
  const std::size_t list = corner_list(element);
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < element.count; ++i) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (p != list) {
        body.take_property(property, element, i);
        continue;
      }
      const std::size_t count = body.take_length(property, element, i);
      const std::size_t size = size_of(property.type);
      const char* at = body.take(count, size, element, i);
      if (count < 3) throw InputError("face " + std::to_string(i + 1) + ": " + face_with(count));
      corners.clear();
      for (std::size_t k = 0; k < count; ++k, at += size) {
        const double corner = load_number(at, property.type, body.order());
        // The negated comparison also refuses what is not a number.
        if (!(corner >= 0 && corner <= std::numeric_limits<std::uint32_t>::max()) ||
            corner != std::floor(corner)) {
          throw InputError("face " + std::to_string(i + 1) + ": a vertex index is out of range");
        }
        corners.push_back(static_cast<std::uint32_t>(corner));
      }
    }
    builder.add_face(corners, i + 1);
  }
}

// What stands for full brightness in a component of that type; 0: the values tell.
double full_of(PlyType type) {
  if (type == PlyType::float32 || type == PlyType::float64) return 0;
  return type == PlyType::uint16 ? 65535 : 255;
}

void check_elements(const PlyHeader& header) {
  if (!has_faces(header)) throw InputError("no faces");
  if (corner_list(*find_element(header, "face")) == kAbsent) {
    throw InputError("the element 'face' has no list 'vertex_indices' or 'vertex_index'");
  }
  if (find_element(header, "vertex") == nullptr) throw InputError("no element 'vertex'");
}

// The vertices and faces of a body of either kind.
template <class Body>
void read_body(Body& body, const PlyHeader& header, SoupBuilder& builder) {
  const PlyElement* vertices = find_element(header, "vertex");
  const PlyElement* faces = find_element(header, "face");
  for (const PlyElement& element : header.elements) {
    body.require_all(element);
    if (&element == vertices) {
      std::vector<PlyColumn> columns = coordinate_columns(element);
      const std::vector<PlyColumn> colour = colour_columns(element);
      if (!colour.empty()) {
        builder.set_colour_full(full_of(element.properties[colour.front().property].type));
        columns.insert(columns.end(), colour.begin(), colour.end());
      }
      read_columns(body, element, columns, [&](std::span<const double> p) {
        builder.add_point({p[0], p[1], p[2]});
        if (p.size() == 6) builder.set_colour(p.subspan(3));
      });
    } else if (&element == faces) {
      read_faces(body, element, builder);
    } else {
      body.skip(element);
    }
  }
}

}  // namespace

TriangleSoup read_ply(std::string_view bytes) {
  const PlyHeader header = read_ply_header(bytes);
  check_elements(header);
  SoupBuilder builder;
  const std::size_t data_bytes = bytes.size() - header.bytes;
  // The least that a vertex (three values) and a face (a length and three corners) can take.
  builder.reserve_points(find_element(header, "vertex")->count, data_bytes / 3);
  builder.reserve_faces(find_element(header, "face")->count, data_bytes / 4);
  if (header.encoding == PlyEncoding::text) {
    TextBody body(bytes, header);
    read_body(body, header, builder);
    return builder.finish("line", 0);
  }
  BinaryBody body(bytes, header);
  read_body(body, header, builder);
  return builder.finish("face", 0);
}

}  // namespace cellocut::mesh_io
