// Exact reductions of a minimum cut problem: nodes that can be decided or joined before the search.
//
// Three rules, applied until none applies to a node of small degree. Write t for what the source
// can give to a node, net of what it can give to the sink; `out` and `in` for the sums of the
// capacities of its arcs to and from other nodes.
//   unreachable  what no source reaches, or what reaches no sink, carries no flow: it is dropped.
//   dominated    t >= out >= 0: each arc i -> j is saturated from the source for all that j can
//                tell, so j receives a source of that capacity and i is dropped. Sinks likewise.
//   heavy edge   c(i,j) >= in - c(j,i) + max(t,0) and c(j,i) >= out - c(i,j) + max(-t,0): whatever
//                flows into i by other ways can go on to j and back, so the two are joined. (This
//                takes leaves and, in symmetric problems, chains too.)
// A maximum flow of what is left is turned into one of the whole problem, edge by edge, in the
// reverse order. Heavy edges: C. Padberg and G. Rinaldi, "An efficient algorithm for the minimum
// capacity cut problem", Mathematical Programming 47, 1990 (their test 2, here with terminals).
#pragma once

#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_problem.h"

namespace cellocut {

struct ReductionRules {
  bool unreachable = true;
  bool dominated = true;
  bool heavy_edges = true;
};

// Nodes that each rule removed.
struct ReductionCounts {
  std::int64_t unreachable = 0;
  std::int64_t dominated = 0;
  std::int64_t heavy_edges = 0;
  std::int64_t isolated = 0;  // left without an edge by the other rules, or from the beginning
};

class Reduction {
 public:
  // Precondition: problem.validate() holds, fewer than 2^31 edges (LimitError). O((nodes + edges)
  // log nodes).
  explicit Reduction(const CutProblem& problem, const ReductionRules& rules = {});

  // What is left to be solved. Its value is not that of the whole: lift a flow, and look there.
  [[nodiscard]] const CutProblem& problem() const { return left_; }
  [[nodiscard]] const ReductionCounts& counts() const { return counts_; }

  // A maximum flow of the whole problem from one of what is left. O(nodes + edges).
  [[nodiscard]] std::vector<std::int64_t> lift(const std::vector<std::int64_t>& edge_flow) const;

  // Values per node of the whole from those of what is left: joined nodes have the same, nodes that
  // were decided 1 on the source side and 0 on the sink side. O(nodes + edges).
  [[nodiscard]] std::vector<float> lift_values(const std::vector<float>& values) const;

 private:
  enum class Step : std::uint8_t { give, join, merge };
  // A half is an edge seen from one of its ends: 2e from `from`, 2e + 1 from `to`.
  struct Move {
    Step step;
    std::uint32_t half;  // give, join: seen from the node that goes; merge: of the edge that stays
    std::uint32_t node;  // that goes; merge: the half of the edge that goes
    std::uint32_t into;  // give, join
    std::int64_t part;   // give: what `into` receives; join: t of the node; merge: capacity
    std::int64_t own;    // give, join: t of `into` before; merge: reverse capacity
    std::uint32_t
        others;  // join: end of its range in others_, which begins where the last one ends
  };

  std::vector<Move> moves_;
  std::vector<std::uint32_t> others_;     // halves of a node that was joined to another
  std::vector<std::uint32_t> edge_left_;  // per edge of the whole: its place in what is left
  std::vector<std::uint8_t> alone_;       // per node of the whole: the side it is on by itself
  std::vector<std::uint32_t> node_left_;  // per node of what is left: the node of the whole
  CutProblem left_;
  ReductionCounts counts_;

  friend class Reducer;
};

}  // namespace cellocut
