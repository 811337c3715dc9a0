#include <algorithm>
#include <limits>

#include "cellocut/base/errors.h"
#include "cellocut/cut/dimacs_arcs.h"
#include "cellocut/cut/problem_file.h"
#include "cellocut/cut/text_lines.h"

namespace cellocut {

namespace {

std::uint32_t read_id(cut_io::TextLines& lines) {
  const std::int64_t id = lines.integer("a node");
  if (id < 1 || id > std::numeric_limits<std::uint32_t>::max()) {
    lines.fail("node " + std::to_string(id) + " is out of range");
  }
  return static_cast<std::uint32_t>(id);
}

}  // namespace

FlowSolution parse_solution(std::string_view text) {
  cut_io::TextLines lines(text);
  FlowSolution solution;
  std::size_t value_line = 0;
  while (lines.next()) {
    const std::string_view kind = lines.token();
    if (kind == "f" || kind == "a") {
      const std::uint32_t from = read_id(lines);
      const std::uint32_t to = read_id(lines);
      solution.flows.push_back({from, to, lines.count("a flow")});
    } else if (kind == "s") {
      if (value_line != 0) {
        lines.fail("a second solution line, the first is line " + std::to_string(value_line));
      }
      value_line = lines.number();
      solution.value = lines.count("the value of the flow");
    } else {
      lines.fail("expected a line of type c, s, f or a, found " + quoted(kind));
    }
    lines.expect_end();
  }
  if (value_line == 0) lines.fail("the file ends without a solution line ('s VALUE')");
  return solution;
}

std::string encode_solution(const DimacsProblem& problem, const CutResult& result) {
  const CutProblem& cut = problem.problem;
  cut_io::require_terminals(cut, problem.nodes);
  if (result.edge_flow.size() != cut.edges.size()) {
    throw UsageError("a flow of " + std::to_string(result.edge_flow.size()) +
                     " edges for a problem of " + std::to_string(cut.edges.size()));
  }
  const std::vector<std::int64_t> out = node_balances(cut, result.edge_flow);
  const auto terminals = [&](std::size_t i) {
    return terminal_flow(cut.to_source[i], cut.to_sink[i], out[i]);
  };
  std::string text = "c CelloCut: a maximum flow; a line for every arc, flow or not.\ns " +
                     std::to_string(result.lower_bound) + '\n';
  cut_io::visit_arcs(cut, problem.nodes,
                     [&](std::uint32_t from, std::uint32_t to, std::int64_t capacity,
                         cut_io::ArcRole role, std::size_t index) {
                       std::int64_t flow = 0;
                       switch (role) {
                         case cut_io::ArcRole::constant:
                           flow = capacity;
                           break;
                         case cut_io::ArcRole::from_source:
                           flow = terminals(index).from_source;
                           break;
                         case cut_io::ArcRole::to_sink:
                           flow = terminals(index).to_sink;
                           break;
                         case cut_io::ArcRole::forward:
                           flow = std::max<std::int64_t>(0, result.edge_flow[index]);
                           break;
                         case cut_io::ArcRole::reverse:
                           flow = std::max<std::int64_t>(0, -result.edge_flow[index]);
                           break;
                       }
                       cut_io::append_line(text, 'f', from, to, flow);
                     });
  return text;
}

}  // namespace cellocut
