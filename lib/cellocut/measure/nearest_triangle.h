// The nearest point of a triangle soup.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// The point of triangle (a, b, c) that is nearest to p; degenerate triangles too (a segment, a
// point).
Point3 nearest_on_triangle(const Point3& p, const Point3& a, const Point3& b, const Point3& c);

struct NearestPoint {
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  // Among those at the same distance the first by the coordinates of its corners; of equal ones the
  // lowest index.
  std::uint32_t face = kNone;
  Point3 point{};  // on that face, in the units of the soup
  double distance = std::numeric_limits<double>::infinity();  // in the units of the soup
  [[nodiscard]] bool found() const { return face != kNone; }
};

// Embree's hierarchy of boxes finds the candidates, in single precision and with room for its
// rounding; what decides among them is evaluated in doubles. So the answer is the minimum over all
// triangles, whatever the order in which they are visited: the same bits for any number of threads,
// and for another order of the faces or of their corners.
class NearestTriangle {
 public:
  // Copies what it needs of the soup. Triangles with corners that are not finite are never nearest.
  // Parallel; O(n log n).
  explicit NearestTriangle(const TriangleSoup& soup);
  ~NearestTriangle();
  NearestTriangle(NearestTriangle&&) noexcept;
  NearestTriangle& operator=(NearestTriangle&&) noexcept;

  // The nearest point at a distance of up to `limit`; not found() where there is none. May be
  // called from any number of threads at once. O(log n) on surfaces.
  [[nodiscard]] NearestPoint operator()(
      const Point3& p, double limit = std::numeric_limits<double>::infinity()) const;

  // Whether a triangle may lie between p and q: false only where the segment meets none. (It may
  // say so of a segment that lies in the plane of a triangle nearby.) As above; meant for segments
  // that are short against the triangles.
  [[nodiscard]] bool may_separate(const Point3& p, const Point3& q) const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace cellocut
