#include "cellocut/validity/incidence.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <span>

#include "cellocut/base/buckets.h"
#include "cellocut/validity/fan.h"

namespace cellocut {

namespace {

// Disjoint sets that several threads may unite at once (Anderson and Woll, "Wait-free parallel
// algorithms for the union-find problem", 1991, with linking by index). The larger root is always
// hung below the smaller, so in the end each root is the smallest member, whatever the schedule.
class ConcurrentSets {
 public:
  explicit ConcurrentSets(std::size_t size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::uint32_t find(std::uint32_t i) {
    for (;;) {
      std::uint32_t parent = load(i);
      if (parent == i) return i;
      const std::uint32_t grandparent = load(parent);
      if (grandparent != parent) {  // halve the path; a lost race does no harm
        std::atomic_ref(parent_[i])
            .compare_exchange_weak(parent, grandparent, std::memory_order_relaxed);
      }
      i = grandparent;
    }
  }

  void unite(std::uint32_t i, std::uint32_t j) {
    for (;;) {
      i = find(i);
      j = find(j);
      if (i == j) return;
      if (i > j) std::swap(i, j);
      std::uint32_t expected = j;
      if (std::atomic_ref(parent_[j])
              .compare_exchange_strong(expected, i, std::memory_order_relaxed)) {
        return;
      }
    }
  }

 private:
  std::uint32_t load(std::uint32_t i) {
    return std::atomic_ref(parent_[i]).load(std::memory_order_relaxed);
  }
  std::vector<std::uint32_t> parent_;
};

// One end of a link edge at vertex v: the neighbour, the face (by its place among v's faces), and
// whether the face runs from the neighbour to v.
struct LinkEnd {
  std::uint64_t key;

  LinkEnd(std::uint32_t neighbour, std::size_t place, bool incoming)
      : key(std::uint64_t{neighbour} << 32U | place << 1U | (incoming ? 1U : 0U)) {}
  [[nodiscard]] std::uint32_t neighbour() const { return static_cast<std::uint32_t>(key >> 32U); }
  [[nodiscard]] std::uint32_t place() const {
    return static_cast<std::uint32_t>(key & 0xFFFFFFFFU) >> 1U;
  }
  [[nodiscard]] bool incoming() const { return (key & 1U) != 0; }
  bool operator<(const LinkEnd& other) const { return key < other.key; }
};

// What one thread has counted, and its scratch space.
struct Tally {
  IncidenceCounts counts;
  std::int64_t vertices = 0;
  std::int64_t edges = 0;
  std::vector<NonmanifoldEdgeFace> nonmanifold_edges;
  std::vector<LinkEnd> ends;
  std::vector<std::uint32_t> set;    // disjoint sets over the faces of one vertex
  std::vector<std::uint32_t> third;  // third corners of the faces at one edge
};

void sort_ends(std::vector<LinkEnd>& ends) {
  if (ends.size() > 32) {
    std::sort(ends.begin(), ends.end());
    return;
  }
  for (std::size_t i = 1; i < ends.size(); ++i) {  // most vertices have six faces
    const LinkEnd end = ends[i];
    std::size_t j = i;
    for (; j > 0 && end < ends[j - 1]; --j) ends[j] = ends[j - 1];
    ends[j] = end;
  }
}

std::uint32_t local_root(std::vector<std::uint32_t>& set, std::uint32_t i) {
  while (set[i] != i) i = set[i] = set[set[i]];
  return i;
}

class Counter {
 public:
  Counter(const std::vector<Triangle>& triangles, const Buckets& corners, ConcurrentSets& sets)
      : triangles_(triangles), corners_(corners), sets_(sets) {}

  // Counts vertex v and its edges to vertices above it. Returns whether v is non-manifold.
  bool count_vertex(std::uint32_t v, Tally& tally) {
    const std::span<const std::uint32_t> corners = corners_[v];
    if (corners.empty()) return false;
    ++tally.vertices;
    if (count_closed_fan(v, corners, tally)) return false;
    tally.ends.clear();
    tally.set.resize(corners.size());
    std::iota(tally.set.begin(), tally.set.end(), 0U);
    for (std::size_t place = 0; place < corners.size(); ++place) {
      const Triangle& triangle = triangles_[corners[place] / 3];
      const std::uint32_t k = corners[place] % 3;
      tally.ends.emplace_back(triangle[(k + 1) % 3], place, false);
      tally.ends.emplace_back(triangle[(k + 2) % 3], place, true);
    }
    sort_ends(tally.ends);

    bool manifold = true;
    std::size_t fans = corners.size();
    for (std::size_t begin = 0, end = 0; begin < tally.ends.size(); begin = end) {
      while (end < tally.ends.size() &&
             tally.ends[end].neighbour() == tally.ends[begin].neighbour()) {
        ++end;
      }
      const std::span<const LinkEnd> run(tally.ends.data() + begin, end - begin);
      if (run.size() > 2) manifold = false;
      for (const LinkEnd& other : run.subspan(1)) {
        const std::uint32_t i = local_root(tally.set, run.front().place());
        const std::uint32_t j = local_root(tally.set, other.place());
        if (i == j) continue;
        tally.set[std::max(i, j)] = std::min(i, j);
        --fans;
      }
      if (run.front().neighbour() > v) count_edge(v, corners, run, tally);
    }
    manifold = manifold && fans == 1;
    if (!manifold) ++tally.counts.nonmanifold_vertices;
    return !manifold;
  }

