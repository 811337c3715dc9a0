// The cut problem of a labelled complex with its anchored cells contracted into the terminals, and
// the way back: labels and flow of the small problem as labels and flow of the whole complex.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_problem.h"
#include "cellocut/energy/energy.h"

namespace cellocut {

struct CellGraph {
  CutProblem problem;  // source side = interior; constant = facets between anchors
  std::vector<std::int32_t> node_of_cell;  // or -1 where the cell is decided without the solver
  CellLabels decided;                      // label of every cell that has no node
  std::vector<std::uint32_t> edge_facet;   // per edge: its facet
  std::int64_t anchored_cells = 0;         // contracted into a terminal
  std::int64_t enclosed_cells = 0;         // free, but every minimum cut has them inside
};

// As every facet has a capacity of at least 1, a component of free cells that reaches no exterior
// anchor borders interior anchors only and is interior in every minimum cut: it gets no node.
// Without anchors (`anchors` all free) the unbounded region is still exterior.
// Errors: LimitError where the sum of capacities reaches 2^62, naming --area-bits. O(cells).
CellGraph build_cell_graph(const TetComplex& complex, const FacetList& facets,
                           const FacetAreas& areas, const std::vector<Anchor>& anchors,
                           const Rational& lambda);

// Labels of all cells from the source side of the problem.
CellLabels expand_labels(const CellGraph& graph, const CutLabels& source_side);

// Flow of the problem as net flow per facet (from the cell of lower index to the other): edges as
// they are, terminal flow of a node split over its facets to anchored cells, facets between
// opposite anchors saturated.
std::vector<std::int64_t> lift_flow(const CellGraph& graph, const FacetList& facets,
                                    const FacetAreas& areas, const std::vector<Anchor>& anchors,
                                    const Rational& lambda,
                                    const std::vector<std::int64_t>& edge_flow);

}  // namespace cellocut
