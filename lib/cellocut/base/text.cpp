#include "cellocut/base/text.h"

#include "cellocut/base/errors.h"

namespace cellocut {

void fail_at_line(std::size_t line, const std::string& what) {
  throw InputError("line " + std::to_string(line) + ": " + what);
}

std::string quoted(std::string_view token) {
  constexpr std::size_t kLongest = 24;
  std::string text = "'";
  for (const char c : token.substr(0, kLongest)) text += (c >= ' ' && c <= '~') ? c : '?';
  return text + (token.size() > kLongest ? "...'" : "'");
}

}  // namespace cellocut
