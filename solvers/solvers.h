// The table of minimum-cut solvers, generated from the lines of solvers/CMakeLists.txt.
#pragma once

#include "cellocut/base/variant.h"
#include "cellocut/cut/cut_solver.h"

namespace cellocut::solvers {

const std::vector<Variant<CutSolver>>& registered();

inline std::unique_ptr<CutSolver> make(const std::string& name) {
  return make_variant(registered(), "solver", name);
}

}  // namespace cellocut::solvers
