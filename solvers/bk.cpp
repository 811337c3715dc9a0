// bk: augmenting paths on two search trees that are kept between augmentations.
//
// Definition. Two disjoint trees of residual arcs grow from the terminals: every node of the source
// tree S is reached from the source along tree arcs, every node of the sink tree T reaches the
// sink. The other nodes are free. Three steps alternate:
//   growth        an active node takes over free neighbours across residual arcs; where it meets
//   the other
//                 tree there is a path from source to sink;
//   augmentation  the bottleneck is pushed along that path; nodes whose tree arc is now saturated
//   become
//                 orphans;
//   adoption      an orphan looks for a new parent in its own tree whose root is still a terminal;
//   where
//                 there is none it becomes free and its children become orphans.
// When no active node is left no residual path joins S and T, and the flow is maximal.
//
// Invariants. (1) The arc between a node and its parent has residual capacity in the direction of
// the flow. (2) A node of S and a node of T joined by a residual arc: one of them is active. (3) A
// node of a tree with a free neighbour across a residual arc is active. (4) `stamp` says as of
// which augmentation the distance `depth` of a node to its terminal was seen to be right; stamps
// only grow towards the root between adoptions, so a walk to the root may stop at the first node
// that bears the current stamp, and a node may change to a nearer parent of at least its own stamp
// without closing a cycle.
//
// Complexity. O(n^2 m C) for a minimum cut of value C: worse than any push-relabel bound, and near
// linear on the shallow, regular instances of geometry and vision, for which it was made. For long
// thin graphs prefer push_relabel.
//
// Layout. 32 bytes per node; the parent is kept as node and arc id, so that walks to the root touch
// nodes alone and augmentations touch nodes and residuals alone (see residual_graph.h). The side
// and the depth share a word, depths of one tree compare as that word. Active nodes are an
// intrusive first-in-first-out list.
//
// References.
//   Y. Boykov, V. Kolmogorov: An experimental comparison of min-cut/max-flow algorithms for energy
//   minimization in vision. IEEE TPAMI 26(9), 2004.
//   V. Kolmogorov: Graph based algorithms for scene reconstruction from two or more views. PhD
//   thesis, Cornell University, 2004, section 2.4 (stamps and distances).
//
// Licence: GPL-3.0-or-later, this project's own code. Capabilities: exact for every valid problem,
// one thread, can be cancelled.
#include <memory>

#include "solvers/bk_search.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

class BoykovKolmogorov final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "bk";
      i.summary = "augmenting paths on two search trees, stamps and distances";
      i.licence = "GPL-3.0-or-later";
      i.reference = "Boykov and Kolmogorov, IEEE TPAMI 26(9), 2004";
      return i;
    }();
    return info;
  }

 private:
  SolverOutput do_solve(const CutProblem& problem, SolveContext& context) override {
    context.check();
    ResidualGraph graph(problem);
    BkSearch search(graph, context);
    context.built();
    search.begin_at_terminals();
    search.run();
    return {graph.edge_flow(problem),
            {{"augmentations", search.augmentations},
             {"nodes_grown", search.grown},
             {"orphans", search.orphans}},
            graph.bytes() + search.bytes()};
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_bk();
std::unique_ptr<CutSolver> make_bk() { return std::make_unique<BoykovKolmogorov>(); }

}  // namespace cellocut::solvers
