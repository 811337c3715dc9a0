// What a minimum cut problem looks like: numbers that tell one instance from another and explain
// why a solver is fast or slow on it.
#pragma once

#include <array>
#include <cstdint>

#include "cellocut/cut/cut_problem.h"

namespace cellocut {

// Bin k counts the capacities c with 2^k <= c < 2^(k+1). Zeros are in none.
using CapacityHistogram = std::array<std::uint64_t, 62>;

struct DegreeStatistics {
  std::uint64_t minimum = 0;
  std::uint64_t median = 0;  // the lower of the two where the number of nodes is even
  std::uint64_t maximum = 0;
  double mean = 0;
};

// Of a problem without nodes, everything is zero. Loops count as edges and nowhere else.
struct ProblemStatistics {
  std::uint64_t nodes = 0;
  std::uint64_t edges = 0;  // entries of CutProblem::edges, parallel ones each
  std::uint64_t loops = 0;
  // Directions of edges, two for each that is not a loop: with capacity, and without.
  std::uint64_t arcs = 0;
  std::uint64_t zero_capacities = 0;
  CapacityHistogram edge_capacities{};      // of the arcs
  CapacityHistogram terminal_capacities{};  // of source and sink arcs

  std::uint64_t source_nodes = 0;  // nodes with a source arc that has capacity
  std::uint64_t sink_nodes = 0;    // the same for the sink
  std::uint64_t both_nodes = 0;    // nodes with both, which are counted above too
  double source_share = 0;         // the same as fractions of all nodes
  double sink_share = 0;
  double both_share = 0;

  DegreeStatistics degree;  // edges at a node, those without capacity too

  // Of the undirected graph of the edges that have capacity in at least one direction; source and
  // sink connect nothing.
  std::uint64_t components = 0;
  std::uint64_t largest_component = 0;  // nodes
  // A lower bound on the largest number of edges between two nodes of one component by the shortest
  // way, found by double sweeps (C. Magnien, M. Latapy, M. Habib: Fast computation of empirically
  // tight bounds for the diameter of massive graphs, ACM JEA 13, 2009): from a start to a node
  // farthest away, and from there to the farthest again. On a tree a sweep that starts in the
  // component concerned is exact.
  std::uint64_t diameter_lower_bound = 0;
};

// `sweeps` double sweeps are made, the first from a node of the largest component, the others from
// random nodes; the same seed gives the same starts on every machine.
// Precondition: problem.validate() holds, fewer than 2^32 edges. O(sweeps (nodes + edges)) time,
// about 24 bytes per node and 8 per edge.
ProblemStatistics problem_statistics(const CutProblem& problem, std::uint32_t sweeps = 4,
                                     std::uint64_t seed = 1);

}  // namespace cellocut
