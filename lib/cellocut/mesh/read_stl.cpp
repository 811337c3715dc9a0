#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "cellocut/base/byte_order.h"
#include "cellocut/mesh/mesh_readers.h"
#include "cellocut/mesh/point_merger.h"
#include "cellocut/mesh/soup_builder.h"
#include "cellocut/mesh/text_scanner.h"

namespace cellocut::mesh_io {
namespace {

constexpr std::size_t kHeaderBytes = 84;  // 80 of any content, then the number of facets
constexpr std::size_t kFacetBytes = 50;  // normal, three corners (12 floats), 2 bytes of attributes

std::uint32_t facet_count(std::string_view bytes) {
  return load_little_endian<std::uint32_t>(bytes.data() + kHeaderBytes - 4);
}

bool same_word(std::string_view token, std::string_view word) {
  return token.size() == word.size() &&
         std::equal(token.begin(), token.end(), word.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         });
}

// Many writers begin the header of a binary file with "solid" too: where the size fits the number
// of facets exactly it is binary; otherwise it is text if it begins so and no byte near the start
// is one that text does not have.
bool is_text(std::string_view bytes) {
  if (bytes.size() >= kHeaderBytes &&
      bytes.size() == kHeaderBytes + kFacetBytes * std::size_t{facet_count(bytes)}) {
    return false;
  }
  const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
  if (!same_word(bytes.substr(begin, 5), "solid")) return false;
  return std::none_of(bytes.begin(), bytes.begin() + std::min<std::size_t>(bytes.size(), 1024),
                      [](char c) { return c >= 0 && c < '\t'; });
}

TriangleSoup read_binary(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) {
    throw InputError("a binary STL file has at least 84 bytes, the file has " +
                     std::to_string(bytes.size()) + " (truncated, or not an STL file)");
  }
  const std::size_t count = facet_count(bytes);
  const std::size_t expected = kHeaderBytes + kFacetBytes * count;
  // A few bytes of padding at the end do no harm, but no facet may be left behind unread.
  if (bytes.size() < expected || bytes.size() >= expected + kFacetBytes) {
    throw InputError("expected 84 + 50 x " + std::to_string(count) + " = " +
                     std::to_string(expected) + " bytes, the file has " +
                     std::to_string(bytes.size()) +
                     (bytes.size() < expected ? " (truncated)" : " (too long)"));
  }
  if (count == 0) throw InputError("no faces");
  TriangleSoup soup;
  PointMerger merger;
  soup.triangles.reserve(count);
  const char* facet = bytes.data() + kHeaderBytes;
  for (std::size_t i = 0; i < count; ++i, facet += kFacetBytes) {
    Triangle triangle{};
    for (int k = 0; k < 3; ++k) {
      Point3 point{};
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] = load_little_endian<float>(facet + 12 + 12 * k + 4 * axis);
        if (!std::isfinite(point[axis])) {
          throw InputError("facet " + std::to_string(i + 1) + " of " + std::to_string(count) +
                           ": a coordinate is not finite");
        }
      }
      triangle[k] = merger.index_of(point, soup.points);
    }
    soup.triangles.push_back(triangle);
  }
  return soup;
}

// The blank-separated words of a text file, whatever its lines.
class Words {
 public:
  explicit Words(std::string_view text) : lines_(text), line_({}, 0) {}

  // Moves to the next word, on a later line if need be; false at the end of the file.
  bool more() {
    std::string_view text;
    while (line_.at_end()) {
      if (!lines_.next(text)) return false;
      line_ = LineScanner(text, lines_.line());
    }
    return true;
  }
  // Errors: InputError at the end of the file.
  std::string_view word() {
    if (!more()) fail_at_line(lines_.line(), "the file ends inside a solid (truncated)");
    return line_.token();
  }
  void expect(std::string_view wanted) { require(word(), wanted); }
  void require(std::string_view found, std::string_view wanted) {
    if (!same_word(found, wanted)) {
      line_.fail("expected '" + std::string(wanted) + "', found " + quoted(found));
    }
  }
  double coordinate() {
    if (!more()) fail_at_line(lines_.line(), "the file ends inside a solid (truncated)");
    return line_.number("a coordinate");
  }
  void skip_line() { line_ = LineScanner({}, lines_.line()); }
  [[nodiscard]] std::size_t line() const { return line_.line(); }

 private:
  LineReader lines_;
  LineScanner line_;
};

void read_facet(Words& words, SoupBuilder& builder, PointMerger& merger,
                std::vector<std::uint32_t>& corners) {
  words.expect("normal");
  for (int k = 0; k < 3; ++k) words.word();  // often "nan" where a facet is degenerate
  words.expect("outer");
  words.expect("loop");
  corners.clear();
  std::string_view word = words.word();
  for (; same_word(word, "vertex"); word = words.word()) {
    const double x = words.coordinate();
    const double y = words.coordinate();
    const double z = words.coordinate();
    corners.push_back(merger.index_of({x, y, z}, builder.points()));
  }
  words.require(word, "endloop");
  if (corners.size() < 3) {
    fail_at_line(words.line(), "a facet with " + std::to_string(corners.size()) +
                                   " corners, at least 3 are needed");
  }
  words.expect("endfacet");
  builder.add_face(corners, words.line());
}

TriangleSoup read_text(std::string_view bytes) {
  SoupBuilder builder;
  PointMerger merger;
  std::vector<std::uint32_t> corners;
  Words words(bytes);
  while (words.more()) {
    words.expect("solid");
    words.skip_line();  // a name, of any words
    std::string_view word = words.word();
    for (; same_word(word, "facet"); word = words.word()) {
      read_facet(words, builder, merger, corners);
    }
    words.require(word, "endsolid");
    words.skip_line();
  }
  return builder.finish("line", 1);
}

}  // namespace

TriangleSoup read_stl(std::string_view bytes) {
  return is_text(bytes) ? read_text(bytes) : read_binary(bytes);
}

}  // namespace cellocut::mesh_io
