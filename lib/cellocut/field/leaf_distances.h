// Distances from triangles at the grid points of one leaf. Internal to the fields (OpenVDB types).
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <cstdint>
#include <vector>

#include "cellocut/field/sparse_grid.h"
#include "cellocut/field/triangle_set.h"

namespace cellocut {

// For each point of a leaf, in the order of its values, up to which value it is to be known, at
// most kBand; negative where it need not be known at all.
using LeafReach = std::array<float, FieldLeaf::SIZE>;

// Covers the rounding of distances in index coordinates (below 1e-9 for grids of up to 1e5 steps).
inline constexpr double kDistanceSlack = 1e-7;

class LeafDistances {
 public:
  using Candidates = std::vector<std::uint32_t>;  // into the triangles

  // The triangles must outlive this.
  LeafDistances(const std::vector<DistanceTriangle>& triangles, double offset)
      : triangles_(triangles), offset_(offset) {}

  // Stores distance - offset in grid steps, rounded to odd multiples of 2^-15, active where below
  // kBand in size and +-kBand elsewhere. The leaf comes with +kBand throughout; `candidates` are
  // all that can be closest to one of its points. What lies beyond its reach may stay at +kBand.
  // May be called from several threads. O(points x candidates) at worst.
  void fill(FieldLeaf& leaf, const Candidates& candidates, const LeafReach* reach = nullptr);

 private:
  class PartReach;
  // Scratch space for the parts of one edge length.
  struct Workspace {
    std::vector<Eight> squared;  // distances of a candidate from the centres of the parts
    Candidates narrowed;
  };

  void fill_part(FieldLeaf& leaf, const openvdb::Coord& low, int edge, const Candidates& candidates,
                 const PartReach* part_reach, Workspace* workspace) const;
  void set(FieldLeaf& leaf, const openvdb::Coord& at, double distance) const;

  const std::vector<DistanceTriangle>& triangles_;
  double offset_;
  // One per thread; the levels within a leaf are three.
  tbb::enumerable_thread_specific<std::array<Workspace, 3>> workspaces_;
};

}  // namespace cellocut
