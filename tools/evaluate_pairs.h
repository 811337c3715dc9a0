// `cellocut evaluate --pairs`: many meshes, each against a reference of its own, in one call.
#pragma once

#include <string>

#include "tools/reference.h"
#include "tools/session.h"

namespace cellocut::tools {

// Prints a row for each pair as it is done (unless quiet, or the JSON takes standard output), and
// writes to common.json {version, pairs[], counts}. A pair has `mesh`, `reference` and `line` as in
// the list; `error` and `exit_code`; and `evaluation`, the whole object of a call for that pair
// alone, null where it failed. A pair that fails gets a line on standard error, and the others go
// on. Returns 0 where none failed, else the exit code of the first that did.
// Errors: InputError about the list; OutputError; Cancelled.
int evaluate_pairs(const std::string& list, const EvaluationWork& work,
                   const CommonOptions& common);

}  // namespace cellocut::tools
