#include "cellocut/surface/fair_report.h"

#include "cellocut/surface/fairing.h"
#include "cellocut/surface/retreat.h"
#include "cellocut/validity/incidence.h"

namespace cellocut {

FairReport fair_surface(TriangleSoup& surface, const std::vector<std::uint8_t>& supported,
                        const NearestTriangle& input, double step, double clearance,
                        Observer& observer, Coordinates coordinates) {
  FairingResult wanted = fair_completed(surface, supported, input, step, clearance, {}, observer);
  for (Point3& p : wanted.points) p = kept(p, coordinates);
  Retreat moved = move_vertices(surface.points, wanted.points, wanted.points, surface.triangles,
                                corners_by_point(surface.triangles, surface.points.size()),
                                observer, coordinates);
  surface.points = std::move(moved.points);
  FairReport report{.patches = wanted.patches,
                    .patches_left = wanted.patches_left,
                    .vertices_moved = wanted.vertices_moved,
                    .vertices_stopped = wanted.vertices_stopped,
                    .bending_before = wanted.bending_before,
                    .bending_after = wanted.bending_after,
                    .bad_faces_at_first = moved.bad_faces_at_first};
  for (const std::uint8_t halvings : moved.halvings) {
    if (halvings == Retreat::kStayed) ++report.went_back;
    if (halvings > 0 && halvings < Retreat::kStayed) ++report.stopped_early;
  }
  return report;
}

}  // namespace cellocut
