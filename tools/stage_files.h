// All stages of a remesh as files for ParaView, and one file that opens them together.
#pragma once

#include <string>

#include "cellocut/pipeline.h"

namespace cellocut::tools {

// Writes to a folder, which is made if it is not there; what the run did not come to is left out:
//   input.vtp              the input; per face `boundary`, `nonmanifold`, `degenerate`,
//                          `intersecting` (0 or 1) and `defect` (the gravest of them)
//   thickened.vtp          phi = 0
//   proxy.vtp              the decimated proxy
//   interface_initial.vtp  the facets between initially interior and exterior cells
//   cut_facets.vtp         these and the facets of both canonical minimum cuts; per facet `cut` (1
//                          where the chosen labelling cuts it), `area` (squared input units),
//                          `weight`, `flow` (in units of energy), `saturation`, `supported` (share)
//   cells.vtu              the labelled cells
//   output.vtp             the surface, with its provenance where there is one
//   run.vtm                all of them
// Errors: OutputError; as find_face_defects().
void write_stage_files(const RemeshResult& result, const RemeshOptions& options,
                       const TriangleSoup& input, const std::string& solver,
                       const std::string& folder, Observer& observer);

}  // namespace cellocut::tools
