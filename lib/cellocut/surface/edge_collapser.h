// Simplifies a surface edge by edge, the cheapest first, as long as it stays embedded.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/surface/collapse_mesh.h"
#include "cellocut/surface/collapse_test.h"
#include "cellocut/surface/distance_test.h"
#include "cellocut/surface/simplification.h"
#include "cellocut/surface/vertex_heap.h"
#include "cellocut/surface/vertex_quadrics.h"

namespace cellocut {

class EdgeCollapser {
 public:
  // `surface` must outlive this; `bound` in its units on how far removed vertices are from what is
  // left, and faces that are left from the surface (0: none). O(n log n). Precondition: as for
  // simplify_surface().
  EdgeCollapser(const TriangleSoup& surface, double bound, Observer& observer);

  // Collapses until at most `target` faces are left or no collapse is allowed. Every vertex waits
  // with the cost of its cheapest collapse; when its turn comes, each of its collapses is tested as
  // the surface is at that moment, in the order of costs. A vertex that has nowhere to go gets
  // another turn when something changes beside it, and when all others have had theirs, until a
  // round of these changes nothing. O(n log n) where few collapses are refused. Errors: Cancelled.
  void run(std::int64_t target);

  [[nodiscard]] std::int64_t face_count() const { return mesh_.face_count(); }
  [[nodiscard]] const CollapseCounts& counts() const { return counts_; }
  // What is left, with the points that are left, in their order.
  [[nodiscard]] TriangleSoup surface(std::vector<std::uint32_t>& source) const;

 private:
  struct Candidate {
    double cost;
    std::uint32_t to;
    OpenMesh::HalfedgeHandle halfedge;
  };

  void queue(std::uint32_t v);
  void queue_all();
  bool take_turn(std::uint32_t v, double key);
  bool try_collapse(const Candidate& candidate);
  bool is_allowed();

  const TriangleSoup& input_;
  Observer& observer_;
  CollapseMesh mesh_;
  CollapseTest test_;
  std::optional<DistanceTest> distance_;
  VertexQuadrics quadrics_;
  VertexHeap heap_;
  CollapseCounts counts_;
  std::vector<Candidate> candidates_;  // of one vertex; kept for its memory
  Collapse collapse_;                  // likewise
};

}  // namespace cellocut
