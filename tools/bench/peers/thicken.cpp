// peer_thicken: OpenVDB's thicken-and-mesh, to be compared with: the unsigned distance to the input
// on a grid (meshToVolume) and the surface at a distance from it (volumeToMesh), as many shape
// pipelines do. What encloses a cavity comes out as two shells.
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "cellocut/base/errors.h"
#include "tools/bench/peers/peer.h"

namespace {

struct Parameters {
  int resolution = 256;  // voxels along the longest edge of the box
  double offset = 1;     // in voxels
};

constexpr float kExtraBand = 2;  // voxels beyond the offset, so that the surface lies in the band

// The grid's surface, a quadrilateral cut into two triangles, in input units.
cellocut::TriangleSoup mesh_of(const openvdb::FloatGrid& grid, double iso_value) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
  openvdb::tools::volumeToMesh(grid, points, triangles, quads, iso_value, 0.0, true);
  cellocut::TriangleSoup soup;
  soup.points.reserve(points.size());
  for (const openvdb::Vec3s& p : points) {
    soup.points.push_back({double{p.x()}, double{p.y()}, double{p.z()}});
  }
  soup.triangles.reserve(triangles.size() + 2 * quads.size());
  for (const openvdb::Vec3I& t : triangles) soup.triangles.push_back({t[0], t[1], t[2]});
  for (const openvdb::Vec4I& q : quads) {
    soup.triangles.push_back({q[0], q[1], q[2]});
    soup.triangles.push_back({q[0], q[2], q[3]});
  }
  return soup;
}

cellocut::TriangleSoup thicken(const cellocut::TriangleSoup& input, const Parameters& parameters) {
  const cellocut::Box3 box = cellocut::bounding_box(input);
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, box.high[axis] - box.low[axis]);
  if (!(longest > 0)) throw cellocut::InputError("the mesh has no extent");
  const double voxel = longest / parameters.resolution;
  const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
  std::vector<openvdb::Vec3s> points;
  points.reserve(input.points.size());
  for (const auto& p : input.points) {
    points.emplace_back(transform->worldToIndex(openvdb::Vec3d(p[0], p[1], p[2])));
  }
  std::vector<openvdb::Vec3I> triangles;
  triangles.reserve(input.triangles.size());
  for (const cellocut::Triangle& t : input.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> soup(points,
                                                                                        triangles);
  const float band = static_cast<float>(parameters.offset) + kExtraBand;
  const openvdb::FloatGrid::Ptr grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      soup, *transform, band, band, openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  return mesh_of(*grid, parameters.offset * voxel);
}

}  // namespace

int main(int argc, char** argv) {
  openvdb::initialize();
  Parameters parameters;
  return cellocut::peers::run_peer(
      argc, argv, "peer_thicken", "OpenVDB's thickening of a mesh.",
      [&](CLI::App& program) {
        program
            .add_option("-R,--resolution", parameters.resolution,
                        "Voxels along the longest edge of the box")
            ->check(CLI::Range(8, 16384))
            ->capture_default_str();
        program
            .add_option("--offset", parameters.offset,
                        "Distance of the surface from the input, in voxels")
            ->check(CLI::Range(0.25, 64.0))
            ->capture_default_str();
      },
      [&](const cellocut::TriangleSoup& input) { return thicken(input, parameters); });
}
