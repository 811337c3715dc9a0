// What follows the header of a PLY file, text or binary. Internal to the PLY readers.
//
// All of them: errors are InputError without a path; nothing is allocated on the word of a header
// or of a list's length alone.
#pragma once

#include <bit>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cellocut/mesh/ply_header.h"
#include "cellocut/mesh/text_scanner.h"

namespace cellocut::mesh_io {

// ---- text: each instance on a line of its own ---------------------------------------------------

class TextBody {
 public:
  TextBody(std::string_view bytes, const PlyHeader& header)
      : lines_(bytes.substr(header.bytes)), lines_before_(header.lines) {}

  // The line of instance `number`. Errors: the file ends before.
  LineScanner next(const PlyElement& element, std::size_t number);
  // Lines cannot be counted without reading them.
  void require_all(const PlyElement& /*element*/) const {}
  // All instances of an element.
  void skip(const PlyElement& element);

 private:
  LineReader lines_;
  std::size_t lines_before_;
};

// The length of a list: not negative.
std::size_t list_length(LineScanner& line);
void skip_value(LineScanner& line, const PlyProperty& property);
// Errors: the line goes on.
void require_end(LineScanner& line);

// ---- binary -------------------------------------------------------------------------------------

class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, const PlyHeader& header);

  // The next `count` values of `size` bytes. Errors: InputError where the file ends before.
  const char* take(std::size_t count, std::size_t size, const PlyElement& element,
                   std::size_t number);
  // The length of a list, which must fit what is left of the file.
  std::size_t take_length(const PlyProperty& property, const PlyElement& element,
                          std::size_t number);
  // The value or the list, whole.
  const char* take_property(const PlyProperty& property, const PlyElement& element,
                            std::size_t number);
  // That all instances of an element of fixed size are there, so that a false count is found before
  // any work.
  void require_all(const PlyElement& element) const;
  // All instances of an element.
  void skip(const PlyElement& element);
  [[nodiscard]] std::endian order() const { return order_; }

 private:
  const char* at_;
  std::size_t left_;
  std::endian order_;
};

double load_number(const char* at, PlyType type, std::endian order);

// ---- both ---------------------------------------------------------------------------------------

// A property whose value is wanted: a finite number, called `what` in errors. One that is not
// required may be anything; what is no finite number comes as NaN.
struct PlyColumn {
  std::size_t property;
  const char* what;
  bool required = true;
};

// The columns x, y, z of the element 'vertex'. Errors: one of them is not there.
std::vector<PlyColumn> coordinate_columns(const PlyElement& vertex);

// The columns of a colour: red, green, blue, or diffuse_red and so on, in this order; none unless
// all three are there.
std::vector<PlyColumn> colour_columns(const PlyElement& vertex);

using NumberSink = std::function<void(std::span<const double>)>;
// Reads all instances of an element and hands the numbers of its columns, in their order, to the
// sink. Everything else is skipped.
void read_columns(TextBody& body, const PlyElement& element, std::span<const PlyColumn> columns,
                  const NumberSink& sink);
void read_columns(BinaryBody& body, const PlyElement& element, std::span<const PlyColumn> columns,
                  const NumberSink& sink);

}  // namespace cellocut::mesh_io
