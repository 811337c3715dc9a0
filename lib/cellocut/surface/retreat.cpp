#include "cellocut/surface/retreat.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cellocut/surface/live_faces.h"
#include "cellocut/validity/buckets.h"
#include "cellocut/validity/face_filter.h"
#include "cellocut/validity/intersections.h"
#include "cellocut/validity/triangle_pair.h"

namespace cellocut {

namespace {

using Indices = std::vector<std::uint32_t>;

void sort_unique(Indices& indices) {
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

void join(Indices& indices, const Indices& more) {
  indices.insert(indices.end(), more.begin(), more.end());
  sort_unique(indices);
}

class Movement {
 public:
  Movement(const std::vector<Point3>& from, const std::vector<Point3>& to,
           const std::vector<Point3>& beyond, const std::vector<Triangle>& triangles,
           Observer& observer)
      : from_(from), to_(to), beyond_(beyond), triangles_(triangles), observer_(observer) {
    result_.points = beyond;
    result_.halvings.assign(from.size(), 0);
    result_.fell_short.assign(from.size(), 0);
  }

  Retreat run() {
    const Indices moved = moved_faces();
    if (moved.empty()) return std::move(result_);
    LiveFaces live(result_.points, triangles_);
    observer_.check();
    Indices bad = degenerate_among(moved);
    for (const std::uint32_t face : bad) live.hide(face);
    // Where most of the mesh moves, one search for all pairs is the quicker way.
    const bool most = moved.size() > triangles_.size() / 4;
    join(bad, most ? intersecting(live) : intersecting_among(moved, live));
    result_.bad_faces_at_first = static_cast<std::int64_t>(bad.size());
    if (bad.empty()) return std::move(result_);

    const Buckets corners_at(from_.size(), 3 * triangles_.size(),
                             [this](std::size_t i) { return triangles_[i / 3][i % 3]; });
    while (!bad.empty()) {
      observer_.check();
      ++result_.rounds;
      // What went beyond comes back first: the others wait, to be tested again.
      Indices changed = faces_at(come_short(bad), corners_at);
      if (changed.empty()) {
        changed = faces_at(step_back(bad, corners_at), corners_at);
        bad.clear();
      }
      for (const std::uint32_t face : changed) live.change(face, triangles_[face]);
      join(changed, bad);
      bad = degenerate_among(changed);
      for (const std::uint32_t face : bad) live.hide(face);
      // (Pairs of faces that did not change were not bad before: all vertices of a bad pair step
      // back, unless they have nowhere to go.)
      join(bad, intersecting_among(changed, live));
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] Indices moved_faces() const {
    Indices faces;
    for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
      const auto moves = [this](std::uint32_t v) { return from_[v] != beyond_[v]; };
      if (std::any_of(triangles_[f].begin(), triangles_[f].end(), moves)) faces.push_back(f);
    }
    return faces;
  }

  [[nodiscard]] bool degenerate(std::uint32_t face) const {
    const Triangle& t = triangles_[face];
    return is_degenerate(result_.points[t[0]], result_.points[t[1]], result_.points[t[2]]);
  }

  [[nodiscard]] Indices degenerate_among(const Indices& faces) const {
    std::vector<std::uint8_t> is(faces.size());
    tbb::parallel_for(std::size_t{0}, faces.size(),
                      [&](std::size_t i) { is[i] = degenerate(faces[i]) ? 1 : 0; });
    Indices found;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (is[i] != 0) found.push_back(faces[i]);
    }
    return found;
  }

  // All faces that intersect another; those hidden take no part, here and below.
  [[nodiscard]] Indices intersecting(const LiveFaces& live) const {
    tbb::enumerable_thread_specific<Indices> found;
    visit_intersecting_pairs(
        live.tree(), result_.points, triangles_,
        [&found](std::uint32_t f, std::uint32_t g) {
          Indices& faces = found.local();
          faces.push_back(f);
          faces.push_back(g);
        },
        [this](std::size_t) { observer_.check(); });
    return united(found);
  }

  // Those of the given faces that intersect another, and what they intersect.
  [[nodiscard]] Indices intersecting_among(const Indices& faces, const LiveFaces& live) const {
    tbb::enumerable_thread_specific<Indices> found;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 64), [&](const auto& range) {
      Indices& bad = found.local();
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const std::uint32_t face = faces[i];
        const PreparedFace prepared(result_.points, triangles_[face]);
        live.find(live.box(face), [&](std::uint32_t other) {
          const Triangle& t = triangles_[other];
          if (other == face || prepared.certainly_apart(result_.points, t)) return;
          if (!faces_intersect(result_.points, triangles_[face], t)) return;
          bad.push_back(face);
          bad.push_back(other);
        });
      }
    });
    return united(found);
  }

  static Indices united(const tbb::enumerable_thread_specific<Indices>& parts) {
    Indices all;
    for (const Indices& part : parts) join(all, part);
    return all;
  }

  // Takes those vertices of the bad faces that are beyond back to where they were to go at least;
  // returns them.
  Indices come_short(const Indices& bad) {
    Indices changed;
    for (const std::uint32_t face : bad) {
      for (const std::uint32_t v : triangles_[face]) {
        if (beyond_[v] == to_[v] || result_.fell_short[v] != 0) continue;
        result_.fell_short[v] = 1;
        result_.points[v] = to_[v];
        changed.push_back(v);
      }
    }
    return changed;
  }

  // Halves the way of the vertices of the bad faces, of which none is beyond; returns the vertices
  // that this moves. `corners_at`: by vertex, 3 f + k for each corner k of a face f that it is.
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
          if (beyond_[neighbour] != to_[neighbour]) result_.fell_short[neighbour] = 1;
          result_.points[neighbour] = from_[neighbour];
          changed.push_back(neighbour);
        }
      }
    }
    return changed;
  }

  static Indices faces_at(const Indices& vertices, const Buckets& corners_at) {
    Indices faces;
    for (const std::uint32_t v : vertices) {
      for (const std::uint32_t corner : corners_at[v]) faces.push_back(corner / 3);
    }
    sort_unique(faces);
    return faces;
  }

  const std::vector<Point3>& from_;
  const std::vector<Point3>& to_;
  const std::vector<Point3>& beyond_;
  const std::vector<Triangle>& triangles_;
  Observer& observer_;
  Retreat result_;
};

}  // namespace

Retreat move_vertices(const std::vector<Point3>& from, const std::vector<Point3>& to,
                      const std::vector<Point3>& beyond, const std::vector<Triangle>& triangles,
                      Observer& observer) {
  return Movement(from, to, beyond, triangles, observer).run();
}

}  // namespace cellocut
