// The tree behind a SparseField (OpenVDB). Included by the few source files that build or walk
// fields, never by a public header.
#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>

#include "cellocut/base/point.h"
#include "cellocut/field/sparse_field.h"

namespace cellocut {

using FieldTree = openvdb::FloatTree;
using FieldLeaf = FieldTree::LeafNodeType;
inline constexpr int kLeafEdge = FieldLeaf::DIM;  // 8

// Values in grid steps. Active values are those of the band; every other value is +kBand or -kBand.
struct SparseField::Grid {
  FieldTree tree{kBand};
};

// Trilinear interpolation with an accessor of its own; one per thread.
class FieldSampler {
 public:
  explicit FieldSampler(const SparseField& field) : accessor_(field.grid().tree) {}

  double operator()(const Point3& p) {
    const openvdb::Coord o(floor(p[0]), floor(p[1]), floor(p[2]));
    const double x = p[0] - o.x();
    const double y = p[1] - o.y();
    const double z = p[2] - o.z();
    constexpr int kLast = kLeafEdge - 1;
    // Along which axes the cell of the grid reaches into another leaf.
    const bool over_x = (o.x() & kLast) == kLast;
    const bool over_y = (o.y() & kLast) == kLast;
    const bool over_z = (o.z() & kLast) == kLast;
    if (!over_x && !over_y && !over_z) {
      const FieldLeaf* leaf = accessor_.probeConstLeaf(o);
      if (leaf == nullptr) return accessor_.getValue(o);  // a tile has one value
      const float* values = leaf->buffer().data() + FieldLeaf::coordToOffset(o);
      return interpolate(x, y, z, [&](int dx, int dy, int dz) {
        return values[(dx * kLeafEdge + dy) * kLeafEdge + dz];
      });
    }
    std::array<float, 8> corner;
    for (int lx = 0; lx <= (over_x ? 1 : 0); ++lx) {
      for (int ly = 0; ly <= (over_y ? 1 : 0); ++ly) {
        for (int lz = 0; lz <= (over_z ? 1 : 0); ++lz) {
          read_corners(o, {lx, ly, lz}, {over_x ? lx : 1, over_y ? ly : 1, over_z ? lz : 1},
                       corner);
        }
      }
    }
    return interpolate(x, y, z,
                       [&](int dx, int dy, int dz) { return corner[(dx * 2 + dy) * 2 + dz]; });
  }

 private:
  // Reads the corners of the cell at o from `first` to `last`, which lie in one leaf.
  void read_corners(const openvdb::Coord& o, const std::array<int, 3>& first,
                    const std::array<int, 3>& last, std::array<float, 8>& corner) {
    const openvdb::Coord begin = o.offsetBy(first[0], first[1], first[2]);
    const FieldLeaf* leaf = accessor_.probeConstLeaf(begin);
    const float tile = leaf == nullptr ? accessor_.getValue(begin) : 0.0F;
    const float* values =
        leaf == nullptr ? nullptr : leaf->buffer().data() + FieldLeaf::coordToOffset(begin);
    for (int dx = first[0]; dx <= last[0]; ++dx) {
      for (int dy = first[1]; dy <= last[1]; ++dy) {
        for (int dz = first[2]; dz <= last[2]; ++dz) {
          corner[(dx * 2 + dy) * 2 + dz] =
              values == nullptr ? tile
                                : values[((dx - first[0]) * kLeafEdge + dy - first[1]) * kLeafEdge +
                                         dz - first[2]];
        }
      }
    }
  }

  // As std::floor, which is a call where the processor's rounding may not be used.
  static int floor(double x) {
    const int towards_zero = static_cast<int>(x);
    return towards_zero - (x < towards_zero ? 1 : 0);
  }
  template <class Corner>
  static double interpolate(double x, double y, double z, const Corner& corner) {
    const auto edge = [&](int dy, int dz) {
      const double a = corner(0, dy, dz);
      const double b = corner(1, dy, dz);
      return a + x * (b - a);
    };
    const double y0 = edge(0, 0) + y * (edge(1, 0) - edge(0, 0));
    const double y1 = edge(0, 1) + y * (edge(1, 1) - edge(0, 1));
    return y0 + z * (y1 - y0);
  }

  openvdb::tree::ValueAccessor<const FieldTree> accessor_;
};

}  // namespace cellocut
