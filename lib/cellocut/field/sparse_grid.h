// The tree behind a SparseField (OpenVDB). Included by the few source files that build or walk
// fields, never by a public header.
#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>

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
    const bool one_leaf =
        (o.x() & kLast) != kLast && (o.y() & kLast) != kLast && (o.z() & kLast) != kLast;
    if (!one_leaf) {
      return interpolate(x, y, z, [&](int dx, int dy, int dz) {
        return accessor_.getValue(o.offsetBy(dx, dy, dz));
      });
    }
    const FieldLeaf* leaf = accessor_.probeConstLeaf(o);
    if (leaf == nullptr) return accessor_.getValue(o);  // a tile has one value
    const float* values = leaf->buffer().data() + FieldLeaf::coordToOffset(o);
    return interpolate(x, y, z, [&](int dx, int dy, int dz) {
      return values[(dx * kLeafEdge + dy) * kLeafEdge + dz];
    });
  }

 private:
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
