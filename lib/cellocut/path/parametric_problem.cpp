#include "cellocut/path/parametric_problem.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace cellocut {

bool operator<(const Lambda& a, const Lambda& b) { return Wide{a.p} * b.q < Wide{b.p} * a.q; }
bool operator==(const Lambda& a, const Lambda& b) { return Wide{a.p} * b.q == Wide{b.p} * a.q; }

double to_double(const Lambda& lambda) {
  return static_cast<double>(lambda.p) / static_cast<double>(lambda.q);
}

// The continued fraction of both, as far as they agree (Stern and Brocot's tree).
Lambda simplest_between(const Lambda& a, const Lambda& b) {
  const std::int64_t whole = a.p / a.q;
  if (Lambda{whole + 1, 1} < b) return {whole + 1, 1};
  // a < x < b, and b is at most the next integer: x = whole + 1 / y.
  const Lambda above{a.q, a.p - whole * a.q};  // 1 / (a - whole), where that is positive
  const Lambda below{b.q, b.p - whole * b.q};  // 1 / (b - whole)
  Lambda inverse;
  if (above.q == 0) {
    // a is an integer: y may be as large as it likes; the first integer above 1 / (b - whole).
    inverse = {below.p / below.q + 1, 1};
  } else {
    inverse = simplest_between(below, above);
  }
  return {whole * inverse.p + inverse.q, inverse.p};
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

bool ParametricProblem::nested() const {
  const auto unsupported = [](const InterfaceAreas& areas) { return areas.supported == 0; };
  return std::all_of(to_sink.begin(), to_sink.end(), unsupported) &&
         std::all_of(edges.begin(), edges.end(),
                     [&](const Edge& edge) { return unsupported(edge.areas); });
}

InterfaceAreas areas_of(const ParametricProblem& problem, const CutLabels& source_side) {
  InterfaceAreas areas = problem.constant;
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    areas += source_side[i] != 0 ? problem.to_sink[i] : problem.to_source[i];
  }
  for (const ParametricProblem::Edge& edge : problem.edges) {
    if (source_side[edge.from] != source_side[edge.to]) areas += edge.areas;
  }
  return areas;
}

WideProblem at_lambda(const ParametricProblem& problem, const Lambda& lambda) {
  WideProblem result;
  result.constant = cost_at(problem.constant, lambda);
  result.to_source.resize(problem.node_count());
  result.to_sink.resize(problem.node_count());
  for (std::size_t i = 0; i < problem.node_count(); ++i) {
    result.to_source[i] = cost_at(problem.to_source[i], lambda);
    result.to_sink[i] = cost_at(problem.to_sink[i], lambda);
  }
  result.edges.reserve(problem.edges.size());
  for (const ParametricProblem::Edge& edge : problem.edges) {
    result.edges.push_back({edge.from, edge.to, cost_at(edge.areas, lambda)});
  }
  return result;
}

}  // namespace cellocut
