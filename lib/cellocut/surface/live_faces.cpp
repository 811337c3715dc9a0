#include "cellocut/surface/live_faces.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cellocut {

namespace {

constexpr std::uint32_t kGone = 0xFFFFFFFFU;
constexpr std::size_t kSmall = 1024;  // faces; a tree of fewer is not worth building anew

}  // namespace

LiveFaces::LiveFaces(const std::vector<Point3>& points, const std::vector<Triangle>& faces)
    : points_(points), count_(faces.size()), boxes_(faces.size()), place_(faces.size()) {
  Box3 box{points[faces[0][0]], points[faces[0][0]]};
  for (const Triangle& t : faces) {
    for (const std::uint32_t v : t) {
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], points[v][axis]);
        box.high[axis] = std::max(box.high[axis], points[v][axis]);
      }
    }
  }
  // Into [-1, 1] by steps that are monotone also after rounding, as is the conversion to float:
  // boxes that overlap before do so afterwards (see intersections.cpp).
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    centre_[axis] = 0.5 * box.low[axis] + 0.5 * box.high[axis];
    extent = std::fmax(extent, 0.5 * box.high[axis] - 0.5 * box.low[axis]);
  }
  if (extent > 0) scale_ = std::ldexp(1.0, std::min(1000, -std::ilogb(extent) - 1));

  for (std::size_t f = 0; f < faces.size(); ++f) boxes_[f] = box_of(faces[f]);
  std::vector<std::uint32_t> ids(faces.size());
  std::iota(ids.begin(), ids.end(), 0U);
  build(ids);
}

FloatBox LiveFaces::box_of(const Triangle& corners) const {
  FloatBox box = FloatBox::none();
  box.low[3] = box.high[3] = 0;
  for (const std::uint32_t v : corners) {
    const Point3 p = scale_ * (points_[v] - centre_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], static_cast<float>(p[static_cast<int>(axis)]));
      box.high[axis] = std::max(box.high[axis], static_cast<float>(p[static_cast<int>(axis)]));
    }
  }
  return box;
}

void LiveFaces::build(const std::vector<std::uint32_t>& ids) {
  tree_.emplace(ids, boxes_);
  for (std::uint32_t place = 0; place < ids.size(); ++place) place_[tree_->ids()[place]] = place;
}

void LiveFaces::change(std::uint32_t face, const Triangle& corners) {
  boxes_[face] = box_of(corners);
  tree_->replace(place_[face], boxes_[face]);
}

void LiveFaces::remove(std::uint32_t face) {
  tree_->replace(place_[face], FloatBox::none());
  place_[face] = kGone;
  --count_;
  if (count_ < kSmall || 2 * count_ > tree_->ids().size()) return;
  std::vector<std::uint32_t> left;
  left.reserve(count_);
  for (const std::uint32_t id : tree_->ids()) {
    if (place_[id] != kGone) left.push_back(id);
  }
  // In the order of faces: the tree then does not depend on the one before.
  std::sort(left.begin(), left.end());
  build(left);
}

}  // namespace cellocut
