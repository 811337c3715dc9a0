// Smooth completion: where the surface closes a gap it has no input to go to, and follows a bending
// energy instead.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct FairingOptions {
  // Rings of supported vertices next to a completed region that move with it as if they were
  // completed: there the surface curls around the edge of a sheet, and a patch that took up that
  // slope would go off in its direction. 0 to margin_rings.
  int rim_rings = 3;
  // Rings of supported vertices that may move in all, those after the first rim_rings held to the
  // input; 1 to 100. Beyond them everything is fixed.
  int margin_rings = 6;
  // Of the squared distance in steps by which a margin vertex leaves its place along the direction
  // to its nearest input point, against the bending energy, which has no unit; above 0.
  double data_weight = 1;
  double outlier_steps =
      0.25;  // from where on a margin vertex pulls with a constant force; above 0
  // Over which length, in steps, the facets of the cut are smoothed before the bending energy is
  // looked at; above 0.
  double smoothing_steps = 4;
  int rounds = 3;           // times that the bending energy is linearised anew; 0 to 100
  int max_iterations = 30;  // of the solver in each round; 1 to 1000

  // Errors: UsageError that names the field and what it may be.
  void validate() const;
};

struct FairingResult {
  std::vector<Point3> points;  // one per vertex of the surface; those that do not move, bit by bit
  std::int64_t patches = 0;
  std::int64_t vertices_moved = 0;
  std::int64_t vertices_stopped = 0;  // short of the input
  // Unchanged: no rim to join, or nothing found that bends less.
  std::int64_t patches_left = 0;
  double largest_move = 0;  // in the units of the surface
  // Integral of (2 H)^2 over the patches with their margins, H the mean curvature; has no unit.
  double bending_before = 0;
  double bending_after = 0;
};

// Targets for the vertices of the completed patches and a margin around each. Patches are solved
// one thread each, in parallel, and do not know of each other; the result has the same bits for any
// number of threads.
//
// 1. Completed vertices go where a membrane that holds on to their places pulls them, so that the
//    facets of the cut, which are large and meet at any angle, are rounded over smoothing_steps and
//    triangles are of about one size. A stiffer start would overshoot within the surface, and fold.
// 2. Rounds: vertices are spread evenly within the surface, then moved by u along the normals n,
// for
//      least sum of area (2 H + L u)^2 + data_weight sum of huber((x + u n - x0) . m)
//    by Ceres, with the cotangent Laplacian L of the present shape. x0 is where a supported vertex
//    was, m the direction to it from its nearest input point. Where the data are silent the rounds
//    end with L (2 H) = 0, mean curvature that varies as little as the rim allows (Schneider,
//    Kobbelt: Geometric fairing of irregular meshes for free-form surface design, 2001); planes,
//    spheres and cylinders are such surfaces. L u stands for the change of 2 H, which is exact
//    where the principal curvatures are equal. Area and L count rows beyond the last vertex that
//    moves, so the patch meets its rim with the rim's slope. A round after which the surface bends
//    more is undone, and the next begins from what a longer membrane makes of it.
// 3. No vertex comes nearer to the input, anywhere on the straight way from its place to its
//    target, than about 3/8 of `clearance` (or half of its first distance, where that is less): it
//    stops before. So none passes through.
//
// `surface`: closed, manifold, oriented; any unit of length. `supported`: a byte per vertex, not 0
// where the surface follows the input. `input`: nearest points of the input mesh, `step`: the grid
// step, about the length of an edge; `clearance`: how far supported vertices keep from the input;
// all in the unit of the surface. The targets are not checked for intersections. A component
// without supported vertices is left as it is.
// O(n) to find the patches, for one of k vertices O(k) and two sparse factorisations a
// round: of the membrane, and of the moves' reduced equations (displacement_basis.h).
// Errors: UsageError (options; a `supported` of another size; a step that is not above 0; a
// clearance below 0); Cancelled.
FairingResult fair_completed(const TriangleSoup& surface,
                             const std::vector<std::uint8_t>& supported,
                             const NearestTriangle& input, double step, double clearance,
                             const FairingOptions& options, Observer& observer);

}  // namespace cellocut
