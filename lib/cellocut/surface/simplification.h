// Fewer triangles, the same guarantee: a closed, embedded surface stays one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct SimplificationOptions {
  // Stop at this many triangles or one below; 0: no such target. 4 per component is the least there
  // can be.
  std::int64_t faces = 0;
  // Two-sided Hausdorff distance that is allowed between the result and the surface given, in its
  // units; 0: any.
  double max_error = 0;

  // Errors: UsageError where one is negative or not finite.
  void validate() const;
};

// Collapses done and, of those tried, refused; why is in edge_collapser.h and collapse_test.h.
struct CollapseCounts {
  std::int64_t collapses = 0;
  std::int64_t refused_topology = 0;
  std::int64_t refused_folding = 0;
  std::int64_t refused_slivers = 0;
  std::int64_t refused_degenerate = 0;
  std::int64_t refused_intersecting = 0;
  std::int64_t refused_distance = 0;
};

struct Simplification {
  TriangleSoup surface;
  std::vector<std::uint32_t> source;  // for each point the point of the surface given that it is
  // Whether what was asked for has been reached: `faces`, if given, and an error within `max_error`
  // by any collapse at all. `stop` says why not, in a sentence, and is empty otherwise.
  bool reached = true;
  std::string stop;
  // Two-sided Hausdorff distance to the surface given, in its units: proven bounds (see
  // surface_distance.h), `error` the upper one.
  double error = 0;
  double error_lower = 0;
  CollapseCounts counts;
  int attempts = 0;  // more than one where the error came out above `max_error` at first
};

// Collapses edges onto one of their ends, by quadric error metrics (vertex_quadrics.h), each only
// after an exact test that the surface stays a 2-manifold without degenerate and without
// intersecting faces (collapse_test.h): the result is as valid as the surface given, and has its
// topology: no component goes, no handle, no cavity. Points keep their coordinates. With a bound on
// the error, collapses are also refused where they leave the surface too far away
// (distance_test.h); where the distance measured afterwards is above `max_error` all the same, it
// starts again with a tighter bound (and progress from 0); after six such attempts it returns the
// surface as it is. If both options are 0 the surface is returned as it is.
//
// One thread (the measure of the error uses all); the same bits on every run, for any number of
// threads, and for surfaces that differ by a power of two. O(n log n); about 300 bytes a face.
//
// Precondition: the surface is valid as inspect_surface() has it. Errors: InputError where it is
// not a closed, oriented 2-manifold; UsageError; Cancelled.
Simplification simplify_surface(const TriangleSoup& surface, const SimplificationOptions& options,
                                Observer& observer);

}  // namespace cellocut
