// The cut problem of a remesh as a function of lambda_fill.
//
// With lambda = p / q a facet costs q times its supported area and p times the rest, so a labelling
// costs q A_s + p A_u: a line in lambda. By the paper's rule only arcs from the source are
// supported (facets between anchored and free cells). In units of 1 / lambda just those depend on
// lambda then, and all of them fall as it grows: the monotone parametric problem of Gallo,
// Grigoriadis and Tarjan (SIAM J. Comput. 18, 1989), whose minimum cuts are nested. Where support
// is measured on the facets they are not.
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_problem.h"
#include "cellocut/path/wide_cut.h"

namespace cellocut {

// lambda = p / q in lowest terms, both positive.
struct Lambda {
  std::int64_t p = 1;
  std::int64_t q = 1;
};
bool operator<(const Lambda& a, const Lambda& b);
bool operator==(const Lambda& a, const Lambda& b);
double to_double(const Lambda& lambda);
// The simplest fraction strictly between two others: of all there the one with the smallest terms.
// Precondition: a < b. O(size of the continued fraction).
Lambda simplest_between(const Lambda& a, const Lambda& b);

// What a labelling costs, in quanta of area: at lambda = p / q it is q supported + p unsupported.
struct InterfaceAreas {
  std::int64_t supported = 0;
  std::int64_t unsupported = 0;
  bool operator==(const InterfaceAreas&) const = default;
  InterfaceAreas& operator+=(const InterfaceAreas& other) {
    supported += other.supported;
    unsupported += other.unsupported;
    return *this;
  }
};
Wide cost_at(const InterfaceAreas& areas, const Lambda& lambda);
// Where two lines meet. Precondition: a has more unsupported and less supported area than b.
Lambda crossing(const InterfaceAreas& a, const InterfaceAreas& b);

struct ParametricProblem {
  struct Edge {
    std::uint32_t from;
    std::uint32_t to;
    InterfaceAreas areas;
  };
  std::vector<InterfaceAreas> to_source;  // per node
  std::vector<InterfaceAreas> to_sink;
  std::vector<Edge> edges;
  InterfaceAreas constant;

  [[nodiscard]] std::size_t node_count() const { return to_source.size(); }
  // Whether only arcs from the source are supported. O(nodes + edges).
  [[nodiscard]] bool nested() const;
};

// Areas of a labelling, 1 on the source side. O(nodes + edges).
InterfaceAreas areas_of(const ParametricProblem& problem, const CutLabels& source_side);

// The problem at one lambda; its nodes and edges are those of `problem`. O(nodes + edges).
WideProblem at_lambda(const ParametricProblem& problem, const Lambda& lambda);

}  // namespace cellocut
