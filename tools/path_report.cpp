#include "tools/path_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tools/html_parts.h"
#include "tools/report_json.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

std::string fraction(const Lambda& lambda) {
  return lambda.q == 1 ? fmt::format("{}", lambda.p) : fmt::format("{}/{}", lambda.p, lambda.q);
}

double unsupported_share(const PathEntry& entry) {
  const double area = entry.supported + entry.unsupported;
  return area > 0 ? entry.unsupported / area : 0;
}

// A place on the plot: lambda from left to right, logarithmic; shares from bottom to top.
class PlotFrame {
 public:
  PlotFrame(const Lambda& first, const Lambda& last)
      : low_(std::log10(to_double(first))), high_(std::log10(to_double(last))) {}

  static constexpr double kLeft = 60;
  static constexpr double kRight = 860;
  static constexpr double kTop = 50;
  static constexpr double kBottom = 360;

  [[nodiscard]] double x(double lambda) const {
    return kLeft + (std::log10(lambda) - low_) / (high_ - low_) * (kRight - kLeft);
  }
  static double y(double share) { return kBottom - share * (kBottom - kTop); }
  [[nodiscard]] int first_decade() const { return static_cast<int>(std::ceil(low_ - 1e-9)); }
  [[nodiscard]] int last_decade() const { return static_cast<int>(std::floor(high_ + 1e-9)); }

 private:
  double low_;
  double high_;
};

// A line of steps through a value of each entry.
template <class Value>
std::string steps(const std::vector<PathEntry>& entries, const PlotFrame& frame, const char* colour,
                  const Value& value) {
  std::string points;
  for (const PathEntry& entry : entries) {
    const double y = PlotFrame::y(value(entry));
    fmt::format_to(std::back_inserter(points), "{:.2f},{:.2f} {:.2f},{:.2f} ",
                   frame.x(to_double(entry.from)), y, frame.x(to_double(entry.to)), y);
  }
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n",
                     points, colour);
}

}  // namespace

std::vector<PathEntry> path_entries(const RemeshResult& result, const CellPath& path,
                                    const std::vector<PathSolid>& solids) {
  const FillPath& found = path.path;
  const double area = result.frame.unit * result.frame.unit / result.areas.scale;
  std::vector<PathEntry> entries;
  for (std::size_t k = 0; k < path.count(); ++k) {
    PathEntry entry;
    const LambdaInterval interval = interval_of(found, k);
    entry.from = interval.from;
    entry.to = interval.to;
    entry.quanta = found.areas[k];
    entry.supported = static_cast<double>(entry.quanta.supported) * area;
    entry.unsupported = static_cast<double>(entry.quanta.unsupported) * area;
    entry.solid = solids[k];
    entries.push_back(entry);
  }
  return entries;
}

Json path_json(const std::vector<PathEntry>& entries, const CellPath& path,
               const CertificateReport& certificate) {
  Json list = Json::array();
  for (const PathEntry& entry : entries) {
    // At the geometric mean of its interval.
    const double lambda = std::sqrt(to_double(entry.from) * to_double(entry.to));
    list.push_back(
        {{"from", to_double(entry.from)},
         {"to", to_double(entry.to)},
         {"from_exact", fraction(entry.from)},
         {"to_exact", fraction(entry.to)},
         {"supported_quanta", entry.quanta.supported},
         {"unsupported_quanta", entry.quanta.unsupported},
         {"supported_area", entry.supported},
         {"unsupported_area", entry.unsupported},
         {"energy", {{"lambda", lambda}, {"value", entry.supported + lambda * entry.unsupported}}},
         {"volume", entry.solid.volume},
         {"interior_cells", entry.solid.cells},
         {"components", entry.solid.components},
         {"certificate", certificate.valid}});
  }
  return {{"labellings", list},
          {"search",
           {{"solves", path.path.solves},
            {"solver_calls", path.path.digits},
            {"solved_nodes", path.path.solved_nodes}}},
          {"certificate", certificate_json(certificate)}};
}

std::string path_csv(const std::vector<PathEntry>& entries) {
  std::string text =
      "lambda_from,lambda_to,lambda_from_exact,lambda_to_exact,supported_quanta,"
      "unsupported_quanta,supported_area,unsupported_area,volume,interior_cells,components\n";
  for (const PathEntry& entry : entries) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{}\n",
                   to_double(entry.from), to_double(entry.to), fraction(entry.from),
                   fraction(entry.to), entry.quanta.supported, entry.quanta.unsupported,
                   entry.supported, entry.unsupported, entry.solid.volume, entry.solid.cells,
                   entry.solid.components);
  }
  return text;
}

std::string path_plot(const std::vector<PathEntry>& entries, const std::string& title) {
  const PlotFrame frame(entries.front().from, entries.back().to);
  double most = 0;
  for (const PathEntry& entry : entries) most = std::max(most, entry.solid.volume);
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"920\" height=\"420\" "
      "font-family=\"sans-serif\" font-size=\"13\">\n"
      "<rect width=\"920\" height=\"420\" fill=\"white\"/>\n";
  const auto out = std::back_inserter(svg);
  fmt::format_to(out, "<text x=\"60\" y=\"24\" font-size=\"15\">{}</text>\n", escape_html(title));
  for (int decade = frame.first_decade(); decade <= frame.last_decade(); ++decade) {
    const double lambda = std::pow(10.0, decade);
    fmt::format_to(out,
                   "<line x1=\"{0:.2f}\" x2=\"{0:.2f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"#ccc\"/>\n"
                   "<text x=\"{0:.2f}\" y=\"378\" text-anchor=\"middle\">{3:g}</text>\n",
                   frame.x(lambda), PlotFrame::kTop, PlotFrame::kBottom, lambda);
  }
  for (int tenth = 0; tenth <= 10; tenth += 2) {
    fmt::format_to(out,
                   "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.2f}\" y2=\"{2:.2f}\" stroke=\"#eee\"/>\n"
                   "<text x=\"54\" y=\"{3:.2f}\" text-anchor=\"end\">{4:.1f}</text>\n",
                   PlotFrame::kLeft, PlotFrame::kRight, PlotFrame::y(tenth / 10.0),
                   PlotFrame::y(tenth / 10.0) + 4, tenth / 10.0);
  }
  constexpr const char* kVolume = "#1f5fa8";
  constexpr const char* kShare = "#c4511d";
  svg += steps(entries, frame, kVolume, [most](const PathEntry& entry) {
    return most > 0 ? entry.solid.volume / most : 0.0;
  });
  svg += steps(entries, frame, kShare, unsupported_share);
  fmt::format_to(out,
                 "<text x=\"460\" y=\"400\" text-anchor=\"middle\">lambda_fill</text>\n"
                 "<text x=\"500\" y=\"40\" fill=\"{}\">volume, relative to the largest</text>\n"
                 "<text x=\"720\" y=\"40\" fill=\"{}\">unsupported share</text>\n</svg>\n",
                 kVolume, kShare);
  return svg;
}

}  // namespace cellocut::tools
