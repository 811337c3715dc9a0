#include "cellocut/base/errors.h"
#include "cellocut/cut/dimacs_arcs.h"
#include "cellocut/cut/file_limits.h"
#include "cellocut/cut/problem_file.h"
#include "cellocut/cut/text_lines.h"

namespace cellocut {

void cut_io::require_terminals(const CutProblem& problem, const DimacsNodes& nodes) {
  const std::size_t count = problem.node_count();
  if (count > kMostNodes) {
    throw LimitError("a DIMACS file holds 2^32 - 3 nodes at most, the problem has " +
                     std::to_string(count));
  }
  const auto fits = [count](std::uint32_t id) { return id >= 1 && id <= count + 2; };
  if (!fits(nodes.source) || !fits(nodes.sink) || nodes.source == nodes.sink) {
    throw UsageError("source " + std::to_string(nodes.source) + " and sink " +
                     std::to_string(nodes.sink) + " are not two of the ids 1 to " +
                     std::to_string(count + 2));
  }
}

std::string encode_dimacs(const CutProblem& problem, const DimacsNodes& nodes) {
  cut_io::require_terminals(problem, nodes);
  std::uint64_t arcs = 0;
  cut_io::visit_arcs(problem, nodes, [&arcs](auto...) { ++arcs; });

  std::string text =
      "c CelloCut: a minimum cut problem as a maximum flow problem.\n"
      "c Every edge has an arc in its direction, and one against it if that has capacity.\n";
  if (problem.constant > 0) {
    text +=
        "c The arc from source to sink is the constant of the problem: every cut holds it,\n"
        "c and the value of a maximum flow includes it.\n";
  }
  text += "p max " + std::to_string(problem.node_count() + 2) + ' ' + std::to_string(arcs) + '\n';
  text += "n " + std::to_string(nodes.source) + " s\n";
  text += "n " + std::to_string(nodes.sink) + " t\n";
  constexpr std::size_t kUsualLine = 20;
  text.reserve(text.size() + kUsualLine * arcs);
  cut_io::visit_arcs(
      problem, nodes,
      [&text](std::uint32_t from, std::uint32_t to, std::int64_t capacity, cut_io::ArcRole /*role*/,
              std::size_t /*index*/) { cut_io::append_line(text, 'a', from, to, capacity); });
  return text;
}

}  // namespace cellocut
