#include "cellocut/surface/retreat.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "cellocut/validity/box_tree.h"
#include "cellocut/validity/buckets.h"
#include "cellocut/validity/face_filter.h"
#include "cellocut/validity/float_frame.h"
#include "cellocut/validity/intersections.h"
#include "cellocut/validity/triangle_pair.h"

namespace cellocut {

namespace {

using Indices = std::vector<std::uint32_t>;

void sort_unique(Indices& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

class Movement {
 public:
  Movement(const std::vector<Point3>& from, const std::vector<Point3>& to,
           const std::vector<Triangle>& triangles, Observer& observer)
      : from_(from), to_(to), triangles_(triangles), observer_(observer) {
    result_.points = to;
    result_.halvings.assign(to.size(), 0);
  }

  Retreat run() {
    const Indices moved = moved_faces();
    if (moved.empty()) return std::move(result_);
    // Where most of the mesh moves, one search for all pairs is the quicker way.
    const bool most = moved.size() > triangles_.size() / 4;
    Indices bad = most ? test_all() : Indices{};
    if (most && bad.empty()) return std::move(result_);
    const Buckets corners_at(from_.size(), 3 * triangles_.size(),
                             [this](std::size_t i) { return triangles_[i / 3][i % 3]; });
    const FloatFrame frame(box_of_ways());
    const BoxTree ways = tree_of_ways(frame);
    if (!most) bad = test_again(moved, ways, frame);
    result_.bad_faces_at_first = static_cast<std::int64_t>(bad.size());
    while (!bad.empty()) {
      observer_.check();
      ++result_.rounds;
      bad = test_again(step_back(bad, corners_at), ways, frame);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool degenerate(std::uint32_t face) const {
    const Triangle& t = triangles_[face];
    return is_degenerate(result_.points[t[0]], result_.points[t[1]], result_.points[t[2]]);
  }

  [[nodiscard]] Indices moved_faces() const {
    Indices faces;
    for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
      const auto moves = [this](std::uint32_t v) { return from_[v] != to_[v]; };
      if (std::any_of(triangles_[f].begin(), triangles_[f].end(), moves)) faces.push_back(f);
    }
    return faces;
  }

  // Faces that are degenerate or in an intersecting pair.
  Indices test_all() {
    std::vector<std::uint8_t> takes_part(triangles_.size());
    tbb::parallel_for(std::size_t{0}, triangles_.size(), [&](std::size_t f) {
      takes_part[f] = degenerate(static_cast<std::uint32_t>(f)) ? 0 : 1;
    });
    const IntersectingPairs pairs =
        find_intersecting_pairs(result_.points, triangles_, takes_part,
                                std::numeric_limits<std::int32_t>::max(), observer_);
    Indices bad;
    for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
      if (takes_part[f] == 0) bad.push_back(f);
    }
    for (const auto& [f, g] : pairs.first) {
      bad.push_back(f);
      bad.push_back(g);
    }
    sort_unique(bad);
    return bad;
  }

  [[nodiscard]] Box3 box_of_ways() const {
    Box3 box{from_.front(), from_.front()};
    for (const std::vector<Point3>* points : {&from_, &to_}) {
      for (const Point3& p : *points) box.include(p);
    }
    return box;
  }

  // Boxes around all places where a face can be on the way.
  [[nodiscard]] BoxTree tree_of_ways(const FloatFrame& frame) const {
    std::vector<FloatBox> boxes(triangles_.size());
    tbb::parallel_for(std::size_t{0}, triangles_.size(), [&](std::size_t f) {
      const auto& [a, b, c] = triangles_[f];
      boxes[f] = float_box({frame(from_[a]), frame(from_[b]), frame(from_[c]), frame(to_[a]),
                            frame(to_[b]), frame(to_[c])});
    });
    Indices all(triangles_.size());
    std::iota(all.begin(), all.end(), 0U);
    return BoxTree(all, boxes);
  }

  // Moves the vertices of the bad faces back; returns the faces that this changes. `corners_at`: by
  // vertex, 3 f + k for each corner k of a face f that it is.
  Indices step_back(const Indices& bad, const Buckets& corners_at) {
    Indices vertices;
    for (const std::uint32_t f : bad) {
      vertices.insert(vertices.end(), triangles_[f].begin(), triangles_[f].end());
    }
    sort_unique(vertices);
    Indices changed;
    Indices stuck;
    for (const std::uint32_t v : vertices) {
      if (result_.halvings[v] == Retreat::kStayed) continue;
      if (result_.halvings[v] == Retreat::kMostHalvings) {
        stuck.push_back(v);
      } else {
        ++result_.halvings[v];
        result_.points[v] = from_[v] + std::ldexp(1.0, -result_.halvings[v]) * (to_[v] - from_[v]);
        changed.push_back(v);
      }
    }
    for (const std::uint32_t v : stuck) {
      for (const std::uint32_t corner : corners_at[v]) {
        for (const std::uint32_t neighbour : triangles_[corner / 3]) {
          if (result_.halvings[neighbour] == Retreat::kStayed) continue;
          result_.halvings[neighbour] = Retreat::kStayed;
          result_.points[neighbour] = from_[neighbour];
          changed.push_back(neighbour);
        }
      }
    }
    Indices faces;
    for (const std::uint32_t v : changed) {
      for (const std::uint32_t corner : corners_at[v]) faces.push_back(corner / 3);
    }
    sort_unique(faces);
    return faces;
  }

  // Those of the faces, and what they intersect, that are bad now. (Pairs of faces that did not
  // change were not bad before: all vertices of a bad pair step back, unless they have nowhere to
  // go.)
  Indices test_again(const Indices& faces, const BoxTree& ways, const FloatFrame& frame) {
    tbb::enumerable_thread_specific<Indices> found;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 64), [&](const auto& range) {
      Indices& bad = found.local();
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const std::uint32_t face = faces[i];
        if (degenerate(face)) {
          bad.push_back(face);
          continue;
        }
        const auto& [a, b, c] = triangles_[face];
        const FloatBox box = float_box(
            {frame(result_.points[a]), frame(result_.points[b]), frame(result_.points[c])});
        const PreparedFace prepared(result_.points, triangles_[face]);
        ways.visit_boxes([&](const FloatBox& other) { return overlap(other, box); },
                         [&](std::uint32_t other) {
                           if (other == face || degenerate(other)) return;
                           const Triangle& t = triangles_[other];
                           if (prepared.certainly_apart(result_.points, t)) return;
                           if (!faces_intersect(result_.points, triangles_[face], t)) return;
                           bad.push_back(face);
                           bad.push_back(other);
                         });
      }
    });
    Indices bad;
    for (const Indices& part : found) bad.insert(bad.end(), part.begin(), part.end());
    sort_unique(bad);
    return bad;
  }

  const std::vector<Point3>& from_;
  const std::vector<Point3>& to_;
  const std::vector<Triangle>& triangles_;
  Observer& observer_;
  Retreat result_;
};

}  // namespace

Retreat move_vertices(const std::vector<Point3>& from, const std::vector<Point3>& to,
                      const std::vector<Triangle>& triangles, Observer& observer) {
  if (triangles.empty()) return {.points = to, .halvings = std::vector<std::uint8_t>(to.size(), 0)};
  return Movement(from, to, triangles, observer).run();
}

}  // namespace cellocut
