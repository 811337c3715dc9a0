#include "viz/plane_section.h"

#include <algorithm>
#include <cstddef>

namespace cellocut::viz {

namespace {

// Signed distances (times the length of the normal) of all points.
std::vector<double> heights(const std::vector<Point3>& points, const Plane& plane) {
  std::vector<double> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    result[i] = dot(plane.normal, points[i]) - plane.offset;
  }
  return result;
}

bool above(double height) { return height >= 0; }

// A mesh edge as one number.
std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

// Numbers cut edges: collects keys, then gives each distinct one an index in ascending order.
class NodeNumbers {
 public:
  explicit NodeNumbers(std::vector<std::uint64_t> keys) : keys_(std::move(keys)) {
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
  }
  [[nodiscard]] std::uint32_t index(std::uint64_t key) const {
    return static_cast<std::uint32_t>(std::lower_bound(keys_.begin(), keys_.end(), key) -
                                      keys_.begin());
  }
  // Where the edges meet the plane, always computed from the lower vertex index, so that the
  // elements around an edge agree on the bits.
  [[nodiscard]] std::vector<Point2> positions(const std::vector<Point3>& points,
                                              const std::vector<double>& height,
                                              const PlaneFrame& frame) const {
    std::vector<Point2> result;
    result.reserve(keys_.size());
    for (const std::uint64_t key : keys_) {
      const auto a = static_cast<std::uint32_t>(key >> 32);
      const auto b = static_cast<std::uint32_t>(key);
      const double t = height[a] / (height[a] - height[b]);
      const Point3 p = points[a] + t * (points[b] - points[a]);
      result.push_back({dot(frame.right, p), dot(frame.up, p)});
    }
    return result;
  }

 private:
  std::vector<std::uint64_t> keys_;
};

constexpr std::uint64_t kNoKey = ~std::uint64_t{0};
using PolygonKeys = std::array<std::uint64_t, 4>;

// The cut edges of a tetrahedron in order around the section: a triangle around the corner that is
// alone, or a quadrilateral whose neighbours share a corner.
PolygonKeys cut_edges(const std::array<std::uint32_t, 4>& cell, const std::array<int, 4>& high,
                      int high_count) {
  std::array<std::uint32_t, 4> order{};  // the higher corners first
  int next = 0;
  for (const int wanted : {1, 0}) {
    for (int k = 0; k < 4; ++k) {
      if (high[k] == wanted) order[next++] = cell[k];
    }
  }
  if (high_count == 2) {
    return {edge_key(order[0], order[2]), edge_key(order[0], order[3]),
            edge_key(order[1], order[3]), edge_key(order[1], order[2])};
  }
  const int alone = high_count == 1 ? 0 : 3;
  const int first = high_count == 1 ? 1 : 0;
  return {edge_key(order[alone], order[first]), edge_key(order[alone], order[first + 1]),
          edge_key(order[alone], order[first + 2]), kNoKey};
}

Segment undirected(const Segment& segment) {
  return {std::min(segment[0], segment[1]), std::max(segment[0], segment[1])};
}

void sort_undirected(std::vector<Segment>& segments) {
  for (Segment& segment : segments) segment = undirected(segment);
  std::sort(segments.begin(), segments.end());
}

}  // namespace

CellSection section_of_cells(const std::vector<Point3>& points,
                             const std::vector<std::array<std::uint32_t, 4>>& cells,
                             const Plane& plane) {
  const std::vector<double> height = heights(points, plane);
  CellSection section;
  std::vector<PolygonKeys> polygons;
  std::vector<std::uint64_t> keys;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::array<int, 4> high{};
    for (int k = 0; k < 4; ++k) high[k] = above(height[cells[c][k]]) ? 1 : 0;
    const int high_count = high[0] + high[1] + high[2] + high[3];
    if (high_count == 0 || high_count == 4) continue;
    polygons.push_back(cut_edges(cells[c], high, high_count));
    section.cells.push_back(static_cast<std::uint32_t>(c));
    for (const std::uint64_t key : polygons.back()) {
      if (key != kNoKey) keys.push_back(key);
    }
  }
  const NodeNumbers numbers(std::move(keys));
  section.nodes = numbers.positions(points, height, plane_frame(plane));
  section.polygons.reserve(polygons.size());
  for (const PolygonKeys& polygon : polygons) {
    std::array<std::uint32_t, 4> nodes{};
    for (int k = 0; k < 4; ++k) {
      nodes[k] = polygon[k] == kNoKey ? kNoNode : numbers.index(polygon[k]);
    }
    section.polygons.push_back(nodes);
  }
  return section;
}

