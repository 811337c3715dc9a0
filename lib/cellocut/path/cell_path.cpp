#include "cellocut/path/cell_path.h"

#include <numeric>

namespace cellocut {

ParametricProblem make_parametric_problem(const CellGraph& graph, const FacetList& facets,
                                          const FacetAreas& areas, const CellLabels& initial) {
  const std::size_t nodes = graph.problem.node_count();
  ParametricProblem problem;
  problem.supported.assign(nodes, 0);
  problem.unsupported_source.assign(nodes, 0);
  problem.unsupported_sink.assign(nodes, 0);
  problem.edges.reserve(graph.problem.edges.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const Facet& facet = facets[f];
    const bool hull = facet.other == kOutside;
    const std::int64_t area = areas.quantised[f];
    const bool supported = is_supported(facet, initial);
    const std::int32_t a = graph.node_of_cell[facet.cell];
    const std::int32_t b = hull ? -1 : graph.node_of_cell[static_cast<std::size_t>(facet.other)];
    const std::uint8_t label_a = graph.decided[facet.cell];
    const std::uint8_t label_b =
        hull ? kExterior : graph.decided[static_cast<std::size_t>(facet.other)];
    if (a >= 0 && b >= 0) {
      problem.edges.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), area});
    } else if (a >= 0 || b >= 0) {
      const auto node = static_cast<std::size_t>(a >= 0 ? a : b);
      if ((a >= 0 ? label_b : label_a) == kExterior) {
        problem.unsupported_sink[node] += area;
      } else {
        (supported ? problem.supported : problem.unsupported_source)[node] += area;
      }
    } else if (label_a != label_b) {
      (supported ? problem.constant.supported : problem.constant.unsupported) += area;
    }
  }
  return problem;
}

CellLabels CellPath::labels(std::size_t k) const {
  CellLabels labels(level.size());
  for (std::size_t c = 0; c < labels.size(); ++c) {
    labels[c] = level[c] > k ? kInterior : kExterior;
  }
  return labels;
}

CellPath find_cell_path(const CellGraph& graph, const FacetList& facets, const FacetAreas& areas,
                        const CellLabels& initial, const Lambda& first, const Lambda& last,
                        CutSolver& solver, Observer& observer) {
  CellPath result;
  result.path = find_fill_path(make_parametric_problem(graph, facets, areas, initial), first, last,
                               solver, observer);
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
  result.facet_flow.assign(facets.size(), 0);
  for (std::size_t e = 0; e < graph.edge_facet.size(); ++e) {
    result.facet_flow[graph.edge_facet[e]] = result.path.zone_flow[e];
  }
  return result;
}

std::vector<PathSolid> path_solids(const TetComplex& complex, const CellPath& path) {
  const std::size_t cells = path.level.size();
  // Cells by level, the highest first.
  std::vector<std::size_t> row(path.count() + 2, 0);
  for (const std::uint32_t level : path.level) ++row[level + 1];
  std::partial_sum(row.begin(), row.end(), row.begin());
  std::vector<std::uint32_t> order(cells);
  std::vector<std::size_t> next(row.begin(), row.end() - 1);
  for (std::uint32_t c = 0; c < cells; ++c) order[next[path.level[c]]++] = c;

  std::vector<std::uint32_t> parent(cells);
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&parent](std::uint32_t c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
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
        const std::uint32_t a = root(c);
        const std::uint32_t b = root(d);
        if (a == b) continue;
        parent[std::max(a, b)] = std::min(a, b);
        --solid.components;
      }
    }
    solids[k] = solid;
  }
  return solids;
}

}  // namespace cellocut
