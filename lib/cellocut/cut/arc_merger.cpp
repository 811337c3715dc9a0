#include "cellocut/cut/arc_merger.h"

#include <algorithm>
#include <limits>

namespace cellocut::cut_io {

namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint32_t lower(const Arc& arc) { return std::min(arc.from, arc.to); }
std::uint32_t upper(const Arc& arc) { return std::max(arc.from, arc.to); }

// The arcs sorted by their lower end, those of one lower end in their order.
std::vector<std::uint32_t> by_lower_end(const std::vector<Arc>& arcs, std::size_t nodes) {
  std::vector<std::uint32_t> next(nodes + 1, 0);
  for (const Arc& arc : arcs) ++next[lower(arc) + std::size_t{1}];
  for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  std::vector<std::uint32_t> order(arcs.size());
  for (std::uint32_t a = 0; a < arcs.size(); ++a) order[next[lower(arcs[a])]++] = a;
  return order;
}

// Per arc, the first arc that joins the same two nodes.
std::vector<std::uint32_t> first_of_pair(const std::vector<Arc>& arcs, std::size_t nodes) {
  std::vector<std::uint32_t> first(arcs.size());
  // Per upper end, the first arc of the lower end that is being looked at. What an earlier lower
  // end left behind is told by that arc's own lower end, so nothing has to be cleared.
  std::vector<std::uint32_t> found(nodes, kNone);
  for (const std::uint32_t a : by_lower_end(arcs, nodes)) {
    std::uint32_t& at_end = found[upper(arcs[a])];
    if (at_end == kNone || lower(arcs[at_end]) != lower(arcs[a])) at_end = a;
    first[a] = at_end;
  }
  return first;
}

}  // namespace

std::vector<CutEdge> merge_arcs(const std::vector<Arc>& arcs, std::size_t nodes) {
  std::vector<std::uint32_t> slot = first_of_pair(arcs, nodes);
  std::vector<CutEdge> edges;
  for (std::uint32_t a = 0; a < arcs.size(); ++a) {
    const Arc& arc = arcs[a];
    if (slot[a] == a) {
      // From here on `slot` of this arc is its edge; all others of the pair come later.
      slot[a] = static_cast<std::uint32_t>(edges.size());
      edges.push_back({arc.from, arc.to, arc.capacity, 0});
      continue;
    }
    CutEdge& edge = edges[slot[slot[a]]];
    (edge.from == arc.from ? edge.capacity : edge.reverse_capacity) += arc.capacity;
  }
  return edges;
}

}  // namespace cellocut::cut_io
