#include "cellocut/path/cell_path.h"

#include <tbb/parallel_for.h>

#include <numeric>

#include "cellocut/base/disjoint_sets.h"

namespace cellocut {

ParametricProblem make_parametric_problem(const CellGraph& graph, const FacetList& facets,
                                          const FacetAreas& areas) {
  const std::size_t nodes = graph.problem.node_count();
  ParametricProblem problem;
  problem.to_source.resize(nodes);
  problem.to_sink.resize(nodes);
  problem.edges.reserve(graph.problem.edges.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const Facet& facet = facets[f];
    const bool hull = facet.other == kOutside;
    const InterfaceAreas both{areas.supported[f], areas.quantised[f] - areas.supported[f]};
    const std::int32_t a = graph.node_of_cell[facet.cell];
    const std::int32_t b = hull ? -1 : graph.node_of_cell[static_cast<std::size_t>(facet.other)];
    const std::uint8_t label_a = graph.decided[facet.cell];
    const std::uint8_t label_b =
        hull ? kExterior : graph.decided[static_cast<std::size_t>(facet.other)];
    if (a >= 0 && b >= 0) {
      problem.edges.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), both});
    } else if (a >= 0 || b >= 0) {
      const auto node = static_cast<std::size_t>(a >= 0 ? a : b);
      const std::uint8_t decided = a >= 0 ? label_b : label_a;
      (decided == kInterior ? problem.to_source : problem.to_sink)[node] += both;
    } else if (label_a != label_b) {
      problem.constant += both;
    }
  }
  return problem;
}

CellLabels CellPath::labels(std::size_t k) const {
  CellLabels labels(path.nested ? level.size() : interior[k].size());
  for (std::size_t c = 0; c < labels.size(); ++c) {
    labels[c] = holds(k, c) ? kInterior : kExterior;
  }
  return labels;
}

CellPath find_cell_path(const CellGraph& graph, const FacetList& facets, const FacetAreas& areas,
                        const Lambda& first, const Lambda& last, CutSolver& solver,
                        Observer& observer, const FlowWitness& witness) {
  const auto by_facet = [&](const std::vector<Wide>& edge_flow) {
    std::vector<Wide> facet_flow(facets.size(), 0);
    for (std::size_t e = 0; e < edge_flow.size(); ++e) {
      facet_flow[graph.edge_facet[e]] = edge_flow[e];
    }
    return facet_flow;
  };
  FlowWitness facet_witness;
  if (witness) {
    facet_witness = [&](const Lambda& lambda, const std::vector<Wide>& edge_flow) {
      witness(lambda, by_facet(edge_flow));
    };
  }
  CellPath result;
  result.path = find_fill_path(make_parametric_problem(graph, facets, areas), first, last, solver,
                               observer, facet_witness);
  if (!result.path.nested) {
    for (std::vector<bool>& nodes : result.path.source_side) {
      std::vector<bool> cells(graph.node_of_cell.size());
      for (std::size_t c = 0; c < cells.size(); ++c) {
        const std::int32_t node = graph.node_of_cell[c];
        cells[c] =
            node >= 0 ? nodes[static_cast<std::size_t>(node)] : graph.decided[c] == kInterior;
      }
      result.interior.push_back(std::move(cells));
      nodes = {};
    }
    return result;
  }
  const auto highest = static_cast<std::uint32_t>(result.count());
  result.level.resize(graph.node_of_cell.size());
  for (std::size_t c = 0; c < result.level.size(); ++c) {
    const std::int32_t node = graph.node_of_cell[c];
    if (node >= 0) {
      result.level[c] = result.path.level[static_cast<std::size_t>(node)];
    } else {
      result.level[c] = graph.decided[c] == kInterior ? highest : 0;
    }
  }
  result.facet_flow = by_facet(result.path.zone_flow);
  return result;
}

namespace {

PathSolid solid_of(const TetComplex& complex, const std::vector<bool>& interior) {
  PathSolid solid;
  DisjointSets sets(interior.size());
  for (std::uint32_t c = 0; c < interior.size(); ++c) {
    if (!interior[c]) continue;
    solid.volume += cell_volume(complex, c);
    ++solid.cells;
    ++solid.components;
    for (const std::int32_t other : complex.neighbours[c]) {
      if (other == kOutside || other > static_cast<std::int32_t>(c)) continue;
      const auto d = static_cast<std::uint32_t>(other);
      if (interior[d] && sets.join(c, d)) --solid.components;
    }
  }
  return solid;
}

}  // namespace

std::vector<PathSolid> path_solids(const TetComplex& complex, const CellPath& path) {
  if (!path.path.nested) {
    std::vector<PathSolid> solids(path.count());
    tbb::parallel_for(std::size_t{0}, solids.size(),
                      [&](std::size_t k) { solids[k] = solid_of(complex, path.interior[k]); });
    return solids;
  }
  const std::size_t cells = path.level.size();
  // Cells by level, the highest first.
  std::vector<std::size_t> row(path.count() + 2, 0);
  for (const std::uint32_t level : path.level) ++row[level + 1];
  std::partial_sum(row.begin(), row.end(), row.begin());
  std::vector<std::uint32_t> order(cells);
  std::vector<std::size_t> next(row.begin(), row.end() - 1);
  for (std::uint32_t c = 0; c < cells; ++c) order[next[path.level[c]]++] = c;

  DisjointSets sets(cells);
  std::vector<PathSolid> solids(path.count());
  PathSolid solid;
  for (std::size_t k = path.count(); k-- > 0;) {
    const auto level = static_cast<std::uint32_t>(k + 1);
    for (std::size_t n = row[level]; n < row[level + 1]; ++n) {
      const std::uint32_t c = order[n];
      solid.volume += cell_volume(complex, c);
      ++solid.cells;
      ++solid.components;
      for (const std::int32_t other : complex.neighbours[c]) {
        if (other == kOutside) continue;
        const auto d = static_cast<std::uint32_t>(other);
        // Those of this level that are yet to come find this one.
        if (path.level[d] < level || (path.level[d] == level && d > c)) continue;
        if (sets.join(c, d)) --solid.components;
      }
    }
    solids[k] = solid;
  }
  return solids;
}

}  // namespace cellocut
