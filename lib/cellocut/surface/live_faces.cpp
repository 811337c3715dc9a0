#include "cellocut/surface/live_faces.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <span>
#include <utility>

namespace cellocut {

namespace {

constexpr std::uint32_t kGone = 0xFFFFFFFFU;
constexpr std::size_t kSmall = 1024;  // faces; a tree of fewer is not worth building anew

}  // namespace

LiveFaces::LiveFaces(const std::vector<Point3>& points, const std::vector<Triangle>& faces)
    : points_(points),
      frame_(bounding_box(points, faces)),
      count_(faces.size()),
      tree_(faces.size(), [&](std::uint32_t f) { return box_of(faces[f]); }),
      place_(std::make_unique_for_overwrite<std::uint32_t[]>(faces.size())) {
  note_places();
}

FloatBox LiveFaces::box_of(const Triangle& corners) const {
  return float_box(frame_, points_, corners);
}

void LiveFaces::note_places() {
  const std::span<const std::uint32_t> ids = tree_.ids();
  tbb::parallel_for(std::size_t{0}, ids.size(), [&](std::size_t place) {
    place_[ids[place]] = static_cast<std::uint32_t>(place);
  });
}

void LiveFaces::change(std::uint32_t face, const Triangle& corners) {
  tree_.replace(place_[face], box_of(corners));
}

void LiveFaces::hide(std::uint32_t face) { tree_.replace(place_[face], FloatBox::none()); }

void LiveFaces::remove(std::uint32_t face) {
  hide(face);
  place_[face] = kGone;
  --count_;
  if (count_ < kSmall || 2 * count_ > tree_.ids().size()) return;
  std::vector<std::uint32_t> left;
  left.reserve(count_);
  for (const std::uint32_t id : tree_.ids()) {
    if (place_[id] != kGone) left.push_back(id);
  }
  // In the order of faces: the tree then does not depend on the one before.
  std::sort(left.begin(), left.end());
  tree_ = BoxTree(std::move(left), [this](std::uint32_t id) { return box(id); });
  note_places();
}

}  // namespace cellocut
