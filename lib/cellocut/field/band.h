// The blocks of the grid that a band around a level set of the distance reaches, found by octree
// descent. Internal to the fields (OpenVDB types).
#pragma once

#include <memory>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/field/leaf_distances.h"
#include "cellocut/field/sparse_grid.h"
#include "cellocut/field/triangle_set.h"

namespace cellocut {

// A cube of grid points that the band does not reach.
struct Tile {
  openvdb::Coord low;
  int edge;  // in grid points, a power of two >= kLeafEdge
};

struct Band {
  std::vector<std::unique_ptr<FieldLeaf>> leaves;
  std::vector<Tile> inside;   // distance < offset throughout
  std::vector<Tile> outside;  // distance > offset throughout
};

// Covers the grid points [0, 2^k) of each axis, 2^k >= extent, with leaves and tiles. Leaves hold
// distance - offset in grid steps, rounded to odd multiples of 2^-15, active where below kBand in
// size and +-kBand elsewhere. In no particular order; the values are the same for any number of
// threads. Errors: Cancelled.
Band find_band(const std::vector<DistanceTriangle>& triangles, int extent, double offset,
               Observer& observer);

// A leaf that a band reaches, and which triangles can be closest to one of its points.
struct BandLeaf {
  openvdb::Coord low;
  LeafDistances::Candidates candidates;
};

// The leaves that find_band() fills at offset 0, by `low`.
std::vector<BandLeaf> list_band(const std::vector<DistanceTriangle>& triangles, int extent,
                                Observer& observer);

// The cubes between the leaves that begin at `leaves`: together they cover [0, 2^k)^3, 2^k >=
// extent. O(leaves * k).
std::vector<Tile> tiles_between(std::vector<openvdb::Coord> leaves, int extent);

// Sets the tile's grid points to an inactive -kBand.
void add_inside_tile(FieldTree& tree, const Tile& tile);

}  // namespace cellocut
