// The faces of a surface that changes, findable by their boxes: which faces may a new one touch?
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/validity/box_tree.h"
#include "cellocut/validity/float_frame.h"

namespace cellocut {

// A box tree whose boxes follow the faces. A face that grows keeps its leaf; the tree is built anew
// whenever half of its faces are gone, so that it stays a good one at O(1) each on average.
class LiveFaces {
 public:
  // All faces. `points` must outlive this. O(n log n), parallel. Precondition: not empty; corners
  // are finite.
  LiveFaces(const std::vector<Point3>& points, const std::vector<Triangle>& faces);

  [[nodiscard]] std::size_t count() const { return count_; }

  // The face has other corners now. O(log n). Precondition: the face is live.
  void change(std::uint32_t face, const Triangle& corners);
  // Nothing finds the face until it changes. O(log n). Precondition: the face is live.
  void hide(std::uint32_t face);
  // The face is gone. O(log n) on average. Precondition: the face is live, and not the last.
  void remove(std::uint32_t face);

  // A box for find(): that of a triangle in the tree's coordinates.
  [[nodiscard]] FloatBox box_of(const Triangle& corners) const;

  // The box of a live face, in the same coordinates.
  [[nodiscard]] FloatBox box(std::uint32_t face) const { return tree_.box(place_[face]); }

  // The live faces in the tree's coordinates, and what was hidden or removed nowhere.
  [[nodiscard]] const BoxTree& tree() const { return tree_; }

  // Calls visit(face) for each live face whose box overlaps the given one, in an order that depends
  // on the history of calls alone. O(log n + found) where faces do not crowd.
  template <class Visit>
  void find(const FloatBox& box, const Visit& visit) const {
    tree_.visit_boxes(box, visit);
  }

 private:
  void note_places();

  const std::vector<Point3>& points_;
  FloatFrame frame_;
  std::size_t count_ = 0;
  BoxTree tree_;
  std::unique_ptr<std::uint32_t[]> place_;  // in the tree; kGone for those that are no more
};

}  // namespace cellocut
