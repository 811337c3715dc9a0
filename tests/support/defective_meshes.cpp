#include "support/defective_meshes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "support/soup_operations.h"

namespace cellocut::test {
namespace {

constexpr double kPi = std::numbers::pi;

// Four triangles for each, new points in the middle of the edges (shared between neighbours).
void subdivide(TriangleSoup& soup) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, fresh] = middles.try_emplace(std::minmax(a, b), 0u);
    if (fresh) {
      found->second = static_cast<std::uint32_t>(soup.points.size());
      soup.points.push_back(0.5 * (soup.points[a] + soup.points[b]));
    }
    return found->second;
  };
  std::vector<Triangle> finer;
  for (const Triangle& t : soup.triangles) {
    const std::uint32_t ab = middle(t[0], t[1]);
    const std::uint32_t bc = middle(t[1], t[2]);
    const std::uint32_t ca = middle(t[2], t[0]);
    finer.insert(finer.end(), {{t[0], ab, ca}, {t[1], bc, ab}, {t[2], ca, bc}, {ab, bc, ca}});
  }
  soup.triangles = std::move(finer);
}

void add_quad(TriangleSoup& soup, std::uint32_t a, std::uint32_t b, std::uint32_t c,
              std::uint32_t d) {
  soup.triangles.push_back({a, b, c});
  soup.triangles.push_back({a, c, d});
}

// The triangles all of whose corners satisfy `keep`; points that are left over stay.
template <class Keep>
TriangleSoup part_where(TriangleSoup soup, Keep keep) {
  std::erase_if(soup.triangles, [&](const Triangle& t) {
    return !std::all_of(t.begin(), t.end(), [&](std::uint32_t v) { return keep(soup.points[v]); });
  });
  return soup;
}

}  // namespace

TriangleSoup icosphere(int subdivisions, double radius, const Point3& centre) {
  const double g = std::numbers::phi;
  TriangleSoup soup;
  soup.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                 {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  soup.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int i = 0; i < subdivisions; ++i) {
    subdivide(soup);
    for (Point3& p : soup.points) p = (1 / norm(p)) * p;
  }
  for (Point3& p : soup.points) p = (radius / norm(p)) * p + centre;
  return soup;
}

TriangleSoup box(const Point3& low, const Point3& high) {
  TriangleSoup soup;
  for (int i = 0; i < 8; ++i) {
    soup.points.push_back({(i & 1) != 0 ? high[0] : low[0], (i & 2) != 0 ? high[1] : low[1],
                           (i & 4) != 0 ? high[2] : low[2]});
  }
  add_quad(soup, 0, 2, 3, 1);
  add_quad(soup, 4, 5, 7, 6);
  add_quad(soup, 0, 1, 5, 4);
  add_quad(soup, 2, 6, 7, 3);
  add_quad(soup, 0, 4, 6, 2);
  add_quad(soup, 1, 3, 7, 5);
  return soup;
}

TriangleSoup torus(double ring_radius, double tube_radius, int around, int across) {
  TriangleSoup soup;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * kPi * i / around;
      const double v = 2 * kPi * j / across;
      const double distance = ring_radius + tube_radius * std::cos(v);
      soup.points.push_back(
          {distance * std::cos(u), distance * std::sin(u), tube_radius * std::sin(v)});
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % around) * across + j % across);
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      add_quad(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return soup;
}

TriangleSoup open_bowl() {
  return part_where(icosphere(4), [](const Point3& p) { return p[2] <= 1e-9; });
}

TriangleSoup two_crossing_boxes() {
  TriangleSoup soup = box({-1, -0.7, -0.5}, {1, 0.7, 0.5});
  append(soup, translated(rotated(box({-0.9, -0.4, -0.6}, {0.9, 0.4, 0.6}), {1, 2, 3}, 0.8),
                          {0.31, 0.17, 0.23}));
  return soup;
}

TriangleSoup moebius_strip() {
  constexpr int kAround = 64;
  constexpr int kAcross = 4;
  TriangleSoup soup;
  for (int i = 0; i < kAround; ++i) {
    const double u = 2 * kPi * i / kAround;
    for (int j = 0; j <= kAcross; ++j) {
      const double width = 0.8 * (static_cast<double>(j) / kAcross - 0.5);
      const double distance = 1 + width * std::cos(u / 2);
      soup.points.push_back(
          {distance * std::cos(u), distance * std::sin(u), width * std::sin(u / 2)});
    }
  }
  // After one turn the strip meets itself upside down.
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(i < kAround ? i * (kAcross + 1) + j : kAcross - j);
  };
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      add_quad(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return soup;
}

