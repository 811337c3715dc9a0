#include "cellocut/mesh/triangle_soup.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace cellocut {

namespace {

// What include(box, i) makes of `first` over all i below count.
template <class Include>
Box3 box_in_parallel(std::size_t count, const Box3& first, const Include& include) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 4096), first,
      [&](const auto& range, Box3 box) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) include(box, i);
        return box;
      },
      [](Box3 box, const Box3& other) {
        box.include(other);
        return box;
      });
}

}  // namespace

Box3 bounding_box(const TriangleSoup& soup) { return bounding_box(soup.points, soup.triangles); }

Box3 bounding_box(const std::vector<Point3>& points, const std::vector<Triangle>& triangles) {
  const Point3& first = points[triangles.front()[0]];
  return box_in_parallel(triangles.size(), Box3{first, first}, [&](Box3& box, std::size_t f) {
    for (const std::uint32_t v : triangles[f]) box.include(points[v]);
  });
}

Box3 bounding_box(const std::vector<Point3>& points, const std::vector<Triangle>& triangles,
                  const std::vector<std::uint32_t>& faces) {
  const Point3& first = points[triangles[faces.front()][0]];
  return box_in_parallel(faces.size(), Box3{first, first}, [&](Box3& box, std::size_t i) {
    for (const std::uint32_t v : triangles[faces[i]]) box.include(points[v]);
  });
}

Box3 bounding_box(const std::vector<Point3>& points) {
  return box_in_parallel(points.size(), Box3{points.front(), points.front()},
                         [&](Box3& box, std::size_t i) { box.include(points[i]); });
}

TriangleSoup seen_from(const Point3& origin, const TriangleSoup& soup) {
  TriangleSoup seen;
  seen.points.resize(soup.points.size());
  tbb::parallel_for(std::size_t{0}, seen.points.size(),
                    [&](std::size_t i) { seen.points[i] = soup.points[i] - origin; });
  seen.triangles = soup.triangles;
  return seen;
}

}  // namespace cellocut
