// Lines and fields of a DIMACS file that is in memory, and how its numbers are written. Integers go
// through std::from_chars and std::to_chars: no locale has a say. Internal to the problem files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "cellocut/base/text.h"

namespace cellocut::cut_io {

// Walks through the lines of a text that are neither blank nor a comment (their first token starts
// with 'c'), and through the blank-separated tokens of each.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : text_(text) {}

  // Goes to the next line that holds something. False at the end of the text.
  bool next();
  // Number, from 1, of the line that next() went to; at the end that of the last line.
  [[nodiscard]] std::size_t number() const { return number_; }

  // The next token of the line, empty at its end.
  std::string_view token();
  // The next token as an integer. `what` names it in the error.
  std::int64_t integer(const char* what);
  // As above, refusing what is below zero.
  std::int64_t count(const char* what);
  // Fails where a token is left.
  void expect_end();

  [[noreturn]] void fail(const std::string& what) const { fail_at_line(number_, what); }

 private:
  std::string_view text_;  // what follows the line
  std::string_view line_;  // what follows the last token
  std::size_t number_ = 0;
};

// `key first second third\n`.
void append_line(std::string& text, char key, std::uint32_t first, std::uint32_t second,
                 std::int64_t third);

}  // namespace cellocut::cut_io
