#include "cellocut/surface/live_faces.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace cellocut {

namespace {

constexpr std::uint32_t kGone = 0xFFFFFFFFU;
constexpr std::size_t kSmall = 1024;  // faces; a tree of fewer is not worth building anew

}  // namespace

LiveFaces::LiveFaces(const std::vector<Point3>& points, const std::vector<Triangle>& faces)
    : points_(points),
      frame_(bounding_box(points, faces)),
      count_(faces.size()),
      boxes_(faces.size()),
      place_(faces.size()) {
  tbb::parallel_for(std::size_t{0}, faces.size(),
                    [&](std::size_t f) { boxes_[f] = box_of(faces[f]); });
  std::vector<std::uint32_t> ids(faces.size());
  std::iota(ids.begin(), ids.end(), 0U);
  build(ids);
}

FloatBox LiveFaces::box_of(const Triangle& corners) const {
  return float_box(
      {frame_(points_[corners[0]]), frame_(points_[corners[1]]), frame_(points_[corners[2]])});
}

void LiveFaces::build(const std::vector<std::uint32_t>& ids) {
  tree_.emplace(ids, boxes_);
  tbb::parallel_for(std::size_t{0}, ids.size(), [&](std::size_t place) {
    place_[tree_->ids()[place]] = static_cast<std::uint32_t>(place);
  });
}

void LiveFaces::change(std::uint32_t face, const Triangle& corners) {
  boxes_[face] = box_of(corners);
  tree_->replace(place_[face], boxes_[face]);
}

void LiveFaces::hide(std::uint32_t face) {
  boxes_[face] = FloatBox::none();
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
