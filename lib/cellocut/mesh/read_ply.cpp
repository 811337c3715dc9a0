#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "cellocut/base/byte_order.h"
#include "cellocut/mesh/mesh_readers.h"
#include "cellocut/mesh/ply_header.h"
#include "cellocut/mesh/soup_builder.h"
#include "cellocut/mesh/text_scanner.h"

namespace cellocut::mesh_io {
namespace {

constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

// Number of the property of that name (list or not), or kAbsent.
std::size_t find_property(const PlyElement& element, std::string_view name, bool list) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.name == name && property.count_type.has_value() == list) return i;
  }
  return kAbsent;
}

std::size_t corner_list(const PlyElement& face) {
  const std::size_t found = find_property(face, "vertex_indices", true);
  return found != kAbsent ? found : find_property(face, "vertex_index", true);
}

using Coordinates = std::array<std::size_t, 3>;  // the numbers of the properties x, y, z

Coordinates coordinates_of(const PlyElement& vertex) {
  const Coordinates found{find_property(vertex, "x", false), find_property(vertex, "y", false),
                          find_property(vertex, "z", false)};
  for (int axis = 0; axis < 3; ++axis) {
    if (found[axis] == kAbsent) {
      throw InputError(std::string("the element 'vertex' has no property '") +
                       static_cast<char>('x' + axis) + "'");
    }
  }
  return found;
}

std::string face_with(std::size_t corners) {
  return "a face with " + std::to_string(corners) + " corners, at least 3 are needed";
}

std::string promise(const PlyElement& element, std::size_t found) {
  return "the header promises " + std::to_string(element.count) + " instances of '" + element.name +
         "', the file ends after " + std::to_string(found) + " (truncated)";
}

// ---- text: each instance on a line of its own ---------------------------------------------------

class TextBody {
 public:
  TextBody(std::string_view bytes, const PlyHeader& header)
      : lines_(bytes.substr(header.bytes)), lines_before_(header.lines) {}

  LineScanner next(const PlyElement& element, std::size_t number) {
    std::string_view text;
    while (lines_.next(text)) {
      LineScanner line(text, lines_before_ + lines_.line());
      if (!line.at_end()) return line;
    }
    throw InputError(promise(element, number));
  }

 private:
  LineReader lines_;
  std::size_t lines_before_;
};

std::size_t list_length(LineScanner& line) {
  const std::int64_t length = line.integer("the length of a list");
  if (length < 0) line.fail("the length of a list is negative: " + std::to_string(length));
  return static_cast<std::size_t>(length);
}

void skip_value(LineScanner& line, const PlyProperty& property) {
  const std::size_t count = property.count_type ? list_length(line) : 1;
  for (std::size_t k = 0; k < count; ++k) {
    if (line.token().empty()) line.fail("expected '" + property.name + "', the line ends");
  }
}

void require_end(LineScanner& line) {
  if (!line.at_end()) line.fail("more values than the header names: " + quoted(line.token()));
}

void read_text_vertices(TextBody& body, const PlyElement& element, SoupBuilder& builder) {
  const Coordinates coordinates = coordinates_of(element);
  for (std::size_t i = 0; i < element.count; ++i) {
    LineScanner line = body.next(element, i);
    Point3 point{};
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      int axis = 0;
      while (axis < 3 && coordinates[axis] != p) ++axis;
      if (axis < 3) {
        point[axis] = line.number("a coordinate");
      } else {
        skip_value(line, element.properties[p]);
      }
    }
    require_end(line);
    builder.add_point(point);
  }
}

