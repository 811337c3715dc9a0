#include "cellocut/mesh/ply_header.h"

#include <array>
#include <utility>

#include "cellocut/mesh/text_scanner.h"

namespace cellocut::mesh_io {
namespace {

PlyType type_at(LineScanner& line) {
  // Both sets of names are in use: C's and the sized ones.
  static constexpr std::array<std::pair<std::string_view, PlyType>, 18> kNames{{
      {"char", PlyType::int8},
      {"int8", PlyType::int8},
      {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},
      {"short", PlyType::int16},
      {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},
      {"uint16", PlyType::uint16},
      {"int", PlyType::int32},
      {"int32", PlyType::int32},
      {"uint", PlyType::uint32},
      {"uint32", PlyType::uint32},
      {"int64", PlyType::int64},
      {"uint64", PlyType::uint64},
      {"float", PlyType::float32},
      {"float32", PlyType::float32},
      {"double", PlyType::float64},
      {"float64", PlyType::float64},
  }};
  const std::string_view name = line.token();
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  line.fail("unknown type " + quoted(name));
}

PlyEncoding encoding_at(LineScanner& line) {
  const std::string_view name = line.token();
  if (name == "ascii") return PlyEncoding::text;
  if (name == "binary_little_endian") return PlyEncoding::little_endian;
  if (name == "binary_big_endian") return PlyEncoding::big_endian;
  line.fail("unknown encoding " + quoted(name));
}

PlyProperty property_at(LineScanner& line) {
  PlyProperty property;
  LineScanner ahead = line;
  if (ahead.token() == "list") {
    line = ahead;
    property.count_type = type_at(line);
    if (*property.count_type == PlyType::float32 || *property.count_type == PlyType::float64) {
      line.fail("the length of a list cannot be a floating-point number");
    }
  }
  property.type = type_at(line);
  property.name = line.token();
  if (property.name.empty()) line.fail("a property without a name");
  return property;
}

PlyElement element_at(LineScanner& line) {
  PlyElement element;
  element.name = line.token();
  const std::int64_t count = line.integer("the number of instances");
  if (count < 0) line.fail("the number of instances is negative: " + std::to_string(count));
  element.count = static_cast<std::size_t>(count);
  return element;
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::int64:
    case PlyType::uint64:
    case PlyType::float64:
      return 8;
  }
  return 0;
}

std::optional<std::size_t> PlyElement::fixed_size() const {
  std::size_t size = 0;
  for (const PlyProperty& property : properties) {
    if (property.count_type) return std::nullopt;
    size += size_of(property.type);
  }
  return size;
}

const PlyElement* find_element(const PlyHeader& header, std::string_view name) {
  for (const PlyElement& element : header.elements) {
    if (element.name == name) return &element;
  }
  return nullptr;
}

std::size_t find_property(const PlyElement& element, std::string_view name, bool list) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.name == name && property.count_type.has_value() == list) return i;
  }
  return kAbsent;
}

bool has_faces(const PlyHeader& header) {
  const PlyElement* face = find_element(header, "face");
  return face != nullptr && face->count > 0;
}

PlyHeader read_ply_header(std::string_view bytes) {
  // The header is text even where the data are not: its line ends are told apart within it alone.
  constexpr std::string_view kEnd = "end_header";
  const std::size_t end = bytes.find(kEnd);
  if (!bytes.starts_with("ply") || end == std::string_view::npos) {
    if (!bytes.starts_with("ply")) throw InputError("not a PLY file: it does not begin with 'ply'");
    throw InputError("the header has no 'end_header' (truncated, or not a PLY file)");
  }
  std::size_t data = end + kEnd.size();
  while (data < bytes.size() && (bytes[data] == ' ' || bytes[data] == '\t')) ++data;
  if (data < bytes.size() && bytes[data] == '\r') ++data;
  if (data < bytes.size() && bytes[data] == '\n') ++data;

  PlyHeader header;
  header.bytes = data;
  bool encoding_seen = false;
  LineReader lines(bytes.substr(0, end));
  std::string_view text;
  while (lines.next(text)) {
    LineScanner line(text, lines.line());
    const std::string_view keyword = line.token();
    if (keyword == "format") {
      header.encoding = encoding_at(line);
      encoding_seen = true;
    } else if (keyword == "element") {
      header.elements.push_back(element_at(line));
    } else if (keyword == "property") {
      if (header.elements.empty()) line.fail("a property before any element");
      header.elements.back().properties.push_back(property_at(line));
    } else if (!keyword.empty() && keyword != "ply" && keyword != "comment" &&
               keyword != "obj_info") {
      line.fail("unknown header line " + quoted(keyword));
    }
  }
  header.lines = lines.line() + 1;
  if (!encoding_seen) throw InputError("the header has no 'format'");
  return header;
}

}  // namespace cellocut::mesh_io
