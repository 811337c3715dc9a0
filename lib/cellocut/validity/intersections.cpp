#include "cellocut/validity/intersections.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "cellocut/validity/box_tree.h"
#include "cellocut/validity/eight_slabs.h"
#include "cellocut/validity/face_filter.h"
#include "cellocut/validity/float_frame.h"
#include "cellocut/validity/triangle_pair.h"

namespace cellocut {

namespace {

// The plane of a face in frame coordinates: tells boxes that it surely does not cut.
class FacePlane {
 public:
  FacePlane(const Point3& a, const Point3& b, const Point3& c)
      : point_(a), normal_(cross(b - a, c - a)) {
    double edge = 0;
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      edge = std::fmax(edge, std::fmax(std::fabs(b[axis] - a[axis]), std::fabs(c[axis] - a[axis])));
      sum += std::fabs(normal_[axis]);
    }
    // Far above the rounding of the boxes (2^-24) and of the normal (some 2^-52 times the edges): a
    // box that the face itself meets holds a point of it, whose height should be 0.
    slack_ = 1e-5 * sum + 1e-14 * edge;
  }
  [[nodiscard]] bool may_cut(const FloatBox& box) const {
    double distance = 0;
    double radius = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = static_cast<double>(box.low[axis]);
      const double high = static_cast<double>(box.high[axis]);
      distance += normal_[axis] * (0.5 * (low + high) - point_[axis]);
      radius += std::fabs(normal_[axis]) * 0.5 * (high - low);
    }
    return std::fabs(distance) <= radius + slack_;
  }

 private:
  Point3 point_;
  Point3 normal_;
  double slack_ = 0;
};

// The pairs that one thread has found: all counted, the smallest `max_pairs` kept.
class PairList {
 public:
  void add(std::uint32_t f, std::uint32_t g, std::size_t max_pairs) {
    ++count_;
    if (max_pairs == 0) return;
    pairs_.emplace_back(std::min(f, g), std::max(f, g));
    if (pairs_.size() / 2 > max_pairs + 1024) keep_smallest(max_pairs);
  }
  void keep_smallest(std::size_t max_pairs) {
    if (pairs_.size() <= max_pairs) return;
    const auto end = pairs_.begin() + static_cast<std::ptrdiff_t>(max_pairs);
    std::nth_element(pairs_.begin(), end, pairs_.end());
    pairs_.erase(end, pairs_.end());
  }
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] const std::vector<FacePair>& pairs() const { return pairs_; }

 private:
  std::int64_t count_ = 0;
  std::vector<FacePair> pairs_;
};

// Faces in classes by extent, smallest first; the lowest class holds all up to four times the
// median. (Which face is in which class changes the time, never the result.)
template <class BoxOf>
std::vector<std::vector<std::uint32_t>> size_classes(const std::vector<std::uint32_t>& faces,
                                                     const BoxOf& box_of) {
  std::vector<float> sample;
  for (std::size_t i = 0; i < faces.size(); i += faces.size() / 4096 + 1) {
    sample.push_back(box_of(faces[i]).longest_edge());
  }
  const auto middle = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() / 2);
  std::nth_element(sample.begin(), middle, sample.end());
  const double unit = std::fmax(4.0 * static_cast<double>(*middle), 1e-30);
  std::vector<std::uint8_t> index(faces.size());
  tbb::parallel_for(std::size_t{0}, faces.size(), [&](std::size_t i) {
    const double ratio = static_cast<double>(box_of(faces[i]).longest_edge()) / unit;
    index[i] = static_cast<std::uint8_t>(ratio <= 1 ? 0 : std::ilogb(ratio) / 4 + 1);
  });
  std::vector<std::vector<std::uint32_t>> classes(1);
  classes[0].reserve(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (classes.size() <= index[i]) classes.resize(index[i] + 1U);
    classes[index[i]].push_back(faces[i]);
  }
  std::erase_if(classes, [](const auto& members) { return members.empty(); });
  return classes;
}

// A face whose box overlaps those of faces of a leaf, by the bits of their places.
struct Candidate {
  std::uint32_t face;
  std::uint32_t places;
};

class Search {
 public:
  Search(const std::vector<Point3>& points, const std::vector<Triangle>& triangles,
         const Buckets& corners_at, std::vector<std::uint32_t> faces, std::size_t max_pairs,
         Observer& observer)
      : points_(points),
        triangles_(triangles),
        stars_(points, triangles, corners_at),
        faces_(std::move(faces)),
        frame_(bounding_box(points, triangles, faces_)),
        max_pairs_(max_pairs),
        observer_(observer) {}

  IntersectingPairs run() {
    const auto box_of = [this](std::uint32_t face) {
      return float_box(frame_, points_, triangles_[face]);
    };
    const auto classes = size_classes(faces_, box_of);
    observer_.check();
    std::vector<BoxTree> trees;
    for (const auto& members : classes) {
      trees.emplace_back(members, box_of);
      observer_.check();
    }
    for (std::size_t k = 0; k < trees.size(); ++k) {
      search_within(trees[k], classes[k].size());
      for (std::size_t smaller = 0; smaller < k; ++smaller) {
        search_between(classes[k], trees[smaller]);
      }
    }
    return collect();
  }

