// bk_blocks: bk on blocks of the nodes at the same time, merged from the bottom up.
//
// Definition. The nodes are divided by number into 2^k blocks of equal size. On each block bk runs
// as if the arcs to other blocks were not there; blocks are then merged in pairs: the trees of both
// stay as they are, their nodes with an arc between the two become active again, and bk goes on
// over the pair. What bk finds within a block stays found, so the more of the work lies within
// blocks, the more of it is shared among threads. The numbers of nodes have to be local: those of a
// remesh are, since its cells are numbered along the sorted points of the tetrahedralization.
//
// Invariants. Those of bk hold within a block. Two nodes of different blocks have no say in each
// other's trees before the merge, and afterwards all that a new arc can break is invariants (2) and
// (3) at its ends, which are active.
//
// The number of blocks depends on the number of nodes alone, and each step is that of one thread:
// the flow is the same for any number of threads.
//
// Complexity. As bk. At most log2(blocks) merges follow one another; the last is serial.
//
// References. bk, and
//   J. Liu, J. Sun: Parallel graph-cuts by adaptive bottom-up merging. CVPR 2010 (theirs merges
//   whichever neighbours are ready; a fixed order keeps the result the same).
//
// Licence: GPL-3.0-or-later, this project's own code. Capabilities: exact for every valid problem,
// all threads, can be cancelled.
#include <tbb/parallel_invoke.h>

#include <memory>

#include "solvers/bk_search.h"
#include "solvers/solvers.h"

namespace cellocut::solvers {

namespace {

constexpr std::uint32_t kSmallestBlock = 4096;
constexpr unsigned kMostLevels = 6;

// Runs over [begin, end) in 2^levels blocks.
void run_blocks(BkSearch& search, std::uint32_t begin, std::uint32_t end, unsigned levels) {
  if (levels == 0) {
    search.begin_at_terminals();
  } else {
    const std::uint32_t middle = begin + (end - begin) / 2;
    BkSearch first(search, begin, middle);
    BkSearch second(search, middle, end);
    tbb::parallel_invoke([&] { run_blocks(first, begin, middle, levels - 1); },
                         [&] { run_blocks(second, middle, end, levels - 1); });
    search.take_over(first, second, middle);
  }
  search.run();
}

class BlockwiseBoykovKolmogorov final : public CutSolver {
 public:
  [[nodiscard]] const SolverInfo& info() const override {
    static const SolverInfo info = [] {
      SolverInfo i;
      i.name = "bk_blocks";
      i.summary = "bk on blocks in parallel, merged from the bottom up";
      i.licence = "GPL-3.0-or-later";
      i.reference = "Boykov and Kolmogorov, IEEE TPAMI 26(9), 2004; Liu and Sun, CVPR 2010";
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
    unsigned levels = 0;
    while (levels < kMostLevels && graph.node_count() >> (levels + 1) >= kSmallestBlock) ++levels;
    run_blocks(search, 0, graph.node_count(), levels);
    return {graph.edge_flow(problem),
            {{"augmentations", search.augmentations},
             {"nodes_grown", search.grown},
             {"orphans", search.orphans},
             {"blocks", std::int64_t{1} << levels}},
            graph.bytes() + search.bytes()};
  }
};

}  // namespace

std::unique_ptr<CutSolver> make_bk_blocks();
std::unique_ptr<CutSolver> make_bk_blocks() {
  return std::make_unique<BlockwiseBoykovKolmogorov>();
}

}  // namespace cellocut::solvers
