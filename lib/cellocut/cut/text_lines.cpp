#include "cellocut/cut/text_lines.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

namespace cellocut::cut_io {

namespace {

void skip_blanks(std::string_view& text) {
  std::size_t blanks = 0;
  while (blanks < text.size() && is_blank(text[blanks])) ++blanks;
  text.remove_prefix(blanks);
}

void append_number(std::string& text, std::int64_t number) {
  std::array<char, 20> digits{};  // a sign and 19 digits
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  text.append(digits.data(), end);
}

}  // namespace

bool TextLines::next() {
  while (!text_.empty()) {
    const std::size_t end = text_.find('\n');
    line_ = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    ++number_;
    skip_blanks(line_);
    if (!line_.empty() && line_.front() != 'c') return true;
  }
  line_ = {};
  number_ = std::max<std::size_t>(number_, 1);  // an empty file ends on its first line
  return false;
}

std::string_view TextLines::token() {
  skip_blanks(line_);
  std::size_t size = 0;
  while (size < line_.size() && !is_blank(line_[size])) ++size;
  const std::string_view found = line_.substr(0, size);
  line_.remove_prefix(size);
  return found;
}

std::int64_t TextLines::integer(const char* what) {
  const std::string_view found = token();
  if (found.empty()) fail(std::string("expected ") + what + ", the line ends");
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(found.data(), found.data() + found.size(), value);
  if (error == std::errc::result_out_of_range) {
    fail(std::string(what) + " does not fit 64 bits: " + quoted(found));
  }
  if (error != std::errc() || stop != found.data() + found.size()) {
    fail(std::string("expected ") + what + ", an integer, found " + quoted(found));
  }
  return value;
}

std::int64_t TextLines::count(const char* what) {
  const std::int64_t value = integer(what);
  if (value < 0) fail(std::string(what) + " is negative: " + std::to_string(value));
  return value;
}

void TextLines::expect_end() {
  const std::string_view found = token();
  if (!found.empty()) fail("more fields than the format has: " + quoted(found));
}

void append_line(std::string& text, char key, std::uint32_t first, std::uint32_t second,
                 std::int64_t third) {
  text += key;
  for (const std::int64_t number : {std::int64_t{first}, std::int64_t{second}, third}) {
    text += ' ';
    append_number(text, number);
  }
  text += '\n';
}

}  // namespace cellocut::cut_io
