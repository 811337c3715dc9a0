// Where the pull would leave a bevel in a concave crease of the input.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cellocut/base/buckets.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// In a concave corner, groove or slot of the input the surface before the pull has a crease, at
// `offset` from both sides. The vertices next to it are pulled to different sides, and between them
// a bevel remains, some `offset` wide and with the teeth of the grid. So they slide down their
// sides together, towards the bottom, up to a tenth of their way to it: what was a strip of the
// crease's neighbourhood keeps its order, and the bevel shrinks.
class CreaseSlide {
 public:
  // `points`: before the pull; corners_at: corners_by_point() of the triangles (incidence.h);
  // `sides`: by vertex, the direction from its nearest point on the input to it, of length 1, and 0
  // where it stays; `offset`: the distance of supported vertices from the input now, about, and
  // `distance` that which the pull leaves. All of them must outlive this. Parallel; O(triangles).
  // Precondition: the surface is closed and oriented.
  CreaseSlide(std::span<const Point3> points, const std::vector<Triangle>& triangles,
              const Buckets& corners_at, std::span<const Point3> sides,
              const NearestTriangle& input, double offset, double distance);

  // Where the vertex slides from `to`, its place after the pull; `to` itself where it is not at a
  // crease. It goes at most twice `offset`, keeps to its side, at `distance` from it, and away from
  // all others. May be called from several threads. O(log n).
  [[nodiscard]] Point3 operator()(std::uint32_t vertex, const Point3& to) const;

 private:
  struct Footing {
    Point3 place;
    Point3 side;  // from the nearest point on the input to the place, of length 1
  };

  // The vertex that the edge from a corner, as corners_at has it, leads to.
  [[nodiscard]] std::uint32_t next(std::uint32_t corner) const {
    return triangles_[corner / 3][(corner % 3 + 1) % 3];
  }
  // The sum of the sides of neighbours across concave creases.
  [[nodiscard]] Point3 facing(std::uint32_t vertex) const;
  // Whether the way from a vertex to another one, or back, leads across a concave crease.
  [[nodiscard]] bool crosses_crease(std::uint32_t vertex, std::uint32_t other) const;
  [[nodiscard]] std::optional<Footing> step_down(const Footing& from, const Point3& facing,
                                                 double step) const;

  std::span<const Point3> points_;
  const std::vector<Triangle>& triangles_;
  const Buckets& corners_at_;
  std::span<const Point3> sides_;
  const NearestTriangle& input_;
  double offset_;
  double distance_;
  std::unique_ptr<std::uint8_t[]> at_crease_;  // by vertex: 1 where an edge leads across one
};

}  // namespace cellocut
