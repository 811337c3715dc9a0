// Maximum-flow problems and their solutions as files: DIMACS `.max` and `.sol`, and the binary
// `.bbk` of a benchmark collection. Everything here turns bytes into structures and back; opening,
// naming and replacing files is the caller's business (cellocut/base/atomic_file.h).
//
// Sources of the formats.
// DIMACS: D. S. Johnson, C. C. McGeoch (editors): Network Flows and Matching: First DIMACS
// Implementation Challenge. AMS, 1993.
// bbk: P. M. Jensen, N. Jeppesen, A. B. Dahl, V. A. Dahl: Review of Serial and Parallel
// Min-Cut/Max-Flow Algorithms for Computer Vision. IEEE TPAMI, 2022; the layout is that of the
// README of their collection, github.com/patmjen/maxflow_algorithms.
//
// Errors. Every function that reads throws InputError for whatever is not a valid file, with the
// number of the line (`line 12: ...`), or for bbk with the byte or the record. No count in a file
// is believed before the bytes for it are there.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cellocut/cut/cut_problem.h"
#include "cellocut/cut/cut_solver.h"

namespace cellocut {

// ---- DIMACS problems ----

// Source and sink are nodes of a DIMACS file, numbered from 1, but not of a CutProblem, numbered
// from 0. The other nodes keep their order, so the two ids say everything.
struct DimacsNodes {
  std::uint32_t source = 1;
  std::uint32_t sink = 2;

