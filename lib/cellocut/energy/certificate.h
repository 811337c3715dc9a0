// A proof that a labelling is a minimum of the energy, and that the two canonical labellings are
// the smallest and the largest interior of all minima. It is checked here by code that shares
// nothing with the solvers, the contraction of anchored cells or the lifting of the flow: the
// checker walks the complex itself, recomputes every area and every capacity, and adds in 128 bits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cellocut/complex/tet_complex.h"
#include "cellocut/energy/energy.h"
#include "cellocut/energy/guidance.h"

namespace cellocut {

struct CertificateCheck {
  std::string name;  // stable, snake_case
  bool passed = false;
  std::string detail;  // the figures compared, or where it fails first
};

struct CertificateReport {
  bool valid = false;  // every check passed
  std::vector<CertificateCheck> checks;
};

// What is claimed, and the witness.
struct CertificateClaim {
  const TetComplex& complex;
  const CellLabels& initial;  // L*
  ExteriorMode mode;
  Rational lambda;
  double unit;  // length of one relative unit, in input units
  int area_bits;
  // Per facet, in the order ascending by (lower cell, corner) as list_facets has it: net flow from
  // the facet's cell of lower index to the other (or out of the hull), in integer units.
  const std::vector<std::int64_t>& facet_flow;
  std::int64_t value;  // the claimed minimum, of the whole complex, in integer units
  const CellLabels& smallest_interior;
  const CellLabels& largest_interior;
  bool unary = true;        // false: no cell is anchored interior, L* only sets weights
  GuidedCells guided = {};  // fixed by the user's points, besides the others
  // Per facet, in quanta: its supported area, where that does not follow from L*. Taken as given.
  const std::vector<std::int64_t>* supported = nullptr;
};

// Checks, in this order, each reported by name:
//   sizes                      arrays match the complex
//   capacities                 |flow| <= capacity at every facet
//   conservation               zero net flow at every free cell
//   anchors                    both labellings keep the interior anchors and the exterior ones
//   smallest_energy, largest_energy   each labelling costs `value`
//   flow_value                 net flow out of the interior anchors == `value`
//   smallest_canonical, largest_canonical   equal the residual reachability of this flow
// Never throws for a wrong claim; a later check is reported as not passed where an earlier one
// makes it meaningless. O(cells).
CertificateReport check_certificate(const CertificateClaim& claim);

}  // namespace cellocut
