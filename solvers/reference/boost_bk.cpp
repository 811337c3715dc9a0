// boost_bk: the Boykov-Kolmogorov code of Boost.Graph, as an outside witness.
//
// Definition. An adapter: CutProblem -> a graph in compressed rows with explicit source and sink ->
// boost::boykov_kolmogorov_max_flow on 64-bit integers -> net flow per edge. An implementation of
// the algorithm of bk.cpp that shares no code with it nor with libmaxflow.
//
// Complexity. O(n^2 m C) for a minimum cut of value C.
//
// Reference. Y. Boykov, V. Kolmogorov, IEEE TPAMI 26(9), 2004; S. Lauer's implementation in
// Boost.Graph.
//
// Licence: BSL-1.0 (library), GPL-3.0-or-later (adapter). Capabilities: exact for every valid
// problem, one thread, can be cancelled.
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <memory>

#include "solvers/reference/boost_instance.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

class BoostBoykovKolmogorov final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "boost_bk";
      i.summary = "Boost.Graph's Boykov-Kolmogorov on explicit terminals";
      i.licence = "GPL-3.0-or-later AND BSL-1.0";
      i.reference = "Boykov and Kolmogorov, IEEE TPAMI 26(9), 2004; Boost.Graph";
      i.outside = true;
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    BoostInstance instance(problem, context);
    const std::size_t nodes = boost::num_vertices(instance.graph());
    std::vector<BoostInstance::Arc> predecessor(nodes);
    std::vector<boost::default_color_type> colour(nodes, boost::gray_color);
    std::vector<std::int64_t> distance(nodes, 0);
    const auto numbers = boost::get(boost::vertex_index, instance.graph());
    context.built();
    boost::boykov_kolmogorov_max_flow(
        instance.graph(), BoostCapacities{&instance}, BoostResiduals{&instance},
        BoostOpposites{&instance}, boost::make_iterator_property_map(predecessor.begin(), numbers),
        boost::make_iterator_property_map(colour.begin(), numbers),
        boost::make_iterator_property_map(distance.begin(), numbers), numbers, instance.source(),
        instance.sink());
    context.check();
    return {.edge_flow = instance.edge_flow(), .counters = {}, .bytes = instance.bytes()};
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_boost_bk();
std::unique_ptr<CutSolver> make_boost_bk() { return std::make_unique<BoostBoykovKolmogorov>(); }

}  // namespace cellocut::solvers
