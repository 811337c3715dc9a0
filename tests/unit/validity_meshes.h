// Small meshes with known properties, for the tests of the surface check.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut::testing {

// The box [low, high], oriented outward.
inline TriangleSoup box(const Point3& low = {0, 0, 0}, const Point3& high = {1, 1, 1}) {
  TriangleSoup soup;
  for (int corner = 0; corner < 8; ++corner) {
    soup.points.push_back({(corner & 1) != 0 ? high[0] : low[0],
                           (corner & 2) != 0 ? high[1] : low[1],
                           (corner & 4) != 0 ? high[2] : low[2]});
  }
  soup.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return soup;
}

// The box [low, high] with 2 n^2 faces to a side, oriented outward.
inline TriangleSoup gridded_box(const Point3& low, const Point3& high, std::uint32_t n) {
  TriangleSoup soup;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> number;
  const auto point = [&](const std::array<std::uint32_t, 3>& at) {
    const auto [place, fresh] =
        number.try_emplace(at, static_cast<std::uint32_t>(soup.points.size()));
    if (fresh) {
      Point3 p{};
      for (int axis = 0; axis < 3; ++axis) {
        const double t = static_cast<double>(at[axis]) / n;
        p[axis] = (1 - t) * low[axis] + t * high[axis];
      }
      soup.points.push_back(p);
    }
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
          const auto corner = [&](std::uint32_t di, std::uint32_t dj) {
            std::array<std::uint32_t, 3> at{};
            at[axis] = upper ? n : 0;
            at[(axis + 1) % 3] = i + di;
            at[(axis + 2) % 3] = j + dj;
            return point(at);
          };
          const std::uint32_t a = corner(0, 0);
          const std::uint32_t b = upper ? corner(1, 0) : corner(0, 1);
          const std::uint32_t c = corner(1, 1);
          const std::uint32_t d = upper ? corner(0, 1) : corner(1, 0);
          soup.triangles.push_back({a, b, c});
          soup.triangles.push_back({a, c, d});
        }
      }
    }
  }
  return soup;
}

// Positively oriented tetrahedron, faces outward.
inline TriangleSoup tetrahedron(const Point3& a, const Point3& b, const Point3& c,
                                const Point3& d) {
  return {{a, b, c, d}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

inline TriangleSoup unit_tetrahedron() {
  return tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
}

inline TriangleSoup joined(TriangleSoup first, const TriangleSoup& second) {
  const auto offset = static_cast<std::uint32_t>(first.points.size());
  first.points.insert(first.points.end(), second.points.begin(), second.points.end());
  for (const Triangle& t : second.triangles) {
    first.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return first;
}

inline TriangleSoup flipped(TriangleSoup soup) {
  for (Triangle& t : soup.triangles) std::swap(t[1], t[2]);
  return soup;
}

// An icosahedron, each face split into four `levels` times, corners on the sphere: 20 * 4^levels
// faces.
inline TriangleSoup icosphere(int levels, double radius = 1, const Point3& centre = {0, 0, 0}) {
  const double t = std::numbers::phi;
  TriangleSoup soup;
  soup.points = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                 {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  soup.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
      const auto [place, fresh] =
          middles.try_emplace(std::minmax(i, j), static_cast<std::uint32_t>(soup.points.size()));
      if (fresh) soup.points.push_back(0.5 * (soup.points[i] + soup.points[j]));
      return place->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& f : soup.triangles) {
      const std::uint32_t a = middle(f[0], f[1]);
      const std::uint32_t b = middle(f[1], f[2]);
      const std::uint32_t c = middle(f[2], f[0]);
      finer.insert(finer.end(), {{f[0], a, c}, {f[1], b, a}, {f[2], c, b}, {a, b, c}});
    }
    soup.triangles = std::move(finer);
  }
  for (Point3& p : soup.points) p = centre + (radius / norm(p)) * p;
  return soup;
}

// A torus around the z axis, oriented outward.
inline TriangleSoup torus(std::uint32_t around, std::uint32_t across, double major, double minor) {
  TriangleSoup soup;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around;
      const double v = 2 * std::numbers::pi * j / across;
      const double r = major + minor * std::cos(v);
      soup.points.push_back({r * std::cos(u), r * std::sin(u), minor * std::sin(v)});
      const std::uint32_t next_i = (i + 1) % around;
      const std::uint32_t next_j = (j + 1) % across;
      const std::uint32_t a = i * across + j;
      const std::uint32_t b = next_i * across + j;
      const std::uint32_t c = next_i * across + next_j;
      const std::uint32_t d = i * across + next_j;
      soup.triangles.push_back({a, b, c});
      soup.triangles.push_back({a, c, d});
    }
  }
  return soup;
}

// A strip of 2 n triangles around the z axis with half a twist: one-sided, one boundary of 2 n
// edges.
inline TriangleSoup moebius_strip(std::uint32_t n) {
  TriangleSoup soup;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n;
    for (const double side : {-0.3, 0.3}) {
      const double r = 1 + side * std::cos(u / 2);
      soup.points.push_back({r * std::cos(u), r * std::sin(u), side * std::sin(u / 2)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i;
    const std::uint32_t b = 2 * i + 1;
    const bool last = i + 1 == n;
    const std::uint32_t c = last ? 1 : a + 2;
    const std::uint32_t d = last ? 0 : b + 2;
    soup.triangles.push_back({a, c, b});
    soup.triangles.push_back({b, c, d});
  }
  return soup;
}

}  // namespace cellocut::testing