  // The id of a node of the CutProblem. Precondition: source != sink, node < 2^32 - 3.
  [[nodiscard]] std::uint32_t id(std::uint32_t node) const {
    std::uint32_t result = node + 1;
    if (result >= std::min(source, sink)) ++result;
    if (result >= std::max(source, sink)) ++result;
    return result;
  }
  // The reverse. Precondition: `id` is neither 0 nor the source nor the sink.
  [[nodiscard]] std::uint32_t node(std::uint32_t id) const {
    return id - 1 - static_cast<std::uint32_t>(id > source) - static_cast<std::uint32_t>(id > sink);
  }
};

// An arc as a file has it: ids from 1, source and sink among them.
struct DimacsArc {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::int64_t amount = 0;  // a capacity, or a flow
  bool operator==(const DimacsArc&) const = default;
};

struct DimacsProblem {
  CutProblem problem;
  DimacsNodes nodes;
  // Arcs into the source, arcs out of the sink and loops, as they stood in the file. No cut counts
  // them and no maximum flow needs them, so they are not part of the problem; somebody else's flow
  // may use them all the same (check_solution).
  std::vector<DimacsArc> left_out;
};

// Reads a `.max` file: comments `c ...`, then `p max NODES ARCS`, then `n ID s` and `n ID t` in
// either order, then the arcs `a FROM TO CAPACITY`. Blank lines are skipped, lines end in LF or
// CR LF. An arc from the source goes to to_source, one to the sink to to_sink, one from the source
// to the sink to the constant: every cut cuts it. Parallel and opposite arcs become one CutEdge per
// unordered pair, in the order of first appearance and directed as the first arc is.
// The result is validated (CutProblem::validate).
// Errors: InputError for anything else than that: unknown or repeated or missing lines, source and
// sink the same, ids out of range, fields that are missing, too many or no integers of 64 bits,
// negative capacities, more or fewer arcs than announced, capacities that sum to 2^62 or more, and
// more nodes than the size of the file makes plausible (2^20 and one per byte; each arc takes eight
// bytes or more) or than 2^32 - 1.
// O(nodes + bytes) time, 24 bytes per arc on top of the result.
DimacsProblem parse_dimacs(std::string_view text);

// Writes a `.max` file that holds: the constant, if any, as an arc from the source to the sink, so
// that the value of a maximum flow is the value of the cut, constant included; an arc for each
// terminal capacity above zero; for each edge an arc `from to capacity`, even of capacity zero, so
// that edges and their direction survive, followed by `to from reverse_capacity` if that is above
// zero. Loops are left out. parse_dimacs gives back the same problem, if no two edges join the same
// two nodes; otherwise the same with those merged. (It refuses a problem of more than 2^20 nodes of
// which next to none has an arc.)
// Preconditions: problem.validate() holds; `nodes` are different ids between 1 and node_count() + 2
// (UsageError). Errors: LimitError with more than 2^32 - 3 nodes. O(nodes + edges).
std::string encode_dimacs(const CutProblem& problem, const DimacsNodes& nodes = {});

// ---- bbk ----

// The capacity types that are written. double, 9, is read too.
enum class BbkCapacity : std::uint8_t { int32 = 5, int64 = 7 };

// Reads an uncompressed `.bbk` file. All numbers are little-endian, without padding:
//   'B' 'B' 'Q'; u8 type of edge capacities E; u8 type of terminal capacities T;
//   u64 nodes, u64 terminal records, u64 edge records;
//   per terminal record: u64 node; T source capacity; T sink capacity   (records of a node add up)
//   per edge record:     u64 i; u64 j; E capacity i -> j; E capacity j -> i
// Edge e of the problem is edge record e, unmerged. The constant is zero. Doubles are read if each
// is an integer. The result is validated.
// Errors: InputError for another magic (a compressed file, 'bbq', is named as such), another type,
// counts that do not match the size of the file, node numbers out of range, capacities that are
// negative, not an integer, or sum to 2^62 or more, and more nodes than 2^20 and one per byte or
// than 2^32 - 3. O(nodes + bytes).
CutProblem parse_bbk(std::string_view bytes);

// Writes an uncompressed `.bbk` file with both types as asked for; a terminal record for each node
// that has a terminal capacity, an edge record for each edge that is not a loop. The format has no
// place for a constant: it is added to both terminal capacities of node 0, through which it flows
// in every maximum flow, so the value and the canonical minimum cuts stay; a problem that has a
// constant and no node gets a node for it. (parse_bbk() refuses as many nodes with as few arcs as
// parse_dimacs() does.)
// Precondition: problem.validate() holds. Errors: LimitError where a value does not fit the type,
// or where the constant, counted twice, brings the sum of capacities to 2^62 or more.
// O(nodes + edges).
std::string encode_bbk(const CutProblem& problem, BbkCapacity type = BbkCapacity::int64);

// ---- DIMACS solutions ----

struct FlowSolution {
  std::int64_t value = 0;
  std::vector<DimacsArc> flows;  // in the order of the file
};

// Reads a `.sol` file: comments, one line `s VALUE`, and lines `f FROM TO FLOW` or
// `a FROM TO FLOW` (both are in use). Arcs that have no line carry no flow.
// Errors: InputError for unknown lines, none or two `s` lines, ids that are not between 1 and
// 2^32 - 1, negative numbers, fields that are missing, too many or no integers of 64 bits.
// O(bytes).
FlowSolution parse_solution(std::string_view text);

// Writes a `.sol` file: `s` with the value of the flow, constant included, and an `f` line, zero or
// not, for each arc that encode_dimacs(problem.problem, problem.nodes) writes, in that order. Arcs
// between the same two nodes that were merged on reading appear as their net flow; those left out
// on reading have no line and no flow.
// Preconditions: result.edge_flow is a feasible flow of problem.problem and result.lower_bound its
// value, as CutSolver::solve returns them; UsageError where the number of edges differs or an id is
// out of range. O(nodes + edges).
std::string encode_solution(const DimacsProblem& problem, const CutResult& result);

// Checks a solution, whoever found it: flow runs only where an arc runs that way, the flow from one
// node to another is within the summed capacity of the arcs from the one to the other, as much
// flows into every node as out of it except at source and sink, and what leaves the source net is
// the value. Whether the flow is maximum it does not say: compare the value with a cut.
// Empty where all is well, otherwise what is wrong, with ids as in the file.
// Precondition: problem.problem.validate() holds. Sums are formed in 128 bits.
// O(nodes + arcs + flows) memory and O(log) times that in time.
std::string check_solution(const DimacsProblem& problem, const FlowSolution& solution);

}  // namespace cellocut
