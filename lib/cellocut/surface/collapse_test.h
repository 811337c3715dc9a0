// May a vertex be collapsed into its neighbour? Geometry's side of the question, decided exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/surface/collapse_mesh.h"
#include "cellocut/surface/live_faces.h"

namespace cellocut {

enum class CollapseVerdict { allowed, folds, sliver, degenerate, intersecting };

// Follows the surface from collapse to collapse; every one that happens has to be told.
class CollapseTest {
 public:
  // Both must outlive this. Precondition: the surface is embedded and has no degenerate face.
  CollapseTest(const std::vector<Point3>& points, const CollapseMesh& mesh);

  // - folds: a face would turn by more than some 80 degrees (a rule of taste: it keeps the surface
  //   from folding over, which need not make it intersect);
  // - sliver: a face would be flatter than 1 : 1000 and than all that it stands for (taste as well:
  //   such faces have no use, and rounding to float would make them degenerate);
  // - degenerate: a face would have its corners on one line, by exact predicate;
  // - intersecting: a face would meet another, of all that are there at this moment, in more than
  //   common corners and edges, by exact predicates.
  // So a surface that is embedded before an allowed collapse is embedded after it.
  // O(log n + faces nearby).
  [[nodiscard]] CollapseVerdict judge(const Collapse& collapse);

  void applied(const Collapse& collapse);

 private:
  [[nodiscard]] bool meets_others(const Collapse& collapse);

  const std::vector<Point3>& points_;
  const std::vector<Triangle>& faces_;
  LiveFaces live_;
  std::vector<FloatBox> boxes_;        // of the faces after a collapse; kept for its memory
  std::vector<std::uint32_t> nearby_;  // likewise
};

}  // namespace cellocut
