// The header of a PLY file. Internal to the PLY readers.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cellocut::mesh_io {

enum class PlyEncoding { text, little_endian, big_endian };
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type{};                     // of the value, or of each value of a list
  std::optional<PlyType> count_type;  // of the length, where it is a list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
  // Bytes of one instance in a binary file; nothing where a list makes it vary.
  [[nodiscard]] std::optional<std::size_t> fixed_size() const;
};

struct PlyHeader {
  PlyEncoding encoding{};
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  // of the header: where the data begin
  std::size_t lines = 0;
};

// The first element of that name; null where there is none.
const PlyElement* find_element(const PlyHeader& header, std::string_view name);
// Number of the property of that name (list or not), or kAbsent.
constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();
std::size_t find_property(const PlyElement& element, std::string_view name, bool list);
// A mesh, as opposed to a point cloud.
bool has_faces(const PlyHeader& header);

// Errors: InputError with the line.
PlyHeader read_ply_header(std::string_view bytes);

}  // namespace cellocut::mesh_io
