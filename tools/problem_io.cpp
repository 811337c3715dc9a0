#include "tools/problem_io.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cellocut/base/errors.h"
#include "cellocut/base/read_file.h"
#include "tools/session.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

// Bins up to the last that is not empty; bin k counts 2^k <= capacity < 2^(k + 1).
Json histogram_json(const CapacityHistogram& histogram) {
  const auto last = std::find_if(histogram.rbegin(), histogram.rend(),
                                 [](std::uint64_t count) { return count != 0; });
  return std::vector<std::uint64_t>(histogram.begin(), last.base());
}

}  // namespace

std::optional<ProblemFormat> problem_format_of_path(const std::string& path) {
  if (has_ending(path, ".max")) return ProblemFormat::dimacs;
  if (has_ending(path, ".bbk")) return ProblemFormat::bbk;
  return std::nullopt;
}

ProblemFormat problem_format_of_name(const std::string& name) {
  if (name == "max") return ProblemFormat::dimacs;
  if (name == "bbk") return ProblemFormat::bbk;
  if (name == "bbk-int32") return ProblemFormat::bbk_int32;
  throw UsageError("unknown problem format '" + name + "'; known: max, bbk, bbk-int32");
}

DimacsProblem read_problem(const std::string& path, ProblemFormat format) {
  const std::string bytes = read_file(path);
  try {
    if (format == ProblemFormat::dimacs) return parse_dimacs(bytes);
    return {.problem = parse_bbk(bytes), .nodes = {}, .left_out = {}};
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  }
}

void write_problem(const CutProblem& problem, const std::string& path, ProblemFormat format) {
  switch (format) {
    case ProblemFormat::dimacs:
      write_text(path, encode_dimacs(problem));
      return;
    case ProblemFormat::bbk:
      write_text(path, encode_bbk(problem, BbkCapacity::int64));
      return;
    case ProblemFormat::bbk_int32:
      write_text(path, encode_bbk(problem, BbkCapacity::int32));
      return;
  }
}

Json statistics_json(const ProblemStatistics& s) {
  return {{"nodes", s.nodes},
          {"edges", s.edges},
          {"loops", s.loops},
          {"arcs", s.arcs},
          {"zero_capacities", s.zero_capacities},
          {"edge_capacities_by_log2", histogram_json(s.edge_capacities)},
          {"terminal_capacities_by_log2", histogram_json(s.terminal_capacities)},
          {"source_nodes", s.source_nodes},
          {"sink_nodes", s.sink_nodes},
          {"both_nodes", s.both_nodes},
          {"source_share", s.source_share},
          {"sink_share", s.sink_share},
          {"both_share", s.both_share},
          {"degree",
           {{"minimum", s.degree.minimum},
            {"median", s.degree.median},
            {"maximum", s.degree.maximum},
            {"mean", s.degree.mean}}},
          {"components", s.components},
          {"largest_component", s.largest_component},
          {"diameter_lower_bound", s.diameter_lower_bound}};
}

}  // namespace cellocut::tools
