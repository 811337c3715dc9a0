// The labelled tetrahedra of a result as arrays for a VTU file.
#pragma once

#include <string>
#include <vector>

#include "cellocut/pipeline.h"
#include "viz/vtu_file.h"

namespace cellocut::tools {

using viz::encode_vtu;

// label_initial, label, anchored, ambiguous, phi, volume, component, after a relaxation lp_value;
// parameters and energy as field
// data. Arrays that the pipeline did not get to are left out.
viz::LabelledCells labelled_cells(const RemeshResult& result, const RemeshOptions& options,
                                  const std::string& solver);

// A relaxed value per cell on the scale of the labels, 0 interior to 1 exterior, from one per node
// of the graph, 1 on the source side: rounding it gives a label. A cell that was decided without
// the solver has its label. Precondition: one value per node.
std::vector<float> expand_relaxed(const CellGraph& graph, const std::vector<float>& relaxed);

}  // namespace cellocut::tools
