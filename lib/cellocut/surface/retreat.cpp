#include "cellocut/surface/retreat.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cellocut/surface/live_faces.h"
#include "cellocut/validity/face_filter.h"
#include "cellocut/validity/intersections.h"
#include "cellocut/validity/triangle_pair.h"

namespace cellocut {

namespace {

using Indices = std::vector<std::uint32_t>;

using Pairs = std::vector<FacePair>;

template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

template <class T>
void join(std::vector<T>& values, const std::vector<T>& more) {
  values.insert(values.end(), more.begin(), more.end());
  sort_unique(values);
}

class Movement {
 public:
  Movement(std::span<const Point3> from, std::span<const Point3> to, std::vector<Point3> beyond,
           const std::vector<Triangle>& triangles, const Buckets& corners_at, Observer& observer,
           Coordinates coordinates)
      : from_(from),
        to_(to),
        triangles_(triangles),
        corners_at_(corners_at),
        observer_(observer),
        coordinates_(coordinates) {
    result_.points = std::move(beyond);
    result_.halvings.assign(from.size(), 0);
    result_.fell_short.assign(from.size(), 0);
  }

  Retreat run() {
    const std::vector<std::uint8_t> moves = which_faces_move();
    const auto moving = static_cast<std::size_t>(std::count(moves.begin(), moves.end(), 1));
    if (moving == 0) return std::move(result_);
    LiveFaces live(result_.points, triangles_);
    observer_.check();
    Pairs bad;
    if (moving > triangles_.size() / 4) {  // one search for all pairs is the quicker way
      bad = hide_degenerate(live.tree().ids(), live);
      join(bad, intersecting(live));
    } else {
      Indices moved;
      for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
        if (moves[f] != 0) moved.push_back(f);
      }
      bad = hide_degenerate(moved, live);
      join(bad, intersecting_among(moved, live));
    }
    if (bad.empty()) return std::move(result_);
    result_.bad_faces_at_first = count_faces(bad);

    while (!bad.empty()) {
      observer_.check();
      ++result_.rounds;
      const Indices changed = faces_at(step_back(bad));
      for (const std::uint32_t face : changed) live.change(face, triangles_[face]);
      bad = hide_degenerate(changed, live);
      // (Pairs of faces that did not change were not bad before: some vertex of every bad pair
      // steps back, unless they have nowhere to go.)
      join(bad, intersecting_among(changed, live));
    }
    return std::move(result_);
  }

 private:
  // By face, 1 or 0.
  [[nodiscard]] std::vector<std::uint8_t> which_faces_move() const {
    std::vector<std::uint8_t> moved(from_.size());
    tbb::parallel_for(std::size_t{0}, from_.size(),
                      [&](std::size_t v) { moved[v] = from_[v] != result_.points[v] ? 1 : 0; });
    std::vector<std::uint8_t> moves(triangles_.size());
    tbb::parallel_for(std::size_t{0}, triangles_.size(), [&](std::size_t f) {
      const Triangle& t = triangles_[f];
      moves[f] = moved[t[0]] | moved[t[1]] | moved[t[2]];
    });
    return moves;
  }

  [[nodiscard]] bool degenerate(std::uint32_t face) const {
    const Triangle& t = triangles_[face];
    return is_degenerate(result_.points[t[0]], result_.points[t[1]], result_.points[t[2]]);
  }

  // The degenerate ones of the faces, each paired with itself; the search finds them no more.
  [[nodiscard]] Pairs hide_degenerate(std::span<const std::uint32_t> faces, LiveFaces& live) const {
    std::vector<std::uint8_t> is(faces.size());
    tbb::parallel_for(std::size_t{0}, faces.size(),
                      [&](std::size_t i) { is[i] = degenerate(faces[i]) ? 1 : 0; });
    Pairs found;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (is[i] == 0) continue;
      found.emplace_back(faces[i], faces[i]);
      live.hide(faces[i]);
    }
    return found;
  }

  // All pairs of faces that intersect; those hidden take no part, here and below.
  [[nodiscard]] Pairs intersecting(const LiveFaces& live) const {
    const EmbeddedStars stars(result_.points, triangles_, corners_at_);
    tbb::enumerable_thread_specific<Pairs> found;
    visit_intersecting_pairs(
        live.tree(), result_.points, triangles_, stars,
        [&found](std::uint32_t f, std::uint32_t g) { found.local().push_back(std::minmax(f, g)); },
        [this](std::size_t) { observer_.check(); });
    return united(found);
  }

