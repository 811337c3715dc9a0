// The fill path of a problem whose minimum cuts are not nested: the plain recursion on the
// envelope.
#pragma once

#include "cellocut/path/fill_path.h"

namespace cellocut {

// As find_fill_path(), for any problem; without levels and zone flows.
FillPath find_envelope(const ParametricProblem& problem, const Lambda& first, const Lambda& last,
                       CutSolver& solver, Observer& observer, const FlowWitness& witness);

}  // namespace cellocut
