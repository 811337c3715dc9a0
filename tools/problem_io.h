// Cut problems as files of the command line: .max (DIMACS) and .bbk.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "cellocut/cut/problem_file.h"
#include "cellocut/cut/problem_statistics.h"

namespace cellocut::tools {

enum class ProblemFormat { dimacs, bbk, bbk_int32 };

// By the ending of the name: .max, .bbk; nothing for any other.
std::optional<ProblemFormat> problem_format_of_path(const std::string& path);

// `max`, `bbk` or `bbk-int32`. Errors: UsageError that lists them.
ProblemFormat problem_format_of_name(const std::string& name);

// Reads a problem; "-" is standard input. Node i of a .bbk has the DIMACS id i + 3, source and sink
// are 1 and 2. Errors: InputError with the path.
DimacsProblem read_problem(const std::string& path, ProblemFormat format);

// Writes a problem through AtomicFile. Errors: OutputError; LimitError where a number does not fit.
void write_problem(const CutProblem& problem, const std::string& path, ProblemFormat format);

nlohmann::ordered_json statistics_json(const ProblemStatistics& statistics);

}  // namespace cellocut::tools
