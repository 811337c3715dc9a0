#include "cellocut/surface/support.h"

#include <cmath>

namespace cellocut {

std::vector<std::uint8_t> find_supported(const TriangleSoup& surface, const SparseField& phi) {
  const std::vector<float> values = phi.sample(surface.points);
  std::vector<std::uint8_t> supported(values.size());
  for (std::size_t v = 0; v < values.size(); ++v) {
    supported[v] = std::fabs(static_cast<double>(values[v])) <= kSupportTolerance ? 1 : 0;
  }
  return supported;
}

}  // namespace cellocut
