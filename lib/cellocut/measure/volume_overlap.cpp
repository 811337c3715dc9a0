#include "cellocut/measure/volume_overlap.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cellocut/base/line_coverage.h"
#include "cellocut/base/random_stream.h"
#include "cellocut/validity/box_tree.h"
#include "cellocut/validity/float_frame.h"
#include "cellocut/validity/position_merge.h"

namespace cellocut {

namespace {

std::int64_t count_odd_edges(const std::vector<Triangle>& faces) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * faces.size());
  for (const Triangle& t : faces) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      if (low != high) edges.push_back(std::uint64_t{low} << 32U | high);
    }
  }
  tbb::parallel_sort(edges.begin(), edges.end());
  std::int64_t odd = 0;
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end] == edges[begin]) ++end;
    odd += static_cast<std::int64_t>((end - begin) % 2);
    begin = end;
  }
  return odd;
}

Box3 checked_box(const TriangleSoup& mesh) {
  if (mesh.empty()) throw InputError("no faces");
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      if (!is_finite(mesh.points[corner])) throw InputError("a coordinate is not finite");
    }
  }
  return bounding_box(mesh);
}

bool within(const Box3& box, const Point3& p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(p[axis] >= box.low[axis] && p[axis] <= box.high[axis])) return false;
  }
  return true;
}

Flat flat(const Point3& p) { return {p[0], p[1]}; }

}  // namespace

struct InsideTest::Faces {
  std::vector<Point3> points;
  std::vector<Triangle> triangles;
  Box3 box;
  FloatFrame frame;
  std::int64_t odd_edges;
  BoxTree tree;

  explicit Faces(const TriangleSoup& mesh)
      : points(mesh.points),
        triangles(mesh.triangles),
        box(checked_box(mesh)),
        frame(box),
        odd_edges(count_odd_edges(merged_triangles())),
        tree(triangles.size(),
             [this](std::uint32_t f) { return float_box(frame, points, triangles[f]); }) {}

  [[nodiscard]] std::vector<Triangle> merged_triangles() const {
    const std::vector<std::uint32_t> first = merge_equal_positions(points);
    std::vector<Triangle> merged = triangles;
    for (Triangle& t : merged) {
      for (std::uint32_t& corner : t) corner = first[corner];
    }
    return merged;
  }
};

InsideTest::InsideTest(const TriangleSoup& mesh) : faces_(std::make_unique<Faces>(mesh)) {}
InsideTest::~InsideTest() = default;
InsideTest::InsideTest(InsideTest&&) noexcept = default;
InsideTest& InsideTest::operator=(InsideTest&&) noexcept = default;

std::int64_t InsideTest::odd_edges() const { return faces_->odd_edges; }
const Box3& InsideTest::box() const { return faces_->box; }

InsideTest::Place InsideTest::operator()(const Point3& p) const {
  Place place;
  if (!within(faces_->box, p)) return place;
  // The half-line from p upwards. Rounding to single precision is monotone, so a box that holds a
  // point of it still does so afterwards.
  FloatBox ray = float_box({faces_->frame(p)});
  ray.high[2] = std::numeric_limits<float>::infinity();
  faces_->tree.visit_boxes(ray, [&](std::uint32_t face) {
    const Triangle& t = faces_->triangles[face];
    const Point3& a = faces_->points[t[0]];
    const Point3& b = faces_->points[t[1]];
    const Point3& c = faces_->points[t[2]];
    if (!line_passes(flat(a), flat(b), flat(c), flat(p))) return;
    const int upward = turn(a[0], a[1], b[0], b[1], c[0], c[1]);
    if (upward * orientation(a, b, c, p) >= 0) return;
    place.inside = !place.inside;
    place.winding += upward;
  });
  return place;
}

std::optional<double> VolumeOverlap::iou() const {
  if (in_either == 0) return std::nullopt;
  return static_cast<double>(in_both) / static_cast<double>(in_either);
}

std::optional<double> VolumeOverlap::standard_error() const {
  const std::optional<double> share = iou();
  if (!share) return std::nullopt;
  return std::sqrt(*share * (1 - *share) / static_cast<double>(in_either));
}

VolumeOverlap measure_volume_overlap(const InsideTest& mesh, const InsideTest& reference,
                                     std::size_t points, std::uint64_t seed,
                                     const Observer& observer) {
  if (!mesh.closed() || !reference.closed()) {
    throw UsageError("the volume of a surface that is not closed is not defined");
  }
  Box3 box = mesh.box();
  box.include(reference.box().low);
  box.include(reference.box().high);
  const Point3 size = box.high - box.low;
  // Apart from the streams by which surfaces are sampled.
  constexpr std::uint64_t kVolumes = 0xA0761D6478BD642FU;
  const RandomStream random(seed ^ kVolumes);
  const auto enclosed_again = [](const InsideTest::Place& place) {
    return place.inside ? std::abs(place.winding) != 1 : place.winding != 0;
  };
  const auto count = [&](const tbb::blocked_range<std::size_t>& range, VolumeOverlap sum) {
    observer.check();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      Point3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        p[axis] = box.low[axis] + random(3 * i + axis) * size[axis];
      }
      const InsideTest::Place a = mesh(p);
      const InsideTest::Place b = reference(p);
      sum.in_mesh += a.inside ? 1 : 0;
      sum.in_reference += b.inside ? 1 : 0;
      sum.in_both += a.inside && b.inside ? 1 : 0;
      sum.in_either += a.inside || b.inside ? 1 : 0;
      sum.enclosed_again_by_mesh += enclosed_again(a) ? 1 : 0;
      sum.enclosed_again_by_reference += enclosed_again(b) ? 1 : 0;
    }
    return sum;
  };
  // Whole numbers: no order of the sums changes them.
  VolumeOverlap result =
      tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, points, 1024), VolumeOverlap{}, count,
                           [](VolumeOverlap a, const VolumeOverlap& b) {
                             a.in_mesh += b.in_mesh;
                             a.in_reference += b.in_reference;
                             a.in_both += b.in_both;
                             a.in_either += b.in_either;
                             a.enclosed_again_by_mesh += b.enclosed_again_by_mesh;
                             a.enclosed_again_by_reference += b.enclosed_again_by_reference;
                             return a;
                           });
  result.points = static_cast<std::int64_t>(points);
  result.box_volume = size[0] * size[1] * size[2];
  return result;
}

}  // namespace cellocut
