#include <array>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "cellocut/mesh/mesh_readers.h"
#include "cellocut/mesh/soup_builder.h"
#include "cellocut/mesh/text_scanner.h"

namespace cellocut::mesh_io {
namespace {

// A backslash at the end of a line continues it on the next one; comments are not continued, since
// they may end in anything (a path, for one).
void join_continued_lines(LineReader& lines, std::string_view& line, std::string& joined) {
  if (line.empty() || line.back() != '\\') return;
  const std::size_t first = line.find_first_not_of(" \t");
  if (line[first] == '#') return;
  joined.clear();
  std::string_view next = line;
  while (!next.empty() && next.back() == '\\') {
    joined.append(next.substr(0, next.size() - 1)) += ' ';
    if (!lines.next(next)) next = {};
  }
  joined.append(next);
  line = joined;
}

// Zero-based index of a corner as OBJ writes it: from 1, or negative from the last vertex so far.
std::uint32_t vertex_index(LineScanner& line, std::size_t point_count) {
  const std::int64_t written = line.leading_integer("a vertex index");
  if (written > 0 && written <= std::numeric_limits<std::uint32_t>::max()) {
    return static_cast<std::uint32_t>(written - 1);
  }
  const auto count = static_cast<std::int64_t>(point_count);
  if (written < 0 && written >= -count) return static_cast<std::uint32_t>(count + written);
  line.fail("vertex index " + std::to_string(written) +
            (written == 0  ? ", but OBJ counts from 1"
             : written > 0 ? " is out of range"
                           : ", but there are only " + std::to_string(count) + " vertices so far"));
}

// After x y z: r g b or r g b a. One number is a weight, and of more than four nobody knows what
// they are.
void read_colour(LineScanner& line, SoupBuilder& builder) {
  if (line.at_end()) return;
  std::array<double, 4> numbers{};
  std::size_t count = 0;
  for (; count < numbers.size() && !line.at_end(); ++count) numbers[count] = line.number_or_nan();
  if (count >= 3 && line.at_end()) builder.set_colour(std::span(numbers).first(count));
}

}  // namespace

TriangleSoup read_obj(std::string_view bytes) {
  SoupBuilder builder;
  LineReader lines(bytes);
  std::string_view text;
  std::string joined;
  std::vector<std::uint32_t> corners;
  while (lines.next(text)) {
    const std::size_t line_number = lines.line();
    join_continued_lines(lines, text, joined);
    LineScanner line(text, line_number);
    const std::string_view keyword = line.token();
    if (keyword == "v") {
      const double x = line.number("a coordinate");
      const double y = line.number("a coordinate");
      const double z = line.number("a coordinate");
      builder.add_point({x, y, z});
      read_colour(line, builder);
    } else if (keyword == "f" || keyword == "fo") {  // `fo` is the older name of `f`
      corners.clear();
      while (!line.at_end()) corners.push_back(vertex_index(line, builder.point_count()));
      if (corners.size() < 3) {
        builder.skip_polygon();  // exporters write loose edges so; it bounds nothing
      } else {
        builder.add_face(corners, line_number);
      }
    } else if (keyword.find('\0') != std::string_view::npos) {
      line.fail("binary data, this is not an OBJ file");
    }
  }
  return builder.finish("line", 1);
}

}  // namespace cellocut::mesh_io
