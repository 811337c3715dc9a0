#include "cellocut/surface/cube_table.h"

#include <algorithm>

namespace cellocut {

namespace {

// The four corners of each face, counter-clockwise seen from outside the cell.
constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                              {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

int edge_between(int corner_a, int corner_b) {
  const int low = std::min(corner_a, corner_b);
  const int axis_bit = corner_a ^ corner_b;
  const int axis = axis_bit == 1 ? 0 : axis_bit == 2 ? 1 : 2;
  for (int e = 4 * axis; e < 4 * axis + 4; ++e) {
    if (edge_low_corner(e) == low) return e;
  }
  return -1;
}

// A directed piece of the zero set in a face of the cell, from edge vertex to edge vertex.
struct Segment {
  int from;
  int to;
  int face;
};

// One segment for each run of outside corners around a face: at an ambiguous face each of the two
// outside corners is cut off by itself, so the inside is joined.
std::vector<Segment> face_segments(int pattern) {
  std::vector<Segment> segments;
  const auto inside = [&](int corner) { return ((pattern >> corner) & 1) != 0; };
  for (int face = 0; face < 6; ++face) {
    const int* corner = kFaces[face];
    for (int i = 0; i < 4; ++i) {
      if (!inside(corner[i]) || inside(corner[(i + 1) % 4])) continue;
      const int leaves = edge_between(corner[i], corner[(i + 1) % 4]);  // inside -> outside
      int j = (i + 1) % 4;
      while (!inside(corner[(j + 1) % 4])) j = (j + 1) % 4;
      const int enters = edge_between(corner[j], corner[(j + 1) % 4]);  // outside -> inside
      segments.push_back({enters, leaves, face});
    }
  }
  return segments;
}

// Segments linked head to tail.
std::vector<std::vector<Segment>> link_loops(std::vector<Segment> segments) {
  std::vector<std::vector<Segment>> loops;
  while (!segments.empty()) {
    std::vector<Segment> loop{segments.front()};
    segments.erase(segments.begin());
    while (loop.back().to != loop.front().from) {
      const auto next = std::find_if(segments.begin(), segments.end(),
                                     [&](const Segment& s) { return s.from == loop.back().to; });
      loop.push_back(*next);
      segments.erase(next);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

// The position in the loop of a vertex whose two faces the loop visits once each, or -1.
int find_apex(const std::vector<Segment>& loop) {
  const auto visits = [&](int face) {
    return std::count_if(loop.begin(), loop.end(),
                         [&](const Segment& s) { return s.face == face; });
  };
  const int n = static_cast<int>(loop.size());
  for (int i = 0; i < n; ++i) {
    if (visits(loop[i].face) == 1 && visits(loop[(i + n - 1) % n].face) == 1) return i;
  }
  return -1;
}

void add_triangle(CubeCase& cube, int a, int b, int c) {
  cube.triangles.push_back(
      {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(c)});
}

// A disk that the loop bounds: a fan from a loop vertex where one sees the rest of the loop, from
// an inner point otherwise.
void add_disk(CubeCase& cube, const std::vector<Segment>& loop) {
  const int n = static_cast<int>(loop.size());
  const int apex = find_apex(loop);
  if (apex >= 0) {
    for (int i = 1; i + 1 < n; ++i) {
      const Segment& segment = loop[(apex + i) % n];
      add_triangle(cube, loop[apex].from, segment.from, segment.to);
    }
    return;
  }
  for (const Segment& segment : loop) {
    add_triangle(cube, kInnerPoint, segment.from, segment.to);
    cube.inner_loop.push_back(static_cast<std::uint8_t>(segment.from));
  }
}

// The tube between two opposite inside corners: each segment of one loop with the vertex of the
// other loop on the edge along the third axis.
void add_tube(CubeCase& cube, const std::vector<Segment>& one, const std::vector<Segment>& other) {
  for (const auto& [loop, opposite] : {std::pair(&one, &other), std::pair(&other, &one)}) {
    for (const Segment& segment : *loop) {
      const int third_axis = 3 - edge_axis(segment.from) - edge_axis(segment.to);
      const auto across = std::find_if(opposite->begin(), opposite->end(), [&](const Segment& s) {
        return edge_axis(s.from) == third_axis;
      });
      add_triangle(cube, segment.from, segment.to, across->from);
    }
  }
}

CubeCase make_case(int pattern) {
  CubeCase cube;
  const std::vector<std::vector<Segment>> loops = link_loops(face_segments(pattern));
  const bool opposite_corners =
      pattern == 0x81 || pattern == 0x42 || pattern == 0x24 || pattern == 0x18;
  if (opposite_corners) {
    add_tube(cube, loops[0], loops[1]);
  } else {
    for (const std::vector<Segment>& loop : loops) add_disk(cube, loop);
  }
  return cube;
}

}  // namespace

const std::array<CubeCase, 256>& cube_table() {
  static const std::array<CubeCase, 256> table = [] {
    std::array<CubeCase, 256> cases;
    for (int pattern = 0; pattern < 256; ++pattern) cases[pattern] = make_case(pattern);
    return cases;
  }();
  return table;
}

}  // namespace cellocut
