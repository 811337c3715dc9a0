#include "tools/pipeline_arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <locale>
#include <map>
#include <optional>
#include <sstream>

#include "cellocut/base/errors.h"
#include "cellocut/memory_estimate.h"

namespace cellocut::tools {

namespace {

// Units of --memory. (CLI11's own AsSizeValue takes whole numbers alone, so no 1.5GB.)
const std::map<std::string, double> kByteUnits{
    {"b", 1},        {"k", 1e3},  {"kb", 1e3}, {"kib", 0x1p10}, {"m", 1e6},
    {"mb", 1e6},     {"g", 1e9},  {"gb", 1e9}, {"mib", 0x1p20}, {"gib", 0x1p30},
    {"tib", 0x1p40}, {"t", 1e12}, {"tb", 1e12}};
constexpr double kMostBytes = 1e18;

// "1,2.5,-3" or "1 2.5 -3".
std::optional<Point3> parse_point(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  Point3 point{};
  std::string rest;
  if (!(words >> point[0] >> point[1] >> point[2]) || words >> rest || !is_finite(point)) {
    return std::nullopt;
  }
  return point;
}

// Points, and those of files: one on each line; blank lines and what follows '#' are skipped.
std::vector<Point3> read_points(const std::string& option, const std::vector<std::string>& texts) {
  std::vector<Point3> points;
  for (const std::string& text : texts) {
    if (const std::optional<Point3> point = parse_point(text)) {
      points.push_back(*point);
      continue;
    }
    std::ifstream file(text);
    if (!file || std::filesystem::is_directory(text)) {
      throw UsageError(option + " " + text + ": neither a point X,Y,Z nor a file that can be read");
    }
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
      line.resize(std::min(line.size(), line.find('#')));
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      const std::optional<Point3> point = parse_point(line);
      if (!point) throw InputError("line " + std::to_string(number) + ": not a point X Y Z", text);
      points.push_back(*point);
    }
  }
  return points;
}

}  // namespace

void PipelineArguments::add_to(CLI::App& app, LambdaOption lambda_option) {
  app.add_option("-R,--resolution", options.resolution,
                 "Grid steps along the longest edge of the box, 8 to 16384")
      ->capture_default_str();
  auto* epsilon =
      app.add_option("--epsilon", options.epsilon,
                     "Thickening offset relative to the longest edge (default: max(1/512, "
                     "1/resolution))");
  app.add_option("--epsilon-abs", options.epsilon_absolute, "Thickening offset in input units")
      ->excludes(epsilon);
  app.add_option("--decimate", options.decimation.removed_share,
                 "Share of the proxy's faces to remove, 0 to 0.99")
      ->capture_default_str();
  app.add_option("--decimation", decimation,
                 "How: vertices put into clusters, or quadric edge collapses, which take longer")
      ->check(CLI::IsMember({"clusters", "quadric"}))
      ->capture_default_str();
  std::string weight = "Weight of an unsupported interface: a number or p/q, terms up to 2^20";
  if (lambda_option == LambdaOption::number_or_auto) {
    weight += "; auto: chosen so that most of the input has the solid on one side alone";
  }
  if (lambda_option != LambdaOption::none) {
    app.add_option("--lambda-fill", lambda, weight)->capture_default_str();
    app.add_flag("--no-thickening", no_thickening,
                 "Ablation: phi is the flood-signed distance, no offset");
    app.add_flag("--no-unary", no_unary, "Ablation: no cell is anchored interior");
  }
  app.add_option(
         "--memory", memory,
         "Refuse a run that by estimate takes more, as 6GB, 1.5GiB, 800MB or bytes (default: what "
         "the machine has; 0: no limit)")
      ->transform(CLI::AsNumberWithUnit(kByteUnits))
      ->check(CLI::NonNegativeNumber);
  app.add_option("--support", support,
                 "What of a facet between cells has weight 1: all of it where the initial labels "
                 "differ (labels), or the part of its area that lies in the slab or within half a "
                 "grid step of it (facets)")
      ->check(CLI::IsMember({"labels", "facets"}))
      ->capture_default_str();
  app.add_option("--exterior", exterior,
                 "What is fixed exterior: the unbounded region, or every hull cell that is not "
                 "initially interior")
      ->check(CLI::IsMember({"unbounded", "hull-cells"}))
      ->capture_default_str();
  app.add_option(
         "--inside", inside,
         "A point X,Y,Z (input units; --inside=-1,0,2 where it begins with a minus) that is "
         "to be solid, or a file with one on each line; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--outside", outside, "The same for what is to be empty: opens a cavity")
      ->allow_extra_args(false);
  app.add_option("--area-bits", options.area_bits,
                 "Facet areas sum to at most 2^bits quanta, 8 to 50")
      ->capture_default_str();
}

void PipelineArguments::complete() {
  options.lambda_auto = lambda == "auto";
  try {
    if (!options.lambda_auto) options.lambda_fill = parse_rational(lambda);
  } catch (const UsageError& error) {
    throw UsageError(std::string("--lambda-fill: ") + error.what());
  }
  options.guidance.inside = read_points("--inside", inside);
  options.guidance.outside = read_points("--outside", outside);
  options.memory_limit =
      memory ? static_cast<std::int64_t>(std::min(*memory, kMostBytes)) : available_memory();
  options.decimation.method =
      decimation == "clusters" ? DecimationMethod::clusters : DecimationMethod::quadric;
  options.support = support == "labels" ? SupportRule::labels : SupportRule::facets;
  options.exterior = exterior == "unbounded" ? ExteriorMode::unbounded : ExteriorMode::hull_cells;
  options.thickening = !no_thickening;
  options.unary = !no_unary;
}

}  // namespace cellocut::tools