 private:
  [[nodiscard]] std::array<Point3, 3> frame_corners(std::uint32_t face) const {
    const Triangle& t = triangles_[face];
    return {frame_(points_[t[0]]), frame_(points_[t[1]]), frame_(points_[t[2]])};
  }

  void search_within(const BoxTree& tree, std::size_t members) {
    const double share = static_cast<double>(members) / static_cast<double>(tree.leaf_count());
    visit_intersecting_pairs(
        tree, points_, triangles_, stars_,
        [this](std::uint32_t f, std::uint32_t g) { found_.local().add(f, g, max_pairs_); },
        [this, share](std::size_t leaves) {
          observer_.check();
          report(share * static_cast<double>(leaves));
        });
  }

  void search_between(const std::vector<std::uint32_t>& large, const BoxTree& small) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, large.size(), 1), [&](const auto& range) {
      observer_.check();
      PairList& found = found_.local();
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const std::uint32_t face = large[i];
        const auto [a, b, c] = frame_corners(face);
        const FacePlane plane(a, b, c);
        small.visit_boxes(
            float_box({a, b, c}), [&](const FloatBox& box) { return plane.may_cut(box); },
            [&](std::uint32_t other) {
              if (!faces_intersect(points_, triangles_[face], triangles_[other])) return;
              found.add(face, other, max_pairs_);
            });
      }
    });
  }

  void report(double faces) {
    double done = done_.load(std::memory_order_relaxed);
    while (!done_.compare_exchange_weak(done, done + faces, std::memory_order_relaxed)) {
    }
    observer_.progress(std::min(1.0, (done + faces) / static_cast<double>(faces_.size())));
  }

  IntersectingPairs collect() {
    IntersectingPairs result;
    for (const PairList& found : found_) {
      result.count += found.count();
      result.first.insert(result.first.end(), found.pairs().begin(), found.pairs().end());
    }
    tbb::parallel_sort(result.first.begin(), result.first.end());
    if (result.first.size() > max_pairs_) result.first.resize(max_pairs_);
    return result;
  }

  const std::vector<Point3>& points_;
  const std::vector<Triangle>& triangles_;
  EmbeddedStars stars_;
  std::vector<std::uint32_t> faces_;
  FloatFrame frame_;
  std::size_t max_pairs_;
  Observer& observer_;
  tbb::enumerable_thread_specific<PairList> found_;
  std::atomic<double> done_{0};
};

}  // namespace

IntersectingPairs find_intersecting_pairs(const std::vector<Point3>& points,
                                          const std::vector<Triangle>& triangles,
                                          const Buckets& corners_at,
                                          const std::vector<std::uint8_t>& takes_part,
                                          std::size_t max_pairs, Observer& observer) {
  std::vector<std::uint32_t> faces;
  faces.reserve(triangles.size());
  for (std::uint32_t face = 0; face < triangles.size(); ++face) {
    if (takes_part[face] != 0) faces.push_back(face);
  }
  if (faces.empty()) return {};
  return Search(points, triangles, corners_at, std::move(faces), max_pairs, observer).run();
}

void visit_intersecting_pairs(const BoxTree& tree, const std::vector<Point3>& points,
                              const std::vector<Triangle>& triangles, const EmbeddedStars& stars,
                              const std::function<void(std::uint32_t, std::uint32_t)>& found,
                              const std::function<void(std::size_t)>& done) {
  const tbb::blocked_range<std::size_t> leaves(0, tree.leaf_count(), 64);
  tbb::parallel_for(leaves, [&](const auto& range) {
    std::vector<Candidate> candidates;
    std::array<std::optional<PreparedFace>, EightBoxes::kSize> prepared;
    for (std::size_t leaf = range.begin(); leaf < range.end(); ++leaf) {
      const std::span<const std::uint32_t> faces = tree.ids_of_leaf(leaf);
      const StarsOfFaces settled(stars, triangles, faces);
      const EightSlabs slabs(points, triangles, faces);
      candidates.clear();
      tree.visit_pairs_of_leaf(leaf, [&](unsigned places, std::uint32_t face) {
        candidates.push_back({face, places});
      });
      prepared.fill(std::nullopt);
      for (const Candidate& candidate : candidates) {
        const Triangle& other = triangles[candidate.face];
        unsigned open = candidate.places & ~settled.settled(other);
        if (open == 0) continue;
        open &= ~slabs.certainly_beyond(points[other[0]], points[other[1]], points[other[2]]);
        for (; open != 0; open &= open - 1) {
          const auto place = static_cast<std::size_t>(std::countr_zero(open));
          const Triangle& face = triangles[faces[place]];
          if (!prepared[place]) prepared[place].emplace(points, face);
          if (prepared[place]->certainly_apart(points, other)) continue;
          if (faces_intersect(points, face, other)) found(faces[place], candidate.face);
        }
      }
    }
    done(range.size());
  });
}

}  // namespace cellocut
