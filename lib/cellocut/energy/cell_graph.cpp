#include "cellocut/energy/cell_graph.h"

#include <algorithm>
#include <string>

#include "cellocut/base/errors.h"
#include "cellocut/cut/cut_solver.h"

namespace cellocut {

namespace {

__extension__ using Wide = __int128;

Anchor anchor_beyond(const std::vector<Anchor>& anchors, std::int32_t other) {
  return other == kOutside ? Anchor::exterior : anchors[other];
}

// The free cells that an exterior anchor (or the outside) reaches through free cells.
std::vector<std::uint8_t> reached_from_outside(const TetComplex& complex,
                                               const std::vector<Anchor>& anchors) {
  std::vector<std::uint8_t> reached(anchors.size(), 0);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t c = 0; c < anchors.size(); ++c) {
    if (anchors[c] != Anchor::free) continue;
    for (const std::int32_t other : complex.neighbours[c]) {
      if (reached[c] == 0 && anchor_beyond(anchors, other) == Anchor::exterior) {
        reached[c] = 1;
        stack.push_back(c);
      }
    }
  }
  while (!stack.empty()) {
    const std::uint32_t c = stack.back();
    stack.pop_back();
    for (const std::int32_t other : complex.neighbours[c]) {
      if (other != kOutside && anchors[other] == Anchor::free && reached[other] == 0) {
        reached[other] = 1;
        stack.push_back(static_cast<std::uint32_t>(other));
      }
    }
  }
  return reached;
}

void check_range(const FacetAreas& areas, const Rational& lambda) {
  Wide supported = 0;
  Wide all = 0;
  for (std::size_t f = 0; f < areas.quantised.size(); ++f) {
    supported += areas.supported[f];
    all += areas.quantised[f];
  }
  // Both directions of every facet bound all sums that a problem made of them can contain.
  const Wide sum = 2 * (supported * lambda.denominator + (all - supported) * lambda.numerator);
  if (sum >= Wide{kCapacityLimit}) {
    throw LimitError("the capacities sum to 2^62 or more with lambda_fill = " + to_string(lambda) +
                     "; lower --area-bits, or choose lambda with smaller terms");
  }
}

}  // namespace

CellGraph build_cell_graph(const TetComplex& complex, const FacetList& facets,
                           const FacetAreas& areas, const std::vector<Anchor>& anchors,
                           const Rational& lambda) {
  check_range(areas, lambda);
  CellGraph graph;
  graph.node_of_cell.assign(anchors.size(), -1);
  graph.decided.assign(anchors.size(), kExterior);
  const std::vector<std::uint8_t> reached = reached_from_outside(complex, anchors);
  std::int32_t nodes = 0;
  for (std::size_t c = 0; c < anchors.size(); ++c) {
    if (anchors[c] == Anchor::interior) {
      graph.decided[c] = kInterior;
      ++graph.anchored_cells;
    } else if (anchors[c] == Anchor::exterior) {
      ++graph.anchored_cells;
    } else if (reached[c] == 0) {
      graph.decided[c] = kInterior;
      ++graph.enclosed_cells;
    } else {
      graph.node_of_cell[c] = nodes++;
    }
  }
  CutProblem& problem = graph.problem;
  problem.to_source.assign(nodes, 0);
  problem.to_sink.assign(nodes, 0);
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    const Facet& facet = facets[f];
    const std::int64_t capacity = facet_capacity(areas, f, lambda);
    const std::int32_t a = graph.node_of_cell[facet.cell];
    const std::int32_t b = facet.other == kOutside ? -1 : graph.node_of_cell[facet.other];
    const std::uint8_t label_a = graph.decided[facet.cell];
    const std::uint8_t label_b = facet.other == kOutside ? kExterior : graph.decided[facet.other];
    if (a >= 0 && b >= 0) {
      problem.edges.push_back(
          {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), capacity, capacity});
      graph.edge_facet.push_back(f);
    } else if (a >= 0) {
      (label_b == kInterior ? problem.to_source : problem.to_sink)[a] += capacity;
    } else if (b >= 0) {
      (label_a == kInterior ? problem.to_source : problem.to_sink)[b] += capacity;
    } else if (label_a != label_b) {
      problem.constant += capacity;
    }
  }
  return graph;
}

CellLabels expand_labels(const CellGraph& graph, const CutLabels& source_side) {
  CellLabels labels = graph.decided;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    const std::int32_t node = graph.node_of_cell[c];
    if (node >= 0) labels[c] = source_side[node] != 0 ? kInterior : kExterior;
  }
  return labels;
}

std::vector<std::int64_t> lift_flow(const CellGraph& graph, const FacetList& facets,
                                    const FacetAreas& areas, const std::vector<Anchor>& anchors,
                                    const Rational& lambda,
                                    const std::vector<std::int64_t>& edge_flow) {
  const CutProblem& problem = graph.problem;
  const std::vector<std::int64_t> out = node_balances(problem, edge_flow);
  std::vector<std::int64_t> from_source(out.size());
  std::vector<std::int64_t> to_sink(out.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const TerminalFlow flow = terminal_flow(problem.to_source[i], problem.to_sink[i], out[i]);
    from_source[i] = flow.from_source;
    to_sink[i] = flow.to_sink;
  }
  std::vector<std::int64_t> facet_flow(facets.size(), 0);
  for (std::size_t e = 0; e < edge_flow.size(); ++e) facet_flow[graph.edge_facet[e]] = edge_flow[e];
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const Facet& facet = facets[f];
    const std::int64_t capacity = facet_capacity(areas, f, lambda);
    const Anchor beyond = anchor_beyond(anchors, facet.other);
    const Anchor here = anchors[facet.cell];
    const std::int32_t node_here = graph.node_of_cell[facet.cell];
    const std::int32_t node_beyond = facet.other == kOutside ? -1 : graph.node_of_cell[facet.other];
    // What the facet carries from the interior anchor (or to the exterior one) of its one end.
    const auto take = [capacity](std::int64_t& left) {
      const std::int64_t flow = std::min(capacity, left);
      left -= flow;
      return flow;
    };
    if (node_here >= 0 && node_beyond < 0) {
      if (beyond == Anchor::interior) facet_flow[f] = -take(from_source[node_here]);
      if (beyond == Anchor::exterior) facet_flow[f] = take(to_sink[node_here]);
    } else if (node_here < 0 && node_beyond >= 0) {
      if (here == Anchor::interior) facet_flow[f] = take(from_source[node_beyond]);
      if (here == Anchor::exterior) facet_flow[f] = -take(to_sink[node_beyond]);
    } else if (here == Anchor::interior && beyond == Anchor::exterior) {
      facet_flow[f] = capacity;
    } else if (here == Anchor::exterior && beyond == Anchor::interior) {
      facet_flow[f] = -capacity;
    }
  }
  return facet_flow;
}

}  // namespace cellocut
