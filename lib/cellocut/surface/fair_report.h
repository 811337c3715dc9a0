// What `--fair` did to a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/coordinates.h"
#include "cellocut/base/observer.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct FairReport {
  std::int64_t patches = 0;
  std::int64_t patches_left = 0;      // unchanged: no rim to join, or nothing that bends less
  std::int64_t vertices_moved = 0;    // asked to
  std::int64_t vertices_stopped = 0;  // short of the input
  double bending_before = 0;          // integral of (2 H)^2 over the patches
  double bending_after = 0;
  std::int64_t bad_faces_at_first = 0;  // that were degenerate or intersected before the retreat
  std::int64_t stopped_early = 0;       // vertices that the retreat left short of their targets
  std::int64_t went_back = 0;           // and those it put back
};

// Moves the completed patches of a valid surface where fair_completed() (fairing.h) wants them, as
// far as the surface stays valid (retreat.h). Lengths in input units; `step` is the grid's;
// vertices stop at `coordinates` alone.
FairReport fair_surface(TriangleSoup& surface, const std::vector<std::uint8_t>& supported,
                        const NearestTriangle& input, double step, double clearance,
                        Observer& observer, Coordinates coordinates = Coordinates::doubles);

}  // namespace cellocut
