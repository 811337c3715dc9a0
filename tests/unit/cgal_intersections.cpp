#include "cgal_intersections.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <map>

namespace cellocut::testing {

namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using Inexact = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Inexact::Point_3>;

Exact::Point_3 exact(const Point3& p) { return {p[0], p[1], p[2]}; }

std::array<Exact::Point_3, 3> exact_corners(const TriangleSoup& soup, std::uint32_t f) {
  const Triangle& t = soup.triangles[f];
  return {exact(soup.points[t[0]]), exact(soup.points[t[1]]), exact(soup.points[t[2]])};
}

// Whether the intersection of two triangles is more than their common corners.
struct IsMoreThan {
  using result_type = bool;
  const std::vector<Exact::Point_3>& common;

  bool operator()(const Exact::Point_3& p) const { return common.size() != 1 || p != common[0]; }
  bool operator()(const Exact::Segment_3& s) const {
    return common.size() != 2 || !((s.source() == common[0] && s.target() == common[1]) ||
                                   (s.source() == common[1] && s.target() == common[0]));
  }
  bool operator()(const Exact::Triangle_3&) const { return true; }
  bool operator()(const std::vector<Exact::Point_3>&) const { return true; }
};

bool meet_by_construction(const TriangleSoup& soup, std::uint32_t f, std::uint32_t g) {
  const auto p = exact_corners(soup, f);
  const auto q = exact_corners(soup, g);
  std::vector<Exact::Point_3> common;
  for (const auto& corner : p) {
    if (std::find(q.begin(), q.end(), corner) != q.end()) common.push_back(corner);
  }
  const auto result =
      CGAL::intersection(Exact::Triangle_3(p[0], p[1], p[2]), Exact::Triangle_3(q[0], q[1], q[2]));
  return result && boost::apply_visitor(IsMoreThan{common}, *result);
}

bool boxes_overlap(const TriangleSoup& soup, std::uint32_t f, std::uint32_t g) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto range = [&](std::uint32_t face) {
      const Triangle& t = soup.triangles[face];
      return std::minmax(
          {soup.points[t[0]][axis], soup.points[t[1]][axis], soup.points[t[2]][axis]});
    };
    const auto a = range(f);
    const auto b = range(g);
    if (a.second < b.first || b.second < a.first) return false;
  }
  return true;
}

std::size_t common_corners(const std::vector<std::size_t>& s, const std::vector<std::size_t>& t) {
  return static_cast<std::size_t>(std::count_if(
      s.begin(), s.end(), [&](std::size_t v) { return std::count(t.begin(), t.end(), v) != 0; }));
}

}  // namespace

std::vector<FacePair> pairs_by_construction(const TriangleSoup& soup) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < soup.triangles.size(); ++f) {
    const auto p = exact_corners(soup, f);
    if (!CGAL::collinear(p[0], p[1], p[2])) faces.push_back(f);
  }
  std::vector<FacePair> pairs;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t j = i + 1; j < faces.size(); ++j) {
      if (boxes_overlap(soup, faces[i], faces[j]) &&
          meet_by_construction(soup, faces[i], faces[j])) {
        pairs.emplace_back(faces[i], faces[j]);
      }
    }
  }
  return pairs;
}

CgalIntersections pairs_by_cgal(const TriangleSoup& soup) {
  namespace Pmp = CGAL::Polygon_mesh_processing;
  CgalIntersections result;
  std::vector<Inexact::Point_3> points;
  std::vector<std::vector<std::size_t>> merged;  // corners by position
  std::vector<std::uint32_t> face_of;            // of the soup
  std::map<Point3, std::size_t> place;
  for (std::uint32_t f = 0; f < soup.triangles.size(); ++f) {
    std::vector<std::size_t> corners;
    for (const std::uint32_t v : soup.triangles[f]) {
      const auto [entry, fresh] = place.try_emplace(soup.points[v], points.size());
      const Point3& p = soup.points[v];
      if (fresh) points.emplace_back(p[0], p[1], p[2]);
      corners.push_back(entry->second);
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
      result.degenerate.push_back(f);
      continue;
    }
    merged.push_back(corners);
    face_of.push_back(f);
  }
  auto polygons = merged;
  result.split = !Pmp::orient_polygon_soup(points, polygons);
  Mesh mesh;
  Pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> found;
  Pmp::self_intersections<CGAL::Sequential_tag>(mesh, std::back_inserter(found));
  for (const auto& [f, g] : found) {
    const std::size_t i = f;
    const std::size_t j = g;
    if (i == j) {
      result.degenerate.push_back(face_of[i]);
      continue;
    }
    // Orienting may reverse a polygon, but it keeps their order.
    const bool lost =
        common_corners(merged[i], merged[j]) != common_corners(polygons[i], polygons[j]);
    if (lost && !meet_by_construction(soup, face_of[i], face_of[j])) continue;
    result.pairs.emplace_back(std::min(face_of[i], face_of[j]), std::max(face_of[i], face_of[j]));
  }
  std::sort(result.pairs.begin(), result.pairs.end());
  std::sort(result.degenerate.begin(), result.degenerate.end());
  return result;
}

}  // namespace cellocut::testing
