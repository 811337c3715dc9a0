#include "cellocut/mesh/soup_builder.h"

#include <algorithm>
#include <limits>

#include "cellocut/base/errors.h"
#include "cellocut/mesh/triangulate_polygon.h"

namespace cellocut::mesh_io {

void SoupBuilder::reserve_points(std::size_t claimed, std::size_t most) {
  soup_.points.reserve(std::min(claimed, most));
}

void SoupBuilder::reserve_faces(std::size_t claimed, std::size_t most) {
  soup_.triangles.reserve(std::min(claimed, most));
}

void SoupBuilder::add_point(const Point3& point) {
  if (soup_.points.size() == std::numeric_limits<std::uint32_t>::max()) {
    throw InputError("more than 4294967295 vertices");
  }
  soup_.points.push_back(point);
}

void SoupBuilder::add_face(std::span<const std::uint32_t> corners, std::size_t place) {
  for (const std::uint32_t corner : corners) {
    if (corner >= highest_corner_) {
      // The first face that names the highest point, for a message that points at it.
      if (corner > highest_corner_ || highest_place_ == 0) highest_place_ = place;
      highest_corner_ = corner;
    }
  }
  if (corners.size() > 3) {
    polygons_.push_back({soup_.triangles.size(), static_cast<std::uint32_t>(corners.size())});
  }
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    soup_.triangles.push_back({corners[0], corners[i], corners[i + 1]});
  }
}

TriangleSoup SoupBuilder::finish(const char* place_name, std::size_t first_index) {
  if (soup_.triangles.empty()) throw InputError("no faces");
  if (highest_corner_ >= soup_.points.size()) {
    std::string what = place_name;
    what.append(" ").append(std::to_string(highest_place_)).append(": a face names vertex ");
    what += std::to_string(highest_corner_ + first_index);
    if (soup_.points.empty()) throw InputError(what + ", but there are no vertices");
    throw InputError(what + ", but the vertices are " + std::to_string(first_index) + " to " +
                     std::to_string(soup_.points.size() - 1 + first_index));
  }
  soup_.colours = colours_.finish(soup_.points.size());
  std::vector<std::uint32_t> corners;
  for (const Polygon& polygon : polygons_) {
    const std::span<Triangle> triangles(&soup_.triangles[polygon.first_triangle],
                                        polygon.corner_count - 2);
    corners.assign({triangles[0][0], triangles[0][1]});
    for (const Triangle& triangle : triangles) corners.push_back(triangle[2]);
    triangulate_polygon(soup_.points, corners, triangles);
  }
  return std::move(soup_);
}

}  // namespace cellocut::mesh_io
