// A proof that each labelling of a fill path is a minimum on its whole interval of lambda.
//
// Notation. Cells of one level are a zone. Level k + 1 is what labelling k holds and labelling k +
// 1 does not, and belongs to the breakpoint between them; level 0 belongs to the beginning of the
// range, the highest to its end. In units of 1 / lambda a facet costs its area where it is
// unsupported and mu = 1 / lambda times that where it is supported; let mu_z be that of a zone's
// breakpoint or end.
//
// The proof is a flow g of the free cells, each zone's part at the mu_z of that zone, with the
// facets between two zones saturated away from the higher level. Let it obey the capacities and be
// conserved; let each cell of a zone between draw mu_z s from the anchors, s being its supported
// area, and saturate its facets to exterior anchors; let cells of the highest level draw no more
// than that, and those of level 0 exactly that, and give any rest to the outside. Take a lambda of
// the range and any labelling with interior X. What X draws leaves through its boundary, so
//   A_u(X) >= sum over X of what is drawn, and
//   A_u(X) + mu A_s(X) >= mu S + sum over zones z of (mu_z - mu) s(X in z)
// up to the highest level, whose cells draw at most mu_end <= mu times their area. The right side
// is least where X holds the zones with mu_z < mu and not those with mu_z > mu, and there, as
// facets between zones are saturated, both sides are equal. So one flow proves every labelling at
// every lambda of the range. (A breakpoint lies in two intervals: both neighbours cost the same
// there, which is checked as well.)
//
// (Facets between a point that the user has put inside and free cells are not supported: they cost
// the same at every lambda, are drawn from as far as they go, and cancel.)
//
// Where support is measured on facets labellings are not nested, and this proof does not hold.
// There it takes a flow at each breakpoint and end of the range, of whose capacities at that lambda
// no labelling can cost less than the flow's bound: what facets between opposite anchors cost, and
// the sum over free cells of the lesser of what interior anchors give (the cost to be exterior) and
// what the exterior takes plus what the cell sends on (to be interior). Where that is what both
// neighbours cost, each labelling is a minimum at both ends of its interval, hence between them, as
// the least cost is concave in lambda.
//
// Anchors, areas, levels and flows are checked on the complex itself. With the solvers and the
// contraction of anchored cells this shares nothing; anchors of L* and quantised areas are those of
// energy.h.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cellocut/complex/tet_complex.h"
#include "cellocut/energy/certificate.h"
#include "cellocut/path/cell_path.h"

namespace cellocut {

// What a path is one of.
struct PathTerms {
  const TetComplex& complex;
  const CellLabels& initial;  // L*
  ExteriorMode mode;
  const GuidedCells& guided;  // fixed by the user's points
  double unit;                // length of one relative unit, in input units
  int area_bits;
  // As CertificateClaim::supported.
  const std::vector<std::int64_t>* supported = nullptr;
};

class PathChecker {
 public:
  // Derives facets, areas and anchors. Keeps references. O(cells). Never throws for wrong terms: no
  // path passes then.
  // Precondition: the complex is sound (as make_canonical leaves it).
  explicit PathChecker(const PathTerms& terms);

  // A flow at lambda, net per facet, of which those between free cells count, in units of
  // q supported + p unsupported. Keeps the bound that it proves; one that breaks a capacity proves
  // nothing. A FlowWitness of find_cell_path(). O(cells).
  void add_flow(const Lambda& lambda, const std::vector<Wide>& facet_flow);

  // Checks, in this order, each reported by name:
  //   sizes         arrays match the complex
  //   anchors       cells that are fixed keep their label in every labelling, and labellings are
  //                 said to be nested where the support makes them so
  //   areas         of each labelling, recomputed
  //   breakpoints   the range is the one asked for; ascending within it; both neighbours cost the
  //                 same there
  //   capacities    |flow| <= capacity within each zone
  //   conservation  what each free cell draws and passes on, as above
  // or, where labellings are not nested, in place of the last two:
  //   flows         at each breakpoint and end a flow was added whose bound is what both neighbours
  //                 cost
  // Never throws for a wrong path; a later check is not passed where an earlier one makes it
  // meaningless. O(cells + labellings); where not nested, O((cells + labellings) labellings).
  [[nodiscard]] CertificateReport check(const CellPath& path, const LambdaInterval& range) const;

 private:
  friend class PathCheck;

  [[nodiscard]] std::string find_areas();
  [[nodiscard]] std::string fix_cells();
  // As ParametricProblem::nested().
  [[nodiscard]] bool is_nested() const;
  [[nodiscard]] Anchor anchor(std::int32_t cell) const {
    return cell == kOutside ? Anchor::exterior : anchors_[static_cast<std::size_t>(cell)];
  }
  [[nodiscard]] InterfaceAreas areas_of(std::size_t f) const {
    return {areas_.supported[f], areas_.quantised[f] - areas_.supported[f]};
  }

  PathTerms terms_;
  FacetList facets_;
  FacetAreas areas_;
  std::vector<Anchor> anchors_;  // per cell
  std::string wrong_areas_;      // what is wrong with them, or nothing
  std::string wrong_anchors_;
  std::vector<std::pair<Lambda, Wide>> bounds_;
};

}  // namespace cellocut