TriangleSoup tilted_sheet(const Point3& normal, double size, int subdivisions) {
  const Point3 n = (1 / norm(normal)) * normal;
  // The axis that is furthest from the normal gives the first direction in the plane.
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(n[k]) < std::abs(n[axis])) axis = k;
  }
  Point3 other{};
  other[axis] = 1;
  Point3 u = cross(n, other);
  u = (1 / norm(u)) * u;
  const Point3 v = cross(n, u);
  TriangleSoup soup;
  for (int i = 0; i <= subdivisions; ++i) {
    for (int j = 0; j <= subdivisions; ++j) {
      const double s = size * (static_cast<double>(i) / subdivisions - 0.5);
      const double t = size * (static_cast<double>(j) / subdivisions - 0.5);
      soup.points.push_back(s * u + t * v);
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>(i * (subdivisions + 1) + j);
  };
  for (int i = 0; i < subdivisions; ++i) {
    for (int j = 0; j < subdivisions; ++j) {
      add_quad(soup, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  }
  return soup;
}

TriangleSoup single_sheet() { return tilted_sheet({0.36, -0.48, 0.8}, 1, 8); }

TriangleSoup nested_spheres() {
  TriangleSoup soup = icosphere(3, 1.0);
  append(soup, icosphere(3, 0.7));
  append(soup, icosphere(3, 0.4));
  return soup;
}

TriangleSoup bow_tie_vertex() {
  TriangleSoup soup;
  soup.points = {{0, 0, 0},     {1, 0.1, 0.2},    {0.9, 1, 0.1}, {1, 0.4, 1},
                 {-1, -0.2, 0}, {-0.8, -1, -0.1}, {-1, -0.5, -1}};
  soup.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3},
                    {0, 4, 5}, {0, 6, 4}, {0, 5, 6}, {4, 6, 5}};
  return soup;
}

TriangleSoup duplicate_faces() {
  TriangleSoup soup = box({0, 0, 0}, {1, 0.8, 0.6});
  const std::vector<Triangle> faces = soup.triangles;
  for (std::size_t i = 0; i < faces.size(); i += 3) {
    const Triangle& t = faces[i];
    soup.triangles.push_back({t[1], t[2], t[0]});
    soup.triangles.push_back({t[0], t[2], t[1]});
  }
  return soup;
}

TriangleSoup t_junctions() {
  TriangleSoup soup = box({0, 0, 0}, {1, 0.8, 0.6});
  // The top (the second pair of faces) divided twice by itself.
  TriangleSoup top;
  top.points = soup.points;
  top.triangles = {soup.triangles[2], soup.triangles[3]};
  subdivide(top);
  subdivide(top);
  soup.points = top.points;
  soup.triangles.erase(soup.triangles.begin() + 2, soup.triangles.begin() + 4);
  soup.triangles.insert(soup.triangles.end(), top.triangles.begin(), top.triangles.end());
  return soup;
}

TriangleSoup one_triangle() {
  TriangleSoup soup;
  soup.points = {{0.1, 0.2, 0.3}, {1.1, 0.25, 0.4}, {0.4, 0.95, 0.7}};
  soup.triangles = {{0, 1, 2}};
  return soup;
}

TriangleSoup flipped_faces() {
  TriangleSoup soup = box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3});
  subdivide(soup);
  subdivide(soup);
  return with_faces_flipped(soup, 7);
}

TriangleSoup sphere_with_hole() {
  return part_where(icosphere(4), [](const Point3& p) { return p[2] < 0.85; });
}

TriangleSoup degenerate_faces() {
  TriangleSoup soup = icosphere(2);
  const Triangle t = soup.triangles[5];
  const auto middle = static_cast<std::uint32_t>(soup.points.size());
  soup.points.push_back(0.5 * (soup.points[t[0]] + soup.points[t[1]]));
  soup.triangles.push_back({t[0], middle, t[1]});
  soup.triangles.push_back({t[0], t[0], t[1]});
  soup.triangles.push_back({t[2], t[2], t[2]});
  // Exactly collinear: three points on the z axis.
  soup.points.insert(soup.points.end(), {{0, 0, 1.25}, {0, 0, 1.5}, {0, 0, 1.75}});
  soup.triangles.push_back({middle + 1, middle + 2, middle + 3});
  return soup;
}

std::vector<NamedSoup> all_defective_meshes() {
  return {{"open_bowl", open_bowl()},
          {"two_crossing_boxes", two_crossing_boxes()},
          {"moebius_strip", moebius_strip()},
          {"single_sheet", single_sheet()},
          {"nested_spheres", nested_spheres()},
          {"bow_tie_vertex", bow_tie_vertex()},
          {"duplicate_faces", duplicate_faces()},
          {"t_junctions", t_junctions()},
          {"one_triangle", one_triangle()},
          {"flipped_faces", flipped_faces()},
          {"sphere_with_hole", sphere_with_hole()},
          {"degenerate_faces", degenerate_faces()}};
}

}  // namespace cellocut::test
