#include "cellocut/path/parametric_problem.h"

#include <numeric>
#include <stdexcept>

namespace cellocut {

bool operator<(const Lambda& a, const Lambda& b) { return Wide{a.p} * b.q < Wide{b.p} * a.q; }
bool operator==(const Lambda& a, const Lambda& b) { return Wide{a.p} * b.q == Wide{b.p} * a.q; }

double to_double(const Lambda& lambda) {
  return static_cast<double>(lambda.p) / static_cast<double>(lambda.q);
}

Wide cost_at(const InterfaceAreas& areas, const Lambda& lambda) {
  return Wide{lambda.q} * areas.supported + Wide{lambda.p} * areas.unsupported;
}

Lambda crossing(const InterfaceAreas& a, const InterfaceAreas& b) {
  const std::int64_t gained = b.supported - a.supported;
  const std::int64_t lost = a.unsupported - b.unsupported;
  if (gained <= 0 || lost <= 0) {
    throw std::logic_error("fill path: neighbouring labellings do not trade areas");
  }
  const std::int64_t common = std::gcd(gained, lost);
  return {gained / common, lost / common};
}

InterfaceAreas areas_of(const ParametricProblem& problem, const CutLabels& source_side) {
  InterfaceAreas areas = problem.constant;
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    if (source_side[i] != 0) {
      areas.unsupported += problem.unsupported_sink[i];
    } else {
      areas.supported += problem.supported[i];
      areas.unsupported += problem.unsupported_source[i];
    }
  }
  for (const ParametricProblem::Edge& edge : problem.edges) {
    if (source_side[edge.from] != source_side[edge.to]) areas.unsupported += edge.area;
  }
  return areas;
}

WideProblem at_lambda(const ParametricProblem& problem, const Lambda& lambda) {
  const Wide p = lambda.p;
  const Wide q = lambda.q;
  WideProblem result;
  result.constant = cost_at(problem.constant, lambda);
  result.to_source.resize(problem.node_count());
  result.to_sink.resize(problem.node_count());
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    result.to_source[i] = q * problem.supported[i] + p * problem.unsupported_source[i];
    result.to_sink[i] = p * problem.unsupported_sink[i];
  }
  result.edges.reserve(problem.edges.size());
  for (const ParametricProblem::Edge& edge : problem.edges) {
    result.edges.push_back({edge.from, edge.to, p * edge.area});
  }
  return result;
}

Piece contract(const Piece& piece, const CutLabels& lower, const CutLabels& upper) {
  constexpr std::uint32_t kInside = 0xFFFFFFFEU;
  constexpr std::uint32_t kOut = 0xFFFFFFFFU;
  const ParametricProblem& whole = piece.problem;
  Piece result;
  ParametricProblem& part = result.problem;
  part.constant = whole.constant;
  std::vector<std::uint32_t> place(whole.node_count());
  for (std::uint32_t i = 0; i < whole.node_count(); ++i) {
    if (lower[i] != 0 && upper[i] == 0) throw std::logic_error("fill path: cuts are not nested");
    if (lower[i] != 0) {
      place[i] = kInside;
      part.constant.unsupported += whole.unsupported_sink[i];
    } else if (upper[i] == 0) {
      place[i] = kOut;
      part.constant.supported += whole.supported[i];
      part.constant.unsupported += whole.unsupported_source[i];
    } else {
      place[i] = static_cast<std::uint32_t>(result.node.size());
      result.node.push_back(piece.node[i]);
      part.supported.push_back(whole.supported[i]);
      part.unsupported_source.push_back(whole.unsupported_source[i]);
      part.unsupported_sink.push_back(whole.unsupported_sink[i]);
    }
  }
  for (std::size_t e = 0; e < whole.edges.size(); ++e) {
    const ParametricProblem::Edge& edge = whole.edges[e];
    const std::uint32_t a = place[edge.from];
    const std::uint32_t b = place[edge.to];
    if (a < kInside && b < kInside) {
      part.edges.push_back({a, b, edge.area});
      result.edge.push_back(piece.edge[e]);
    } else if (a < kInside || b < kInside) {
      const std::uint32_t node = a < kInside ? a : b;
      const std::uint32_t other = a < kInside ? b : a;
      (other == kInside ? part.unsupported_source : part.unsupported_sink)[node] += edge.area;
    } else if (a != b) {
      part.constant.unsupported += edge.area;
    }
  }
  return result;
}

}  // namespace cellocut
