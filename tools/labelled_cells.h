// The labelled tetrahedra of a result as arrays for a VTU file.
#pragma once

#include <string>

#include "cellocut/pipeline.h"
#include "viz/vtu_file.h"

namespace cellocut::tools {

using viz::encode_vtu;

// label_initial, label, anchored, ambiguous, phi, volume, component; parameters and energy as field
// data. Arrays that the pipeline did not get to are left out.
viz::LabelledCells labelled_cells(const RemeshResult& result, const RemeshOptions& options,
                                  const std::string& solver);

}  // namespace cellocut::tools