void read_text_faces(TextBody& body, const PlyElement& element, SoupBuilder& builder) {
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

// ---- binary -------------------------------------------------------------------------------------

double load_number(const char* at, PlyType type, std::endian order) {
  switch (type) {
    case PlyType::int8:
      return load<std::int8_t>(at, order);
    case PlyType::uint8:
      return load<std::uint8_t>(at, order);
    case PlyType::int16:
      return load<std::int16_t>(at, order);
    case PlyType::uint16:
      return load<std::uint16_t>(at, order);
    case PlyType::int32:
      return load<std::int32_t>(at, order);
    case PlyType::uint32:
      return load<std::uint32_t>(at, order);
    case PlyType::int64:
      return static_cast<double>(load<std::int64_t>(at, order));
    case PlyType::uint64:
      return static_cast<double>(load<std::uint64_t>(at, order));
    case PlyType::float32:
      return load<float>(at, order);
    case PlyType::float64:
      return load<double>(at, order);
  }
  return 0;
}

class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, const PlyHeader& header)
      : at_(bytes.data() + header.bytes),
        left_(bytes.size() - header.bytes),
        order_(header.encoding == PlyEncoding::big_endian ? std::endian::big
                                                          : std::endian::little) {}

  // The next `count` values of `size` bytes. Errors: InputError where the file ends before.
  const char* take(std::size_t count, std::size_t size, const PlyElement& element,
                   std::size_t number) {
    if (count > left_ / size) throw InputError(promise(element, number));
    const char* begin = at_;
    at_ += count * size;
    left_ -= count * size;
    return begin;
  }
  // The length of a list, which must fit what is left of the file.
  std::size_t take_length(const PlyProperty& property, const PlyElement& element,
                          std::size_t number) {
    const char* at = take(1, size_of(*property.count_type), element, number);
    const double length = load_number(at, *property.count_type, order_);
    if (length < 0) {
      throw InputError(element.name + " " + std::to_string(number + 1) +
                       ": the length of a list is negative");
    }
    if (length > static_cast<double>(left_)) throw InputError(promise(element, number));
    return static_cast<std::size_t>(length);
  }
  // The value or the list, whole.
  const char* take_property(const PlyProperty& property, const PlyElement& element,
                            std::size_t number) {
    const std::size_t count = property.count_type ? take_length(property, element, number) : 1;
    return take(count, size_of(property.type), element, number);
  }
  // All instances of an element of fixed size at once, so that a false count is found before any
  // work.
  void require_all(const PlyElement& element, std::size_t size) const {
    if (size > 0 && element.count > left_ / size) {
      throw InputError("the header promises " + std::to_string(element.count) + " instances of '" +
                       element.name + "' of " + std::to_string(size) + " bytes, the file has " +
                       std::to_string(left_) + " bytes left for them (truncated)");
    }
  }
  [[nodiscard]] std::endian order() const { return order_; }

 private:
  const char* at_;
  std::size_t left_;
  std::endian order_;
};

void read_binary_vertices(BinaryBody& body, const PlyElement& element, SoupBuilder& builder) {
  const Coordinates coordinates = coordinates_of(element);
  for (std::size_t i = 0; i < element.count; ++i) {
    Point3 point{};
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const char* at = body.take_property(element.properties[p], element, i);
      for (int axis = 0; axis < 3; ++axis) {
        if (coordinates[axis] != p) continue;
        point[axis] = load_number(at, element.properties[p].type, body.order());
        if (!std::isfinite(point[axis])) {
          throw InputError("vertex " + std::to_string(i) +
                           " (counted from 0): a coordinate is not finite");
        }
      }
    }
    builder.add_point(point);
  }
}

void read_binary_faces(BinaryBody& body, const PlyElement& element, SoupBuilder& builder) {
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

const PlyElement* find_element(const PlyHeader& header, std::string_view name) {
  for (const PlyElement& element : header.elements) {
    if (element.name == name) return &element;
  }
  return nullptr;
}

void check_elements(const PlyHeader& header) {
  const PlyElement* face = find_element(header, "face");
  if (face == nullptr || face->count == 0) throw InputError("no faces");
  if (corner_list(*face) == kAbsent) {
    throw InputError("the element 'face' has no list 'vertex_indices' or 'vertex_index'");
  }
  if (find_element(header, "vertex") == nullptr) throw InputError("no element 'vertex'");
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
    for (const PlyElement& element : header.elements) {
      if (element.name == "vertex") {
        read_text_vertices(body, element, builder);
      } else if (element.name == "face") {
        read_text_faces(body, element, builder);
      } else if (!element.properties.empty()) {
        for (std::size_t i = 0; i < element.count; ++i) body.next(element, i);
      }
    }
    return builder.finish("line", 0);
  }
  BinaryBody body(bytes, header);
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;
    if (const auto size = element.fixed_size()) body.require_all(element, *size);
    if (element.name == "vertex") {
      read_binary_vertices(body, element, builder);
    } else if (element.name == "face") {
      read_binary_faces(body, element, builder);
    } else if (const auto size = element.fixed_size()) {
      body.take(element.count, *size, element, 0);
    } else {
      for (std::size_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties) {
          body.take_property(property, element, i);
        }
      }
    }
  }
  return builder.finish("face", 0);
}

}  // namespace cellocut::mesh_io