  // Those with one of the given faces.
  [[nodiscard]] Pairs intersecting_among(const Indices& faces, const LiveFaces& live) const {
    std::vector<std::uint8_t> given(triangles_.size(), 0);
    for (const std::uint32_t face : faces) given[face] = 1;
    tbb::enumerable_thread_specific<Pairs> found;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 64), [&](const auto& range) {
      Pairs& bad = found.local();
      for (std::size_t i = range.begin(); i < range.end(); ++i) {
        const std::uint32_t face = faces[i];
        const PreparedFace prepared(result_.points, triangles_[face]);
        live.find(live.box(face), [&](std::uint32_t other) {
          const Triangle& t = triangles_[other];
          if (other == face || (given[other] != 0 && other < face)) return;  // found from there
          if (prepared.certainly_apart(result_.points, t)) return;
          if (!faces_intersect(result_.points, triangles_[face], t)) return;
          bad.push_back(std::minmax(face, other));
        });
      }
    });
    return united(found);
  }

  static Pairs united(const tbb::enumerable_thread_specific<Pairs>& parts) {
    Pairs all;
    for (const Pairs& part : parts) join(all, part);
    return all;
  }

  static std::int64_t count_faces(const Pairs& pairs) {
    Indices faces;
    for (const auto& [f, g] : pairs) {
      faces.push_back(f);
      faces.push_back(g);
    }
    sort_unique(faces);
    return static_cast<std::int64_t>(faces.size());
  }

  [[nodiscard]] bool is_beyond(std::uint32_t v) const { return result_.is_beyond(v, to_[v]); }

  // Those vertices of a bad pair that are beyond come back to where they were to go at least; where
  // there are none, the way of all is halved. Returns the vertices that this moves.
  Indices step_back(const Pairs& bad) {
    Indices too_far;
    Indices in_the_way;
    for (const auto& [f, g] : bad) {
      const std::size_t before = too_far.size();
      for (const std::uint32_t face : {f, g}) {
        for (const std::uint32_t v : triangles_[face]) {
          if (is_beyond(v)) too_far.push_back(v);
        }
      }
      if (too_far.size() > before) continue;
      for (const std::uint32_t face : {f, g}) {
        in_the_way.insert(in_the_way.end(), triangles_[face].begin(), triangles_[face].end());
      }
    }
    sort_unique(too_far);
    sort_unique(in_the_way);
    Indices changed = too_far;
    for (const std::uint32_t v : too_far) {
      result_.fell_short[v] = 1;
      result_.points[v] = to_[v];
    }
    Indices stuck;
    for (const std::uint32_t v : in_the_way) {
      if (result_.halvings[v] == Retreat::kStayed) continue;
      if (result_.halvings[v] == Retreat::kMostHalvings) {
        stuck.push_back(v);
      } else {
        ++result_.halvings[v];
        const Point3 part = std::ldexp(1.0, -result_.halvings[v]) * (to_[v] - from_[v]);
        result_.points[v] = kept(from_[v] + part, coordinates_);
        changed.push_back(v);
      }
    }
    for (const std::uint32_t v : stuck) {
      for (const std::uint32_t corner : corners_at_[v]) {
        for (const std::uint32_t neighbour : triangles_[corner / 3]) {
          if (result_.halvings[neighbour] == Retreat::kStayed) continue;
          if (is_beyond(neighbour)) result_.fell_short[neighbour] = 1;
          result_.halvings[neighbour] = Retreat::kStayed;
          result_.points[neighbour] = from_[neighbour];
          changed.push_back(neighbour);
        }
      }
    }
    return changed;
  }

  [[nodiscard]] Indices faces_at(const Indices& vertices) const {
    Indices faces;
    for (const std::uint32_t v : vertices) {
      for (const std::uint32_t corner : corners_at_[v]) faces.push_back(corner / 3);
    }
    sort_unique(faces);
    return faces;
  }

  std::span<const Point3> from_;
  std::span<const Point3> to_;
  const std::vector<Triangle>& triangles_;
  const Buckets& corners_at_;
  Observer& observer_;
  Coordinates coordinates_;
  Retreat result_;
};

}  // namespace

Retreat move_vertices(std::span<const Point3> from, std::span<const Point3> to,
                      std::vector<Point3> beyond, const std::vector<Triangle>& triangles,
                      const Buckets& corners_at, Observer& observer, Coordinates coordinates) {
  return Movement(from, to, std::move(beyond), triangles, corners_at, observer, coordinates).run();
}

}  // namespace cellocut
