// The contract of a tetrahedralization backend.
#pragma once

#include <string>
#include <vector>

#include "cellocut/complex/tet_complex.h"

namespace cellocut {

struct TetrahedralizerInfo {
  std::string name;
  std::string summary;    // one line for `cellocut list`
  std::string licence;    // SPDX
  std::string reference;  // what to cite
};

// Unconstrained Delaunay tetrahedralization of a point set.
class Tetrahedralizer {
 public:
  virtual ~Tetrahedralizer() = default;
  [[nodiscard]] virtual const TetrahedralizerInfo& info() const = 0;

  // The Delaunay complex of `points` in canonical form (tet_complex.h): its cells fill the convex
  // hull, every cell is positively oriented by exact predicates, every distinct point is a corner,
  // a duplicate maps to its first copy. Co-spherical ties are broken as the backend likes.
  // Errors: InputError for non-finite coordinates, for fewer than four distinct points and for
  // points that lie in one plane (decided exactly); Error for what the library behind it reports.
  [[nodiscard]] TetComplex tetrahedralize(std::vector<Point3> points) const;

 private:
  // Gets distinct points that span space; returns positively oriented quadruples of their indices.
  [[nodiscard]] virtual std::vector<std::array<std::uint32_t, 4>> do_tetrahedralize(
      const std::vector<Point3>& points) const = 0;
};

}  // namespace cellocut
