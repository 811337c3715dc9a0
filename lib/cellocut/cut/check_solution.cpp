#include <algorithm>
#include <tuple>

#include "cellocut/base/wide_text.h"
#include "cellocut/cut/dimacs_arcs.h"
#include "cellocut/cut/problem_file.h"

namespace cellocut {

namespace {

std::string pair_of(const DimacsArc& arc) {
  return "from " + std::to_string(arc.from) + " to " + std::to_string(arc.to);
}

auto ends(const DimacsArc& arc) { return std::tie(arc.from, arc.to); }

void sort_by_ends(std::vector<DimacsArc>& arcs) {
  std::sort(arcs.begin(), arcs.end(),
            [](const DimacsArc& a, const DimacsArc& b) { return ends(a) < ends(b); });
}

std::vector<DimacsArc> arcs_of(const DimacsProblem& problem) {
  std::vector<DimacsArc> arcs = problem.left_out;
  cut_io::visit_arcs(problem.problem, problem.nodes,
                     [&arcs](std::uint32_t from, std::uint32_t to, std::int64_t capacity,
                             cut_io::ArcRole /*role*/, std::size_t /*index*/) {
                       arcs.push_back({from, to, capacity});
                     });
  sort_by_ends(arcs);
  return arcs;
}

// Sums the amounts of arcs[at] and of those after it that have the same ends, and moves behind
// them.
Wide take_pair(const std::vector<DimacsArc>& arcs, std::size_t& at) {
  const DimacsArc& first = arcs[at];
  Wide sum = 0;
  for (; at < arcs.size() && ends(arcs[at]) == ends(first); ++at) sum += arcs[at].amount;
  return sum;
}

// Both lists sorted by ends.
std::string capacity_defect(const std::vector<DimacsArc>& arcs,
                            const std::vector<DimacsArc>& flows) {
  std::size_t at = 0;
  for (std::size_t k = 0; k < flows.size();) {
    const DimacsArc& pair = flows[k];
    const Wide flow = take_pair(flows, k);
    while (at < arcs.size() && ends(arcs[at]) < ends(pair)) ++at;
    if (at == arcs.size() || ends(arcs[at]) != ends(pair)) {
      // Where an edge has no capacity that way, an arc may have stood in the file all the same.
      if (flow == 0) continue;
      return "flow " + to_decimal(flow) + " " + pair_of(pair) + ", where no arc has capacity";
    }
    const Wide capacity = take_pair(arcs, at);
    if (flow > capacity) {
      return "flow " + to_decimal(flow) + " " + pair_of(pair) + " exceeds the capacity " +
             to_decimal(capacity);
    }
  }
  return {};
}

}  // namespace

std::string check_solution(const DimacsProblem& problem, const FlowSolution& solution) {
  const std::size_t ids = problem.problem.node_count() + 2;
  for (const DimacsArc& flow : solution.flows) {
    for (const std::uint32_t id : {flow.from, flow.to}) {
      if (id < 1 || id > ids) {
        return "flow " + pair_of(flow) + ", but the nodes are 1 to " + std::to_string(ids);
      }
    }
    if (flow.amount < 0) return "negative flow " + pair_of(flow);
  }

  std::vector<DimacsArc> flows = solution.flows;
  sort_by_ends(flows);
  std::string defect = capacity_defect(arcs_of(problem), flows);
  if (!defect.empty()) return defect;

  std::vector<Wide> out(ids + 1, 0);
  for (const DimacsArc& flow : flows) {
    out[flow.from] += flow.amount;
    out[flow.to] -= flow.amount;
  }
  for (std::uint32_t id = 1; id <= ids; ++id) {
    if (id == problem.nodes.source || id == problem.nodes.sink || out[id] == 0) continue;
    return "at node " + std::to_string(id) +
           (out[id] > 0 ? " more flows out than in, by " : " more flows in than out, by ") +
           to_decimal(out[id] > 0 ? out[id] : -out[id]);
  }
  if (out[problem.nodes.source] != solution.value) {
    return "the value is given as " + std::to_string(solution.value) + ", but " +
           to_decimal(out[problem.nodes.source]) + " flows out of the source";
  }
  return {};
}

}  // namespace cellocut
