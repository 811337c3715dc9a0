// Pieces of a page: text that is safe in it, numbers, bars.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cellocut::tools {

// For the content of an element and for attributes in double quotes: & < > " ' become references.
std::string escape_html(std::string_view text);

// RFC 4648, with padding.
std::string base64(std::string_view bytes);

// 1234567 with narrow spaces between groups of three digits.
std::string group_digits(std::int64_t value);

struct BarPart {
  std::string kind;  // a class of the style sheet, which gives the colour
  std::string name;
  double value = 0;  // below 0 counts as 0
};

struct Bar {
  std::string label;
  std::vector<BarPart> parts;
  std::string text;  // beside the bar, already formatted
};

// Bars from zero on one linear scale, which ends at the longest bar, as elements that need no
// script. Stacked parts lie one after the other; parts that are not stacked one below the other.
std::string bar_chart(const std::string& title, const std::string& note,
                      const std::vector<Bar>& bars, bool stacked);

}  // namespace cellocut::tools
