// Collects points and polygons as a reader meets them. Internal to the mesh readers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/mesh/vertex_colours.h"

namespace cellocut::mesh_io {

class SoupBuilder {
 public:
  // Room for counts that a header claims. They are not trusted: `most` is what the bytes that are
  // there could hold.
  void reserve_points(std::size_t claimed, std::size_t most);
  void reserve_faces(std::size_t claimed, std::size_t most);

  // Errors: InputError where there are more points than 32-bit indices can name.
  void add_point(const Point3& point);
  // Corners may name points that come later. `place` (a line, or the number of a face) is kept for
  // an error that finish() may find. Precondition: at least three corners.
  void add_face(std::span<const std::uint32_t> corners, std::size_t place);

  // The colour of the point that was added last, as the file writes it. See VertexColours.
  void set_colour(std::span<const double> components) {
    colours_.set(soup_.points.size() - 1, components);
  }
  void set_colour_full(double full) { colours_.set_full(full); }

  // A polygon of fewer than three corners, which is counted and left out.
  void skip_polygon() { ++soup_.skipped_polygons; }

  [[nodiscard]] std::size_t point_count() const { return soup_.points.size(); }
  // For readers that merge points.
  std::vector<Point3>& points() { return soup_.points; }

  // Triangulates the polygons and hands the soup over. `place_name` is "line" or "face",
  // `first_index` what the format calls its first vertex (0 or 1): both for messages. Errors:
  // InputError for a face that names a point that is not there, and for no faces.
  TriangleSoup finish(const char* place_name, std::size_t first_index);

 private:
  struct Polygon {
    std::size_t first_triangle;
    std::uint32_t corner_count;
  };
  TriangleSoup soup_;
  VertexColours colours_;
  // Any triangulation of n corners has n - 2 triangles. Each polygon is entered as a fan at once,
  // which holds its corners, and is triangulated in place when all points are known.
  std::vector<Polygon> polygons_;
  std::uint32_t highest_corner_ = 0;
  std::size_t highest_place_ = 0;
};

}  // namespace cellocut::mesh_io
