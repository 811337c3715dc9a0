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

// The next line that holds more than blanks and a comment. Errors: InputError at the end of the
// file, saying that `number` of `count` `things` (what was being read) are there.
LineScanner next_line(LineReader& lines, const char* things, std::size_t number,
                      std::size_t count) {
  std::string_view text;
  while (lines.next(text)) {
    LineScanner line(text, lines.line());
    if (!line.at_end()) return line;
  }
  throw InputError("the header promises " + std::to_string(count) + " " + things +
                   ", the file ends after " + std::to_string(number) +
                   " (truncated, or not on a line each)");
}

std::size_t count_at(LineScanner& line, const char* what) {
  const std::int64_t count = line.integer(what);
  if (count < 0) line.fail(std::string(what) + " is negative: " + std::to_string(count));
  return static_cast<std::size_t>(count);
}

// What stands on the line of a vertex after x y z, by the keyword.
struct Columns {
  bool normal = false;  // before the colour
  bool colour = false;  // r g b or r g b a, up to texture coordinates
};

// Removes a keyword such as OFF, COFF or STCNOFF (it may be left out) from the front of a line.
std::string_view without_keyword(std::string_view text, std::size_t line, Columns& columns) {
  const std::size_t begin = text.find_first_not_of(" \t");
  std::size_t end = text.find("OFF", begin);
  if (end == std::string_view::npos) return text;
  const std::string_view prefix = text.substr(begin, end - begin);
  if (prefix.find_first_not_of("STCN4n") != std::string_view::npos) return text;
  if (prefix.find_first_of("4n") != std::string_view::npos) {
    fail_at_line(line, "only OFF files in three dimensions are read");
  }
  columns.colour = prefix.find('C') != std::string_view::npos;
  columns.normal = prefix.find('N') != std::string_view::npos;
  end += 3;
  LineScanner after(text.substr(end), line);
  if (after.token() == "BINARY") fail_at_line(line, "binary OFF files are not read");
  return text.substr(end);
}

struct Counts {
  Columns columns;
  std::size_t points = 0;
  std::size_t faces = 0;
};

Counts read_header(LineReader& lines) {
  std::string_view text;
  bool keyword_seen = false;
  Counts counts;
  while (lines.next(text)) {
    LineScanner blank(text, lines.line());
    if (blank.at_end()) continue;
    if (!keyword_seen) text = without_keyword(text, lines.line(), counts.columns);
    keyword_seen = true;
    LineScanner line(text, lines.line());
    if (line.at_end()) continue;
    counts.points = count_at(line, "the number of vertices");
    counts.faces = count_at(line, "the number of faces");
    return counts;  // the number of edges is of no use, and some writers leave it out
  }
  throw InputError("the file ends before the number of vertices");
}

void read_colour(LineScanner& line, bool normal_first, SoupBuilder& builder) {
  for (int k = 0; normal_first && k < 3; ++k) line.token();
  std::array<double, 4> numbers{};
  std::size_t count = 0;
  for (; count < numbers.size() && !line.at_end(); ++count) numbers[count] = line.number_or_nan();
  if (count >= 3) builder.set_colour(std::span(numbers).first(count));
}

}  // namespace

TriangleSoup read_off(std::string_view bytes) {
  LineReader lines(bytes);
  const Counts counts = read_header(lines);
  SoupBuilder builder;
  builder.reserve_points(counts.points, bytes.size() / 6);  // "0 0 0\n"
  builder.reserve_faces(counts.faces, bytes.size() / 8);    // "3 0 0 0\n"
  for (std::size_t i = 0; i < counts.points; ++i) {
    LineScanner line = next_line(lines, "vertices", i, counts.points);
    const double x = line.number("a coordinate");
    const double y = line.number("a coordinate");
    const double z = line.number("a coordinate");
    builder.add_point({x, y, z});
    if (counts.columns.colour) read_colour(line, counts.columns.normal, builder);
  }
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < counts.faces; ++i) {
    LineScanner line = next_line(lines, "faces", i, counts.faces);
    const std::size_t corner_count = count_at(line, "the number of corners");
    if (corner_count < 3) {
      line.fail("a face with " + std::to_string(corner_count) + " corners, at least 3 are needed");
    }
    corners.clear();
    for (std::size_t k = 0; k < corner_count; ++k) {
      const std::int64_t corner = line.integer("a vertex index");
      if (corner < 0 || corner > std::numeric_limits<std::uint32_t>::max()) {
        line.fail("vertex index " + std::to_string(corner) + " is out of range");
      }
      corners.push_back(static_cast<std::uint32_t>(corner));
    }
    builder.add_face(corners, lines.line());
  }
  return builder.finish("line", 0);
}

}  // namespace cellocut::mesh_io
