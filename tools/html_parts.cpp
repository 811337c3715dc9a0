#include "tools/html_parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace cellocut::tools {

namespace {

double length_of(const Bar& bar, bool stacked) {
  double length = 0;
  for (const BarPart& part : bar.parts) {
    const double value = std::max(0.0, part.value);
    length = stacked ? length + value : std::max(length, value);
  }
  return length;
}

// The kinds in the order in which they come first.
std::vector<BarPart> legend_of(const std::vector<Bar>& bars) {
  std::vector<BarPart> legend;
  for (const Bar& bar : bars) {
    for (const BarPart& part : bar.parts) {
      const auto same = [&](const BarPart& other) { return other.kind == part.kind; };
      if (std::none_of(legend.begin(), legend.end(), same)) legend.push_back(part);
    }
  }
  return legend;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * ((bytes.size() + 2) / 3));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      word = (word << 8) | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[(word >> (18 - 6 * k)) & 63U] : '=';
    }
  }
  return text;
}

std::string group_digits(std::int64_t value) {
  const std::string digits = fmt::format("{}", value);
  const std::size_t sign = value < 0 ? 1 : 0;
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > sign && (digits.size() - i) % 3 == 0) text += "\u202f";
    text += digits[i];
  }
  return text;
}

std::string bar_chart(const std::string& title, const std::string& note,
                      const std::vector<Bar>& bars, bool stacked) {
  double longest = 0;
  for (const Bar& bar : bars) longest = std::max(longest, length_of(bar, stacked));
  std::string text =
      fmt::format("<figure class=\"chart\"><figcaption><strong>{}</strong>", escape_html(title));
  const std::vector<BarPart> legend = legend_of(bars);
  if (legend.size() > 1) {
    text += "<span class=\"legend\">";
    for (const BarPart& part : legend) {
      text += fmt::format("<span><i class=\"{}\"></i>{}</span>", part.kind, escape_html(part.name));
    }
    text += "</span>";
  }
  text += "</figcaption>";
  for (const Bar& bar : bars) {
    text += fmt::format("<div class=\"bar\"><span class=\"name\">{}</span><span class=\"track{}\">",
                        escape_html(bar.label), stacked ? "" : " apart");
    for (const BarPart& part : bar.parts) {
      const double share = longest > 0 ? std::max(0.0, part.value) / longest : 0;
      text += fmt::format("<i class=\"{}\" style=\"width:{:.3f}%\" title=\"{}: {:.6g}\"></i>",
                          part.kind, 100 * share, escape_html(part.name), part.value);
    }
    text += fmt::format("</span><span class=\"number\">{}</span></div>", escape_html(bar.text));
  }
  if (!note.empty()) text += fmt::format("<p class=\"note\">{}</p>", escape_html(note));
  return text + "</figure>\n";
}

}  // namespace cellocut::tools
