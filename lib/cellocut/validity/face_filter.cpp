#include "cellocut/validity/face_filter.h"

#include <algorithm>
#include <cmath>

#include "cellocut/validity/certain_side.h"

namespace cellocut {

namespace {

// Of length between 0.57 and 1: which plane is tried may change what is proved, not the proof.
Point3 roughly_unit(const Point3& v) {
  return (1 / (std::fabs(v[0]) + std::fabs(v[1]) + std::fabs(v[2]))) * v;
}

}  // namespace

CertainPlane::CertainPlane(const Point3& a, const Point3& b, const Point3& c) : corner_(a) {
  const Point3 u = b - a;
  const Point3 v = c - a;
  normal_ = cross(u, v);
  for (int axis = 0; axis < 3; ++axis) {
    reach_[axis] = std::max(std::fabs(u[axis]), std::fabs(v[axis]));
  }
}

// 1 above, -1 below, 0 where it is not certain.
int CertainPlane::certain_side(const Point3& p) const {
  const Point3 w = p - corner_;
  const double height = dot(normal_, w);
  // The determinant (u, v, w) has six products of three differences. Each difference is off by one
  // rounding, each product by two more, and four sums follow: below 10 u times each product, where
  // u is the unit roundoff, so below 60 u (reach x reach x reach) in all. Twice that is asked for.
  double bound = 120 * kUnitRoundoff;
  double far = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = std::max(reach_[axis], std::fabs(w[axis]));
    bound *= reach;
    far = std::max(far, reach);
  }
  // Products that underflow add less than 1e-322 far to the error: the normal's are multiplied by
  // w. (Where one overflows, the height is infinite or no number, but the bound need not be.)
  if (!(std::fabs(height) > bound) || !(bound > 1e-250 * far) || !std::isfinite(height)) return 0;
  return height > 0 ? 1 : -1;
}

bool CertainPlane::certainly_beside(const std::array<Point3, 3>& points, int count) const {
  const int side = certain_side(points[0]);
  if (side == 0) return false;
  for (int i = 1; i < count; ++i) {
    if (certain_side(points[i]) != side) return false;
  }
  return true;
}

PreparedFace::PreparedFace(const std::vector<Point3>& points, const Triangle& face)
    : corners_(face),
      point_{points[face[0]], points[face[1]], points[face[2]]},
      plane_(point_[0], point_[1], point_[2]),
      centroid_((1.0 / 3) * ((point_[0] + point_[1]) + point_[2])) {}

bool PreparedFace::certainly_apart(const std::vector<Point3>& points, const Triangle& t) const {
  // Corners of t that are not corners of this face, and corners of this face that are not of t.
  std::array<Point3, 3> others;
  int count = 0;
  unsigned shared = 0;  // of this face, by bits
  for (const std::uint32_t corner : t) {
    const unsigned match = (corner == corners_[0] ? 1U : 0U) | (corner == corners_[1] ? 2U : 0U) |
                           (corner == corners_[2] ? 4U : 0U);
    if (match == 0) others[count++] = points[corner];
    shared |= match;
  }
  if (count == 0) return false;

  // First the plane of this face, and of two that have no corner in common of the other one: where
  // the sides of a sheet bend, the outer face has the inner one behind it.
  if (plane_.certainly_beside(others, count)) return true;
  if (count == 3) {
    if (CertainPlane(others[0], others[1], others[2]).certainly_beside(point_, 3)) return true;
    // A plane across the way from one to the other.
    const Point3 centroid = (1.0 / 3) * ((others[0] + others[1]) + others[2]);
    const Point3 way = centroid - centroid_;
    if (separated(centroid_ + 0.5 * way, way, -1, others, count)) return true;
  } else if (count == 2) {
    const int c = shared == 1 ? 0 : (shared == 2 ? 1 : 2);
    const Point3& corner = point_[c];
    const Point3 here =
        roughly_unit(point_[(c + 1) % 3] - corner) + roughly_unit(point_[(c + 2) % 3] - corner);
    const Point3 there = roughly_unit(others[0] - corner) + roughly_unit(others[1] - corner);
    if (separated(corner, there - here, c, others, count)) return true;
  }
  // The common edge, seen along an axis.
  if (count == 1) return across_edge(shared == 6 ? 0 : (shared == 5 ? 1 : 2), others[0]);
  // In one plane, as many of a flat part are.
  const int c = count == 3 ? -1 : (shared == 1 ? 0 : (shared == 2 ? 1 : 2));
  return across_any_side(c, others, count);
}

// Whether this face's corners, but for the one given, lie strictly behind the plane and the others
// strictly before it. (The corner given, if any, is the point that the plane goes through.)
bool PreparedFace::separated(const Point3& through, const Point3& normal, int corner,
                             const std::array<Point3, 3>& others, int count) const {
  for (int k = 0; k < 3; ++k) {
    if (k != corner && certain_side_of_plane(normal, through, point_[k]) >= 0) return false;
  }
  for (int i = 0; i < count; ++i) {
    if (certain_side_of_plane(normal, through, others[i]) <= 0) return false;
  }
  return true;
}

// Whether the edge opposite to corner `third` certainly has that corner on one side and p on the
// other, in a projection along an axis. Both triangles then meet in the edge alone: elsewhere their
// projections lie apart.
bool PreparedFace::across_edge(int third, const Point3& p) const {
  const Point3& a = point_[(third + 1) % 3];
  const Point3& b = point_[(third + 2) % 3];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (certain_side_of_line(a, b, point_[third], i, j) * certain_side_of_line(a, b, p, i, j) < 0)
      return true;
  }
  return false;
}

// Whether the line of a side, of this face or of the other one, certainly has this face on one side
// and the other one on the other, seen along the axis closest to this face's normal. They then meet
// on that line alone: nowhere, or in the common corner that the line goes through. `corner`: that
// corner of this face, or -1.
bool PreparedFace::across_any_side(int corner, const std::array<Point3, 3>& others,
                                   int count) const {
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::fabs(plane_.normal()[k]) > std::fabs(plane_.normal()[axis])) axis = k;
  }
  const int i = (axis + 1) % 3;
  const int j = (axis + 2) % 3;
  std::array<Point3, 3> that = others;
  if (count == 2) that[2] = point_[corner];
  const auto parts = [&](const std::array<Point3, 3>& face, int through,
                         const std::array<Point3, 3>& rest, int skipped) {
    for (int third = 0; third < 3; ++third) {
      if (third == through) continue;
      const Point3& a = face[(third + 1) % 3];
      const Point3& b = face[(third + 2) % 3];
      const int side = certain_side_of_line(a, b, face[third], i, j);
      bool apart = side != 0;
      for (int k = 0; k < 3 && apart; ++k) {
        apart = k == skipped || certain_side_of_line(a, b, rest[k], i, j) == -side;
      }
      if (apart) return true;
    }
    return false;
  };
  const int last = count == 2 ? 2 : -1;
  return parts(point_, corner, that, last) || parts(that, last, point_, corner);
}

}  // namespace cellocut
