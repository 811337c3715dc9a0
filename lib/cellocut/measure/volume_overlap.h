// Which points does a closed surface enclose, and how much of their volume do two solids share?
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// Tells inside from outside by the parity of the faces above a point.
//
// Nothing is rounded: which faces the line through the point passes through, and on which side of
// each the point lies, are exact predicates on the coordinates as given, with one half-open rule
// for lines through edges and corners (line_coverage.h). So over a surface on whose every edge an
// even number of faces meet, the parity is that of the true solid for every point that is not on
// the surface itself, however the line runs.
class InsideTest {
 public:
  // Errors: InputError where there is no face or a coordinate is not finite. Parallel; O(n log n).
  explicit InsideTest(const TriangleSoup& mesh);
  ~InsideTest();
  InsideTest(InsideTest&&) noexcept;
  InsideTest& operator=(InsideTest&&) noexcept;

  // The number of edges at which an odd number of faces meet, after points of equal coordinates are
  // merged. Where it is 0 the surface is closed; else parity means nothing.
  [[nodiscard]] std::int64_t odd_edges() const;
  [[nodiscard]] bool closed() const { return odd_edges() == 0; }
  [[nodiscard]] const Box3& box() const;

  struct Place {
    bool inside = false;       // an odd number of faces lie above
    std::int64_t winding = 0;  // faces above that look up, less those that look down
  };
  // Precondition: closed(); finite. From any number of threads at once. O(log n + faces near the
  // line).
  [[nodiscard]] Place operator()(const Point3& p) const;

 private:
  struct Faces;
  std::unique_ptr<Faces> faces_;
};

// Counts of points that are uniform in the smallest box around both solids.
struct VolumeOverlap {
  std::int64_t points = 0;
  std::int64_t in_mesh = 0;
  std::int64_t in_reference = 0;
  std::int64_t in_both = 0;
  std::int64_t in_either = 0;
  // Points inside by parity whose winding number is neither 1 nor -1, or outside where it is not 0:
  // where a surface encloses twice, or its faces are not oriented alike. Parity says 'outside' of
  // what two overlapping parts have in common.
  std::int64_t enclosed_again_by_mesh = 0;
  std::int64_t enclosed_again_by_reference = 0;
  double box_volume = 0;  // in cubed input units

  // in_both / in_either; absent where no point is in either.
  [[nodiscard]] std::optional<double> iou() const;
  // Of iou(): sqrt(iou (1 - iou) / in_either).
  [[nodiscard]] std::optional<double> standard_error() const;
  bool operator==(const VolumeOverlap&) const = default;
};

// `points` independent uniform points, of a stream of the seed of their own. The same for any
// number of threads. Precondition: both are closed. Errors: UsageError where one is not; Cancelled.
// Parallel.
VolumeOverlap measure_volume_overlap(const InsideTest& mesh, const InsideTest& reference,
                                     std::size_t points, std::uint64_t seed,
                                     const Observer& observer = silent_observer());

}  // namespace cellocut
