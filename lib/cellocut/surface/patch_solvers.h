// The two systems of equations that fair a patch. Lengths in grid steps.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/surface/laplacian.h"

namespace cellocut {

// Moves the vertices i with is_free[i] (one byte per movable vertex) to where the sum over edges of
// |x_i - x_j|^2 and over free vertices of anchor |x_i - its present place|^2 is least. One sparse
// Cholesky factorisation for the three coordinates. False, and nothing moved, where the system is
// singular to rounding, which it is not for anchor > 0. O(n^1.5) on surfaces.
bool relax_membrane(const LaplaceRows& rows, const std::vector<std::uint8_t>& is_free,
                    double anchor, std::vector<Point3>& points);

}  // namespace cellocut
