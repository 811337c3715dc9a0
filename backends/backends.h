// The table of tetrahedralization backends, generated from the lines of backends/CMakeLists.txt.
#pragma once

#include "cellocut/base/variant.h"
#include "cellocut/complex/tetrahedralizer.h"

namespace cellocut::backends {

const std::vector<Variant<Tetrahedralizer>>& registered();

inline std::unique_ptr<Tetrahedralizer> make(const std::string& name) {
  return make_variant(registered(), "backend", name);
}

}  // namespace cellocut::backends
