// What the readers of text files share.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cellocut {

// Throws InputError "line N: what".
[[noreturn]] void fail_at_line(std::size_t line, const std::string& what);

// A token as an error message shows it: in quotes, short, and with unprintable bytes replaced.
std::string quoted(std::string_view token);

constexpr bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

}  // namespace cellocut
