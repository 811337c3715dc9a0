// Meshes as a page holds them: few faces, small numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut::tools {

// A mesh on a grid of 65,536 steps along the edge of a cube, in input units.
struct PackedMesh {
  std::string title;
  std::string note;  // what is shown, in a sentence
  Box3 box;
  Point3 low{};     // of the cube
  double size = 1;  // its edge
  std::vector<std::array<std::uint16_t, 3>> positions;
  std::vector<Triangle> triangles;
  std::size_t faces_before = 0;
};

// Puts the points on the grid, merges those that meet there, drops the faces that collapse with
// them and those with a point that is not finite, and decimates to at most `faces` by quadrics
// (meshoptimizer); by clusters where the quadrics cannot get that far, as with faces that share no
// edge. For the eye alone: the result need not be manifold. The mesh may be empty. O(n log n).
PackedMesh pack_mesh(const TriangleSoup& soup, std::size_t faces);

// As web/src/viewer.js reads it.
nlohmann::ordered_json packed_json(const PackedMesh& mesh);

}  // namespace cellocut::tools
