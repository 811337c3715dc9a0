// A virtual scan: what can be seen of a mesh from outside, as points with normals.
#pragma once

#include <cstdint>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/point_cloud.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct ScanOptions {
  std::size_t viewpoints = 200;  // 1 to 10^5
  std::size_t rays = 20'000;     // from each viewpoint, 1 to 10^7; 10^9 in all
  std::size_t points = 100'000;  // at most so many are kept, 1 to 10^8
  double spacing = 0;            // instead: relative to the longest edge, 1e-5 to 1; 0: by `points`
  std::uint64_t seed = 1;

  // Errors: UsageError that names the option and what it may be.
  void validate() const;
};

struct Scan {
  PointCloud cloud;           // in input units; unit normals that face the viewer
  std::uint64_t rays = 0;     // shot
  std::uint64_t hits = 0;     // first hits of these
  std::uint64_t grazing = 0;  // hits that were left out, see below
  double spacing = 0;         // relative: no two points that face the same way are closer
  double unit = 1;            // the longest edge in input units
};

// Viewpoints stand evenly on a sphere around the mesh (a Fibonacci lattice; Swinbank and Purser,
// "Fibonacci grids", 2006), at three times the radius of its bounding sphere. From each, rays go to
// points spread evenly over the disc that the bounding sphere covers (a sunflower pattern, turned
// by a random angle for each viewpoint). Where a ray first meets a face, the point and the face's
// normal, turned to the viewer, are noted: what lies behind is never seen. A sheet without
// thickness is seen from both sides, so gets points with both normals. The mesh's orientation does
// not matter.
//
// There are no gaps between faces that share an edge or a corner (ray_scene.h), so no ray slips
// into a closed surface; where a mesh has a crack, what lies behind it is visible.
// Hits at less than about a degree are left out: there the place of the hit on the face is worst,
// and other viewpoints see it better.
//
// The hits are thinned evenly (thinning.h). The same bits for any number of threads.
// Errors: UsageError by options.validate(); InputError where there is no face or no extent, or
// nothing is seen (no face has an area); LimitError (memory); Cancelled. Parallel;
// O(viewpoints rays log n).
Scan scan_outside(const TriangleSoup& mesh, const ScanOptions& options,
                  Observer& observer = silent_observer());

}  // namespace cellocut
