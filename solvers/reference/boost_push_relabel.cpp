// boost_push_relabel: the push-relabel code of Boost.Graph, as an outside witness.
//
// Definition. An adapter: CutProblem -> a graph in compressed rows with explicit source and sink ->
// boost::push_relabel_max_flow on 64-bit integers (highest label, gap heuristic, global
// relabelling; it ends by turning its preflow into a flow) -> net flow per edge.
//
// Limits. Terminals are nodes with a degree of the order of the graph, which costs it dearly on
// problems where every node has a terminal arc; it is here to agree, not to win.
//
// Complexity. O(n^3).
//
// Reference. J. Siek, L.-Q. Lee, A. Lumsdaine: The Boost Graph Library, 2002; the code follows
// B. Cherkassky, A. Goldberg: On implementing the push-relabel method for the maximum flow problem.
// Algorithmica 19, 1997.
//
// Licence: BSL-1.0 (library), GPL-3.0-or-later (adapter). Capabilities: exact for every valid
// problem, one thread, can be cancelled.
#include <boost/graph/push_relabel_max_flow.hpp>
#include <memory>

#include "solvers/reference/boost_instance.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

class BoostPushRelabel final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "boost_push_relabel";
      i.summary = "Boost.Graph's push-relabel on explicit terminals";
      i.licence = "GPL-3.0-or-later AND BSL-1.0";
      i.reference = "Cherkassky and Goldberg, Algorithmica 19, 1997; Boost.Graph";
      i.outside = true;
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    BoostInstance instance(problem, context);
    context.built();
    boost::push_relabel_max_flow(instance.graph(), instance.source(), instance.sink(),
                                 BoostCapacities{&instance}, BoostResiduals{&instance},
                                 BoostOpposites{&instance},
                                 boost::get(boost::vertex_index, instance.graph()));
    context.check();
    return {.edge_flow = instance.edge_flow(), .counters = {}, .bytes = instance.bytes()};
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_boost_push_relabel();
std::unique_ptr<CutSolver> make_boost_push_relabel() {
  return std::make_unique<BoostPushRelabel>();
}

}  // namespace cellocut::solvers