SurfaceSection section_of_surface(const TriangleSoup& surface, const Plane& plane) {
  const std::vector<double> height = heights(surface.points, plane);
  std::vector<std::array<std::uint64_t, 2>> pairs;
  std::vector<std::uint64_t> keys;
  for (const Triangle& t : surface.triangles) {
    const bool high[3] = {above(height[t[0]]), above(height[t[1]]), above(height[t[2]])};
    if (high[0] == high[1] && high[1] == high[2]) continue;
    // The corner that is alone on its side.
    const int k = high[0] == high[1] ? 2 : (high[0] == high[2] ? 1 : 0);
    pairs.push_back({edge_key(t[k], t[(k + 1) % 3]), edge_key(t[k], t[(k + 2) % 3])});
    keys.insert(keys.end(), pairs.back().begin(), pairs.back().end());
  }
  const NodeNumbers numbers(std::move(keys));
  SurfaceSection section;
  section.nodes = numbers.positions(surface.points, height, plane_frame(plane));
  std::vector<std::uint32_t> degree(section.nodes.size(), 0);
  section.segments.reserve(pairs.size());
  for (const auto& pair : pairs) {
    const Segment segment{numbers.index(pair[0]), numbers.index(pair[1])};
    ++degree[segment[0]];
    ++degree[segment[1]];
    section.segments.push_back(segment);
  }
  section.closed = !section.segments.empty() &&
                   std::all_of(degree.begin(), degree.end(), [](auto d) { return d % 2 == 0; });
  return section;
}

std::vector<Segment> sides_of(const std::vector<std::array<std::uint32_t, 4>>& polygons) {
  std::vector<Segment> sides;
  sides.reserve(4 * polygons.size());
  for (const auto& polygon : polygons) {
    const int count = polygon[3] == kNoNode ? 3 : 4;
    for (int k = 0; k < count; ++k) sides.push_back({polygon[k], polygon[(k + 1) % count]});
  }
  return sides;
}

std::vector<Segment> outline(std::vector<Segment> segments) {
  sort_undirected(segments);
  std::vector<Segment> odd;
  for (std::size_t i = 0; i < segments.size();) {
    std::size_t end = i;
    while (end < segments.size() && segments[end] == segments[i]) ++end;
    if ((end - i) % 2 == 1) odd.push_back(segments[i]);
    i = end;
  }
  return odd;
}

std::vector<Segment> unique_segments(std::vector<Segment> segments) {
  sort_undirected(segments);
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
  return segments;
}

std::vector<Chain> chain_segments(std::size_t node_count, const std::vector<Segment>& segments) {
  // Segments around each node, in compressed rows.
  std::vector<std::uint32_t> first(node_count + 1, 0);
  for (const Segment& s : segments) {
    if (s[0] == s[1]) continue;
    ++first[s[0] + 1];
    ++first[s[1] + 1];
  }
  for (std::size_t i = 0; i < node_count; ++i) first[i + 1] += first[i];
  std::vector<std::uint32_t> around(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i][0] == segments[i][1]) continue;
    for (const std::uint32_t node : segments[i])
      around[next[node]++] = static_cast<std::uint32_t>(i);
  }
  std::copy(first.begin(), first.end() - 1, next.begin());

  std::vector<char> used(segments.size(), 0);
  std::vector<Chain> chains;
  const auto walk_from = [&](std::uint32_t start) {
    Chain chain;
    std::uint32_t node = start;
    chain.nodes.push_back(node);
    while (true) {
      while (next[node] < first[node + 1] && used[around[next[node]]] != 0) ++next[node];
      if (next[node] == first[node + 1]) break;
      const std::uint32_t segment = around[next[node]];
      used[segment] = 1;
      node = segments[segment][0] == node ? segments[segment][1] : segments[segment][0];
      chain.nodes.push_back(node);
    }
    if (chain.nodes.size() < 2) return false;
    chain.closed = node == start;
    if (chain.closed) chain.nodes.pop_back();
    chains.push_back(std::move(chain));
    return true;
  };
  // A walk can only get stuck at a node with an odd number of segments, or where it began: begin at
  // all odd nodes, then what is left is even everywhere.
  for (std::uint32_t node = 0; node < node_count; ++node) {
    if ((first[node + 1] - first[node]) % 2 == 1) walk_from(node);
  }
  for (std::uint32_t node = 0; node < node_count; ++node) {
    while (walk_from(node)) {
    }
  }
  return chains;
}

}  // namespace cellocut::viz
