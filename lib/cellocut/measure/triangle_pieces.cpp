#include "cellocut/measure/triangle_pieces.h"

#include <algorithm>
#include <utility>

namespace cellocut {

namespace {

struct LongPiece {
  TrianglePiece piece;
  int longest = 0;  // edge, from corner `longest` to the next
  double squared = 0;

  explicit LongPiece(const TrianglePiece& of) : piece(of) {
    for (int k = 0; k < 3; ++k) {
      const double edge = squared_norm(of.corners[(k + 1) % 3] - of.corners[k]);
      if (edge > squared) {
        squared = edge;
        longest = k;
      }
    }
  }
};

bool shorter(const LongPiece& a, const LongPiece& b) { return a.squared < b.squared; }

std::pair<LongPiece, LongPiece> halves(const LongPiece& whole) {
  const auto& [triangle, corners] = whole.piece;
  const Point3& from = corners[whole.longest];
  const Point3& to = corners[(whole.longest + 1) % 3];
  const Point3& apex = corners[(whole.longest + 2) % 3];
  const Point3 middle = 0.5 * (from + to);
  return {LongPiece({triangle, {from, middle, apex}}), LongPiece({triangle, {middle, to, apex}})};
}

}  // namespace

std::vector<TrianglePiece> cut_long_triangles(const std::vector<std::array<Point3, 3>>& triangles,
                                              double longest, std::size_t most) {
  std::vector<LongPiece> heap;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const LongPiece whole({i, triangles[i]});
    if (!(whole.squared > longest * longest)) continue;
    if (heap.size() == most) return {};
    heap.push_back(whole);
  }
  std::make_heap(heap.begin(), heap.end(), shorter);
  while (!heap.empty() && heap.size() < most && heap.front().squared > longest * longest) {
    std::pop_heap(heap.begin(), heap.end(), shorter);
    auto [left, right] = halves(heap.back());
    heap.back() = left;
    std::push_heap(heap.begin(), heap.end(), shorter);
    heap.push_back(right);
    std::push_heap(heap.begin(), heap.end(), shorter);
  }
  std::vector<TrianglePiece> pieces;
  pieces.reserve(heap.size());
  for (const LongPiece& piece : heap) pieces.push_back(piece.piece);
  return pieces;
}

}  // namespace cellocut
