// Which faces of a triangle soup intersect?
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/validity/box_tree.h"
#include "cellocut/validity/embedded_stars.h"

namespace cellocut {

using FacePair = std::pair<std::uint32_t, std::uint32_t>;  // the smaller index first

struct IntersectingPairs {
  std::int64_t count = 0;
  std::vector<FacePair> first;  // sorted; the smallest `max_pairs`, or all where there are fewer
};

// All pairs of faces that share more than their common corners and edges (see faces_intersect() in
// triangle_pair.h), among the faces with `takes_part[face]`. Every one of them takes part, and
// every pair whose boxes overlap is decided by exact predicates.
//
// Broad phase: faces are sorted into classes by the extent of their boxes, each class 16 times the
// one before, and each class has a box tree. Pairs within a class come from its tree alone; pairs
// between classes by looking up each larger face in the trees of smaller ones, where it leaves out
// boxes that its plane does not cut. So one large face over a million small ones costs what it
// touches. O(n log n + pairs with overlapping boxes) where the faces of a class do not crowd;
// parallel; the same result for any number of threads.
//
// `corners_at`: as corners_by_point() (incidence.h) gives it.
// Preconditions: the corners of faces that take part are finite, equal coordinates have equal
// indices, and these faces are not degenerate. Errors: Cancelled.
IntersectingPairs find_intersecting_pairs(const std::vector<Point3>& points,
                                          const std::vector<Triangle>& triangles,
                                          const Buckets& corners_at,
                                          const std::vector<std::uint8_t>& takes_part,
                                          std::size_t max_pairs, Observer& observer);

// The same search over the faces of one tree that is already there: calls found(f, g) once for
// each intersecting pair, from any thread and in any order, and done(leaves) when these many more
// leaves have been searched. Both may throw to end the search. Preconditions as above; the box of
// each face of the tree contains it.
void visit_intersecting_pairs(const BoxTree& tree, const std::vector<Point3>& points,
                              const std::vector<Triangle>& triangles, const EmbeddedStars& stars,
                              const std::function<void(std::uint32_t, std::uint32_t)>& found,
                              const std::function<void(std::size_t)>& done);

}  // namespace cellocut
