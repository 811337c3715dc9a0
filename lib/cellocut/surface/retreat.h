// Moves the vertices of a valid surface as far as it stays valid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cellocut/base/buckets.h"
#include "cellocut/base/coordinates.h"
#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

struct Retreat {
  // Six halvings are tried; kStayed: the vertex is where it was, for good.
  static constexpr std::uint8_t kMostHalvings = 6;
  static constexpr std::uint8_t kStayed = 7;

  std::vector<Point3> points;
  std::vector<std::uint8_t> halvings;  // per vertex: the displacement is 2^-halvings of that asked
  std::vector<std::uint8_t> fell_short;  // per vertex: 1 where it could not be `beyond`
  // Whether vertex v is `beyond` the place `to` that it was to reach at least.
  [[nodiscard]] bool is_beyond(std::size_t v, const Point3& to) const {
    return fell_short[v] == 0 && halvings[v] == 0 && points[v] != to;
  }

  // Faces that are degenerate or intersect another with all displacements in full.
  std::int64_t bad_faces_at_first = 0;
  int rounds = 0;
};

// Vertex v is moved from `from[v]` to `to[v]`. While exact intersecting or degenerate faces exist,
// the displacement of their vertices is halved; after six halvings they and their neighbours are
// put back for good. The mesh at `from` is valid (no intersecting pair, no degenerate face), every
// round halves something or puts it back, and what is put back stays: so this ends, and with a
// valid mesh. Faces none of whose vertices move are only tested against those that do, so where
// little moves, little is tested.
//
// `corners_at`: as corners_by_point() (incidence.h) gives it.
// `beyond`: a vertex is first tried there; where that does not do it goes back to `to`, and from
// then on as above. Pass `to` where there is no such place.
//
// `coordinates`: where a file will keep floats, points stop at floats alone, so that the surface is
// valid as it reads back.
//
// Preconditions: the mesh is valid at `from`; all three are `kept` coordinates already, and have
// the same size, all finite. The same for any number of threads. O(n log n + rounds * faces that
// were bad). Errors: Cancelled.
Retreat move_vertices(std::span<const Point3> from, std::span<const Point3> to,
                      std::vector<Point3> beyond, const std::vector<Triangle>& triangles,
                      const Buckets& corners_at, Observer& observer,
                      Coordinates coordinates = Coordinates::doubles);

}  // namespace cellocut
