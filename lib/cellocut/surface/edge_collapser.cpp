#include "cellocut/surface/edge_collapser.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace cellocut {

namespace {

// Costs in steps of up to a half, as keys of the queue: among equal keys the vertices take their
// turns by index, so one after the other beside each other in memory. Twice as fast as the exact
// order, and no farther from the surface.
double coarse(double cost) {
  constexpr std::uint64_t kSignExponentAndOneBit = 0xFFF8000000000000U;
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(cost) & kSignExponentAndOneBit);
}

}  // namespace

EdgeCollapser::EdgeCollapser(const TriangleSoup& surface, double bound, Observer& observer)
    : input_(surface),
      observer_(observer),
      mesh_(surface),
      test_(surface.points, mesh_),
      quadrics_(surface),
      heap_(surface.points.size()) {
  if (bound > 0) distance_.emplace(surface, mesh_, bound);
}

// The vertex waits with the cost of its cheapest collapse.
void EdgeCollapser::queue(std::uint32_t v) {
  double least = std::numeric_limits<double>::infinity();
  mesh_.visit_ring(v, [&](std::uint32_t to, OpenMesh::HalfedgeHandle) {
    least = std::min(least, quadrics_.cost(v, to));
  });
  heap_.set(v, coarse(least));
}

void EdgeCollapser::queue_all() {
  for (std::uint32_t v = 0; v < input_.points.size(); ++v) {
    if (mesh_.has_vertex(v)) queue(v);
  }
}

void EdgeCollapser::run(std::int64_t target) {
  const std::int64_t before = mesh_.face_count();
  std::int64_t turns = 0;
  std::int64_t collapses_of_round = 1;
  while (mesh_.face_count() > target) {
    if (heap_.empty()) {
      if (collapses_of_round == 0) return;
      collapses_of_round = 0;
      queue_all();
    }
    const auto [v, key] = heap_.pop();
    if (take_turn(v, key)) ++collapses_of_round;
    if (++turns % 1024 == 0) {
      observer_.check();
      observer_.progress(static_cast<double>(before - mesh_.face_count()) /
                         static_cast<double>(before - target));
    }
  }
}

// Whether the vertex has been collapsed. `key` is the cost at which it waited: its cheaper
// collapses have been refused since the last change beside it.
bool EdgeCollapser::take_turn(std::uint32_t v, double key) {
  candidates_.clear();
  mesh_.visit_ring(v, [&](std::uint32_t to, OpenMesh::HalfedgeHandle halfedge) {
    const double cost = quadrics_.cost(v, to);
    if (coarse(cost) >= key) candidates_.push_back({cost, to, halfedge});
  });
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return a.cost < b.cost || (a.cost == b.cost && a.to < b.to);
  });
  for (const Candidate& candidate : candidates_) {
    const double waiting = coarse(candidate.cost);
    if (!heap_.empty() && waiting > heap_.least_key() && waiting > key) {
      heap_.set(v, waiting);  // another one's turn comes first
      return false;
    }
    if (try_collapse(candidate)) return true;
  }
  return false;
}

bool EdgeCollapser::try_collapse(const Candidate& candidate) {
  if (!mesh_.keeps_topology(candidate.halfedge)) {
    ++counts_.refused_topology;
    return false;
  }
  mesh_.describe(candidate.halfedge, collapse_);
  if (!is_allowed()) return false;
  mesh_.apply(collapse_);
  test_.applied(collapse_);
  if (distance_) distance_->applied(collapse_);
  quadrics_.merge(collapse_.from, collapse_.to);
  ++counts_.collapses;
  const std::uint32_t to = collapse_.to;
  queue(to);
  mesh_.visit_ring(to, [this](std::uint32_t w, OpenMesh::HalfedgeHandle) { queue(w); });
  return true;
}

// What refuses most is asked first, what takes longest last.
bool EdgeCollapser::is_allowed() {
  if (distance_ && !distance_->keeps_removed_points(collapse_)) {
    ++counts_.refused_distance;
    return false;
  }
  switch (test_.judge(collapse_)) {
    case CollapseVerdict::folds:
      ++counts_.refused_folding;
      return false;
    case CollapseVerdict::sliver:
      ++counts_.refused_slivers;
      return false;
    case CollapseVerdict::degenerate:
      ++counts_.refused_degenerate;
      return false;
    case CollapseVerdict::intersecting:
      ++counts_.refused_intersecting;
      return false;
    case CollapseVerdict::allowed:
      break;
  }
  if (distance_ && !distance_->keeps_faces(collapse_)) {
    ++counts_.refused_distance;
    return false;
  }
  return true;
}

TriangleSoup EdgeCollapser::surface(std::vector<std::uint32_t>& source) const {
  TriangleSoup left;
  std::vector<std::uint32_t> number(input_.points.size());
  source.clear();
  for (std::uint32_t v = 0; v < input_.points.size(); ++v) {
    if (!mesh_.has_vertex(v)) continue;
    number[v] = static_cast<std::uint32_t>(source.size());
    source.push_back(v);
    left.points.push_back(input_.points[v]);
  }
  left.triangles.reserve(static_cast<std::size_t>(mesh_.face_count()));
  for (std::uint32_t f = 0; f < mesh_.faces().size(); ++f) {
    if (!mesh_.has_face(f)) continue;
    const Triangle& t = mesh_.faces()[f];
    left.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  return left;
}

}  // namespace cellocut
