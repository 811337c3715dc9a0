// The surfaces between the stages of a remesh, for whoever wants to know what each stage costs in
// accuracy.
#pragma once

#include <string>

#include "cellocut/pipeline.h"

namespace cellocut::tools {

// Writes to a folder, which is made if it is not there: thickened.ply (phi = 0), simplified.ply
// (the decimated proxy), tetrahedralized.ply (the facets between initially interior and exterior
// cells). The proxy and the facets need not be manifold. What the run did not come to is left out.
// Errors: OutputError.
void write_stage_surfaces(const RemeshResult& result, const std::string& folder);

}  // namespace cellocut::tools
