// The fill path of a tetrahedral complex: which cells are interior in which labelling.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/complex/tet_complex.h"
#include "cellocut/energy/cell_graph.h"
#include "cellocut/path/fill_path.h"

namespace cellocut {

// `graph`: of the same facets and areas, at any lambda; it says which cells have a node. Nested
// where support is by labels and cells with an interior L* are anchored (else supported facets
// would lie between free cells). O(facets).
ParametricProblem make_parametric_problem(const CellGraph& graph, const FacetList& facets,
                                          const FacetAreas& areas);

struct CellPath {
  FillPath path;
  // Per cell as FillPath::level per node; cells that are interior in every minimum have the
  // highest. Empty, as the flow is, where minima are not nested.
  std::vector<std::uint32_t> level;
  std::vector<Wide> facet_flow;  // FillPath::zone_flow, per facet
  // Where minima are not nested: per labelling, which cells are interior.
  std::vector<std::vector<bool>> interior;

  [[nodiscard]] std::size_t count() const { return path.areas.size(); }
  // Whether labelling k, below count(), has the cell inside.
  [[nodiscard]] bool holds(std::size_t k, std::size_t cell) const {
    return path.nested ? level[cell] > k : interior[k][cell];
  }
  // Labelling k, below count(). O(cells).
  [[nodiscard]] CellLabels labels(std::size_t k) const;
};

// As find_fill_path() on the problem of the cells, with its errors. The witness sees flows per
// facet, of those between free cells; the others have 0.
CellPath find_cell_path(const CellGraph& graph, const FacetList& facets, const FacetAreas& areas,
                        const Lambda& first, const Lambda& last, CutSolver& solver,
                        Observer& observer, const FlowWitness& witness = {});

// The solid of a labelling.
struct PathSolid {
  double volume = 0;            // of the interior cells, cubed input units
  std::int64_t cells = 0;       // interior
  std::int64_t components = 0;  // of interior cells, joined through facets
};
// By labelling. O(cells log cells) where they are nested, as each adds cells to the one after it;
// else that for each labelling, in parallel.
std::vector<PathSolid> path_solids(const TetComplex& complex, const CellPath& path);

}  // namespace cellocut
