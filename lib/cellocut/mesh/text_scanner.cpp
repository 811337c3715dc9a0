#include "cellocut/mesh/text_scanner.h"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <system_error>

namespace cellocut::mesh_io {

LineReader::LineReader(std::string_view text) : text_(text) {
  if (text.find('\n') == std::string_view::npos && text.find('\r') != std::string_view::npos) {
    end_of_line_ = '\r';
  }
}

bool LineReader::next(std::string_view& line) {
  if (position_ >= text_.size()) return false;
  const char* begin = text_.data() + position_;
  const std::size_t left = text_.size() - position_;
  const void* found = std::memchr(begin, end_of_line_, left);
  const std::size_t length =
      found == nullptr ? left : static_cast<std::size_t>(static_cast<const char*>(found) - begin);
  line = std::string_view(begin, length);
  position_ += found == nullptr ? length : length + 1;
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++line_;
  return true;
}

bool LineScanner::at_end() {
  while (at_ != end_ && is_blank(*at_)) ++at_;
  return at_ == end_ || *at_ == '#';
}

std::string_view LineScanner::peek() const {
  const char* end = at_;
  while (end != end_ && !is_blank(*end)) ++end;
  return {at_, static_cast<std::size_t>(end - at_)};
}

std::string_view LineScanner::token() {
  if (at_end()) return {};
  const std::string_view found = peek();
  at_ += found.size();
  return found;
}

double LineScanner::number(const char* what) {
  if (at_end()) fail(std::string("expected ") + what + ", the line ends");
  const char* begin = at_;
  if (*begin == '+' && begin + 1 != end_ && begin[1] != '-') ++begin;  // from_chars knows no plus
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end_, value);
  if (error == std::errc::invalid_argument || (stop != end_ && !is_blank(*stop))) {
    fail(std::string("expected ") + what + ", found " + quoted(peek()));
  }
  if (error == std::errc::result_out_of_range) {
    // Too small for a double is zero (or subnormal), too large is refused below; strtod tells.
    value = std::strtod(std::string(begin, stop).c_str(), nullptr);
  }
  if (!std::isfinite(value)) fail(std::string(what) + " is not finite: " + quoted(peek()));
  at_ = stop;
  return value;
}

double LineScanner::number_or_nan() {
  std::string_view text = token();
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && stop == text.data() + text.size();
  return whole && std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

const char* LineScanner::integer_at(const char* what, std::int64_t& value) {
  if (at_end()) fail(std::string("expected ") + what + ", the line ends");
  const char* begin = at_;
  if (*begin == '+' && begin + 1 != end_ && begin[1] != '-') ++begin;
  const auto [stop, error] = std::from_chars(begin, end_, value);
  if (error == std::errc::result_out_of_range) {
    fail(std::string(what) + " is out of range: " + quoted(peek()));
  }
  if (error != std::errc()) fail(std::string("expected ") + what + ", found " + quoted(peek()));
  return stop;
}

std::int64_t LineScanner::integer(const char* what) {
  std::int64_t value = 0;
  const char* stop = integer_at(what, value);
  if (stop != end_ && !is_blank(*stop)) {
    fail(std::string("expected ") + what + ", found " + quoted(peek()));
  }
  at_ = stop;
  return value;
}

std::int64_t LineScanner::leading_integer(const char* what) {
  std::int64_t value = 0;
  const char* stop = integer_at(what, value);
  if (stop != end_ && *stop == '/') {
    while (stop != end_ && (*stop == '/' || *stop == '-' || (*stop >= '0' && *stop <= '9'))) ++stop;
  }
  if (stop != end_ && !is_blank(*stop)) {
    fail(std::string("expected ") + what + ", found " + quoted(peek()));
  }
  at_ = stop;
  return value;
}

}  // namespace cellocut::mesh_io
