// Lines and numbers of a text mesh file that is in memory. Numbers are read with std::from_chars:
// correctly rounded, and independent of the locale. Internal to the mesh readers.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "cellocut/base/errors.h"
#include "cellocut/base/text.h"

namespace cellocut::mesh_io {

// Cuts a text into lines that end in LF or CR LF (or in CR alone, where the text holds no LF at
// all). The last line need not be ended. Lines count from 1.
class LineReader {
 public:
  explicit LineReader(std::string_view text);
  // False at the end of the text. The line comes without its end.
  bool next(std::string_view& line);
  // Number of the line that next() returned last.
  [[nodiscard]] std::size_t line() const { return line_; }
  // What follows the line that next() returned last.
  [[nodiscard]] std::string_view rest() const { return text_.substr(position_); }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t line_ = 0;
  char end_of_line_ = '\n';
};

// Walks through the blank-separated tokens of one line. A token that starts with '#' ends the line.
class LineScanner {
 public:
  LineScanner(std::string_view text, std::size_t line)
      : at_(text.data()), end_(text.data() + text.size()), line_(line) {}

  // True where nothing but blanks or a comment is left.
  bool at_end();
  // The next token, empty at the end of the line.
  std::string_view token();
  // A finite number, here and as a whole token. `what` names it in the error.
  double number(const char* what);
  // The next token as a number; NaN where it is none. For what a mesh can do without.
  double number_or_nan();
  // An integer, ended by a blank or the end of the line.
  std::int64_t integer(const char* what);
  // An integer as faces of OBJ have them: `7`, `7/1`, `7//3` or `7/1/3`, of which the first is
  // returned.
  std::int64_t leading_integer(const char* what);

  [[nodiscard]] std::size_t line() const { return line_; }
  [[noreturn]] void fail(const std::string& what) const { fail_at_line(line_, what); }

 private:
  [[nodiscard]] std::string_view peek() const;
  const char* integer_at(const char* what, std::int64_t& value);

  const char* at_;
  const char* end_;
  std::size_t line_;
};

}  // namespace cellocut::mesh_io