 private:
  // What most vertices are: three or more faces that form one closed fan and go around it one way.
  // None of its edges then is a boundary, non-manifold or turned, and no two of its faces are the
  // same. Counts nothing and returns false elsewhere.
  bool count_closed_fan(std::uint32_t v, std::span<const std::uint32_t> corners, Tally& tally) {
    const std::size_t count = corners.size();
    if (count < 3 || count > Fan::kMostFaces) return false;
    const Fan fan(triangles_, corners);
    std::array<std::uint8_t, Fan::kMostFaces> next;
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t matches = 0;
      for (std::size_t j = 0; j < count; ++j) {
        if (fan.from[j] != fan.to[i]) continue;
        next[i] = static_cast<std::uint8_t>(j);
        ++matches;
      }
      if (matches != 1) return false;
    }
    std::size_t length = 1;
    for (std::size_t i = next[0]; i != 0 && length <= count; i = next[i]) ++length;
    if (length != count) return false;
    for (std::size_t i = 0; i < count; ++i) {
      if (fan.to[i] < v) continue;
      ++tally.edges;
      sets_.unite(corners[i] / 3, corners[next[i]] / 3);
    }
    return true;
  }

  void count_edge(std::uint32_t v, std::span<const std::uint32_t> corners,
                  std::span<const LinkEnd> run, Tally& tally) {
    const std::uint32_t neighbour = run.front().neighbour();
    const auto face_of = [&](const LinkEnd& end) { return corners[end.place()] / 3; };
    ++tally.edges;
    if (run.size() == 1) {
      ++tally.counts.boundary_edges;
      return;
    }
    if (run.size() > 2) {
      ++tally.counts.nonmanifold_edges;
      for (const LinkEnd& end : run) {
        tally.nonmanifold_edges.push_back({v, neighbour, face_of(end)});
      }
    } else if (run[0].incoming() == run[1].incoming()) {
      ++tally.counts.misoriented_edges;
    }
    tally.third.clear();
    for (const LinkEnd& end : run) {
      sets_.unite(face_of(run.front()), face_of(end));
      const Triangle& triangle = triangles_[face_of(end)];
      const std::uint32_t highest = std::max({triangle[0], triangle[1], triangle[2]});
      // A face is compared at one of its edges only: the one between its two lower corners.
      if (highest > neighbour) tally.third.push_back(highest);
    }
    if (tally.third.size() < 2) return;
    std::sort(tally.third.begin(), tally.third.end());
    for (std::size_t i = 1; i < tally.third.size(); ++i) {
      if (tally.third[i] == tally.third[i - 1]) ++tally.counts.duplicate_faces;
    }
  }

  const std::vector<Triangle>& triangles_;
  const Buckets& corners_;
  ConcurrentSets& sets_;
};

void add(IncidenceCounts& sum, const IncidenceCounts& part) {
  sum.boundary_edges += part.boundary_edges;
  sum.nonmanifold_edges += part.nonmanifold_edges;
  sum.misoriented_edges += part.misoriented_edges;
  sum.nonmanifold_vertices += part.nonmanifold_vertices;
  sum.duplicate_faces += part.duplicate_faces;
}

}  // namespace

Buckets corners_by_point(const std::vector<Triangle>& triangles, std::size_t points) {
  return Buckets::of_groups(points, triangles.size(), [&](std::size_t f, const auto& put) {
    const Triangle& triangle = triangles[f];
    if (!is_proper(triangle)) return;
    for (std::size_t k = 0; k < 3; ++k) put(triangle[k], 3 * f + k);
  });
}

Incidence count_incidence(const std::vector<Triangle>& triangles, const Buckets& corners_at,
                          const Observer& observer) {
  observer.check();
  const std::size_t points = corners_at.size();
  ConcurrentSets sets(triangles.size());
  Counter counter(triangles, corners_at, sets);
  Incidence result;
  result.nonmanifold_vertex.assign(points, 0);
  tbb::enumerable_thread_specific<Tally> tallies;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points, 1024), [&](const auto& range) {
    observer.check();
    Tally& tally = tallies.local();
    for (std::size_t v = range.begin(); v < range.end(); ++v) {
      if (counter.count_vertex(static_cast<std::uint32_t>(v), tally)) {
        result.nonmanifold_vertex[v] = 1;
      }
    }
  });
  for (const Tally& tally : tallies) {
    add(result.counts, tally.counts);
    result.vertices += tally.vertices;
    result.edges += tally.edges;
    result.nonmanifold_edges.insert(result.nonmanifold_edges.end(), tally.nonmanifold_edges.begin(),
                                    tally.nonmanifold_edges.end());
  }
  tbb::parallel_sort(result.nonmanifold_edges.begin(), result.nonmanifold_edges.end());
  result.proper_faces = std::count_if(triangles.begin(), triangles.end(), is_proper);
  result.component.resize(triangles.size());
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t f) {
    result.component[f] = sets.find(static_cast<std::uint32_t>(f));
  });
  return result;
}

}  // namespace cellocut
