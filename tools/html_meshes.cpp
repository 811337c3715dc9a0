#include "tools/html_meshes.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "tools/html_parts.h"

namespace cellocut::tools {

namespace {

constexpr double kSteps = std::numeric_limits<std::uint16_t>::max();
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

bool is_drawable(const TriangleSoup& soup, const Triangle& triangle) {
  return std::all_of(triangle.begin(), triangle.end(),
                     [&](std::uint32_t v) { return is_finite(soup.points[v]); });
}

bool is_collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

std::vector<float> grid_points(const PackedMesh& mesh) {
  std::vector<float> points;
  points.reserve(3 * mesh.positions.size());
  for (const auto& position : mesh.positions) {
    for (const std::uint16_t x : position) points.push_back(static_cast<float>(x));
  }
  return points;
}

void decimate(PackedMesh& mesh, std::size_t faces) {
  const std::vector<float> points = grid_points(mesh);
  const std::size_t count = mesh.positions.size();
  constexpr std::size_t kStride = 3 * sizeof(float);
  constexpr float kAnyError = 1;  // the whole extent
  std::vector<unsigned int> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  std::vector<unsigned int> left(corners.size());
  std::size_t size = meshopt_simplify(left.data(), corners.data(), corners.size(), points.data(),
                                      count, kStride, 3 * faces, kAnyError, 0, nullptr);
  if (size > 3 * faces) {
    size = meshopt_simplifySloppy(left.data(), corners.data(), corners.size(), points.data(), count,
                                  kStride, 3 * faces, kAnyError, nullptr);
  }
  mesh.triangles.assign(std::min(size / 3, faces), Triangle{});
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) mesh.triangles[f][k] = left[3 * f + k];
  }
}

void drop_unused_points(PackedMesh& mesh) {
  std::vector<std::uint32_t> number(mesh.positions.size(), kUnused);
  std::vector<std::array<std::uint16_t, 3>> used;
  used.reserve(mesh.positions.size());
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      if (number[v] == kUnused) {
        number[v] = static_cast<std::uint32_t>(used.size());
        used.push_back(mesh.positions[v]);
      }
      v = number[v];
    }
  }
  mesh.positions = std::move(used);
}

// The bytes of an array of unsigned integers, lowest first.
template <class Rows>
std::string little_endian(const Rows& rows) {
  using Number = typename Rows::value_type::value_type;
  std::string bytes;
  bytes.reserve(rows.size() * 3 * sizeof(Number));
  for (const auto& row : rows) {
    for (const Number x : row) {
      for (std::size_t b = 0; b < sizeof(Number); ++b) {
        bytes.push_back(static_cast<char>((x >> (8 * b)) & 0xFFU));
      }
    }
  }
  return bytes;
}

}  // namespace

PackedMesh pack_mesh(const TriangleSoup& soup, std::size_t faces) {
  PackedMesh mesh;
  mesh.faces_before = soup.triangles.size();
  std::vector<Triangle> drawable;
  drawable.reserve(soup.triangles.size());
  for (const Triangle& t : soup.triangles) {
    if (is_drawable(soup, t)) drawable.push_back(t);
  }
  if (drawable.empty()) return mesh;
  mesh.box = bounding_box(soup.points, drawable);
  mesh.low = mesh.box.low;
  const Point3 edges = mesh.box.high - mesh.box.low;
  mesh.size = *std::max_element(edges.begin(), edges.end());
  if (!(mesh.size > 0) || !std::isfinite(mesh.size)) return mesh;

  std::vector<std::uint32_t> number(soup.points.size(), kUnused);
  std::unordered_map<std::uint64_t, std::uint32_t> at;  // the point on a place of the grid
  mesh.triangles.reserve(drawable.size());
  for (Triangle t : drawable) {
    for (std::uint32_t& v : t) {
      if (number[v] == kUnused) {
        std::array<std::uint16_t, 3> position{};
        std::uint64_t key = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double share = (soup.points[v][axis] - mesh.low[axis]) / mesh.size;
          position[axis] = static_cast<std::uint16_t>(std::lround(kSteps * share));
          key = (key << 16) | position[axis];
        }
        const auto [entry, fresh] =
            at.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
        if (fresh) mesh.positions.push_back(position);
        number[v] = entry->second;
      }
      v = number[v];
    }
    if (!is_collapsed(t)) mesh.triangles.push_back(t);
  }
  if (mesh.triangles.size() > faces) decimate(mesh, faces);
  drop_unused_points(mesh);
  return mesh;
}

nlohmann::ordered_json packed_json(const PackedMesh& mesh) {
  return {{"title", mesh.title},
          {"note", mesh.note},
          {"box_low", mesh.box.low},
          {"box_high", mesh.box.high},
          {"low", mesh.low},
          {"size", mesh.size},
          {"points", mesh.positions.size()},
          {"faces", mesh.triangles.size()},
          {"positions", base64(little_endian(mesh.positions))},
          {"indices", base64(little_endian(mesh.triangles))}};
}

}  // namespace cellocut::tools
