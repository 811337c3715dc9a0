#include "cellocut/mesh/ply_body.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include "cellocut/base/byte_order.h"

namespace cellocut::mesh_io {
namespace {

std::string promise(const PlyElement& element, std::size_t found) {
  return "the header promises " + std::to_string(element.count) + " instances of '" + element.name +
         "', the file ends after " + std::to_string(found) + " (truncated)";
}

// Number of the column that a property belongs to; columns.size() where it is none.
std::size_t column_of(std::size_t property, std::span<const PlyColumn> columns) {
  std::size_t k = 0;
  while (k < columns.size() && columns[k].property != property) ++k;
  return k;
}

}  // namespace

// ---- text ---------------------------------------------------------------------------------------

LineScanner TextBody::next(const PlyElement& element, std::size_t number) {
  std::string_view text;
  while (lines_.next(text)) {
    LineScanner line(text, lines_before_ + lines_.line());
    if (!line.at_end()) return line;
  }
  throw InputError(promise(element, number));
}

void TextBody::skip(const PlyElement& element) {
  if (element.properties.empty()) return;  // takes no line
  for (std::size_t i = 0; i < element.count; ++i) next(element, i);
}

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

// ---- binary -------------------------------------------------------------------------------------

BinaryBody::BinaryBody(std::string_view bytes, const PlyHeader& header)
    : at_(bytes.data() + header.bytes),
      left_(bytes.size() - header.bytes),
      order_(header.encoding == PlyEncoding::big_endian ? std::endian::big : std::endian::little) {}

const char* BinaryBody::take(std::size_t count, std::size_t size, const PlyElement& element,
                             std::size_t number) {
  if (count > left_ / size) throw InputError(promise(element, number));
  const char* begin = at_;
  at_ += count * size;
  left_ -= count * size;
  return begin;
}

std::size_t BinaryBody::take_length(const PlyProperty& property, const PlyElement& element,
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

const char* BinaryBody::take_property(const PlyProperty& property, const PlyElement& element,
                                      std::size_t number) {
  const std::size_t count = property.count_type ? take_length(property, element, number) : 1;
  return take(count, size_of(property.type), element, number);
}

void BinaryBody::require_all(const PlyElement& element) const {
  const std::size_t size = element.fixed_size().value_or(0);
  if (size > 0 && element.count > left_ / size) {
    throw InputError("the header promises " + std::to_string(element.count) + " instances of '" +
                     element.name + "' of " + std::to_string(size) + " bytes, the file has " +
                     std::to_string(left_) + " bytes left for them (truncated)");
  }
}

void BinaryBody::skip(const PlyElement& element) {
  if (element.properties.empty()) return;  // takes no bytes
  if (const auto size = element.fixed_size()) {
    take(element.count, *size, element, 0);
    return;
  }
  for (std::size_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) take_property(property, element, i);
  }
}

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

// ---- both ---------------------------------------------------------------------------------------

std::vector<PlyColumn> coordinate_columns(const PlyElement& vertex) {
  std::vector<PlyColumn> columns;
  for (const char* name : {"x", "y", "z"}) {
    columns.push_back({find_property(vertex, name, false), "a coordinate"});
    if (columns.back().property == kAbsent) {
      throw InputError(std::string("the element 'vertex' has no property '") + name + "'");
    }
  }
  return columns;
}

std::vector<PlyColumn> colour_columns(const PlyElement& vertex) {
  for (const std::string prefix : {"", "diffuse_"}) {
    std::vector<PlyColumn> columns;
    for (const char* name : {"red", "green", "blue"}) {
      const std::size_t property = find_property(vertex, prefix + name, false);
      if (property != kAbsent) columns.push_back({property, "a colour", false});
    }
    if (columns.size() == 3) return columns;
  }
  return {};
}

void read_columns(TextBody& body, const PlyElement& element, std::span<const PlyColumn> columns,
                  const NumberSink& sink) {
  std::vector<double> numbers(columns.size());
  for (std::size_t i = 0; i < element.count; ++i) {
    LineScanner line = body.next(element, i);
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const std::size_t k = column_of(p, columns);
      if (k < columns.size()) {
        if (!columns[k].required && line.at_end()) {
          line.fail("expected '" + element.properties[p].name + "', the line ends");
        }
        numbers[k] = columns[k].required ? line.number(columns[k].what) : line.number_or_nan();
      } else {
        skip_value(line, element.properties[p]);
      }
    }
    require_end(line);
    sink(numbers);
  }
}

void read_columns(BinaryBody& body, const PlyElement& element, std::span<const PlyColumn> columns,
                  const NumberSink& sink) {
  std::vector<double> numbers(columns.size());
  for (std::size_t i = 0; i < element.count; ++i) {
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      const char* at = body.take_property(property, element, i);
      const std::size_t k = column_of(p, columns);
      if (k == columns.size()) continue;
      numbers[k] = load_number(at, property.type, body.order());
      if (!std::isfinite(numbers[k]) && !columns[k].required) {
        numbers[k] = std::numeric_limits<double>::quiet_NaN();
      } else if (!std::isfinite(numbers[k])) {
        throw InputError("vertex " + std::to_string(i) + " (counted from 0): " + columns[k].what +
                         " is not finite");
      }
    }
    sink(numbers);
  }
}

}  // namespace cellocut::mesh_io
