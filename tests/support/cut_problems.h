// Shared minimum-cut problems for tests: named ones with known answers, seeded random ones, and
// exhaustive search as a witness for the small ones.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cellocut/cut/cut_problem.h"

namespace cellocut::testing {

// What every exact solver must answer.
struct ExpectedCut {
  std::int64_t value = 0;
  CutLabels smallest;  // source side of the minimum cut with the fewest source nodes
  CutLabels largest;   // and of the one with the most
};

struct NamedProblem {
  std::string name;
  CutProblem problem;
  ExpectedCut expected;
};

// Problems whose answers were found by hand, one for each trap; the name says which.
const std::vector<NamedProblem>& known_problems();

// Sum of all capacities and the constant. Precondition: problem.validate() holds.
std::int64_t capacity_sum(const CutProblem& problem);

enum class RandomShape {
  tiny,  // at most 12 nodes, for exhaustive search; loops, parallel edges, isolated nodes
  sparse,
  dense,
  grid_3d,
  long_path,    // with a few chords
  bipartite,    // sources on one side, sinks on the other
  many_ties,    // capacities 0 to 3
  one_way,      // no reverse capacities
  tetrahedral,  // like a remesh: degree at most 4, terminals on two surfaces, two weights
  huge          // capacities that sum to just below 2^62
};
const std::vector<RandomShape>& random_shapes();
const char* to_string(RandomShape shape);

// The same problem on every machine for the same shape and seed.
CutProblem random_problem(RandomShape shape, std::uint64_t seed);

// Minimum over all labellings, with the intersection and the union of all source sides that attain
// it. Precondition: at most 16 nodes.
ExpectedCut exhaustive_cut(const CutProblem& problem);

// A problem like those of a remesh, of about side^3 nodes: a grid of cells joined to at most four
// neighbours, areas of varying size, sources along a closed sheet with holes, sinks on the hull.
CutProblem sheet_problem(std::uint32_t side, std::uint64_t seed);

// A problem like those of image segmentation: a grid of side^3 nodes with six neighbours each,
// terminals at every node that are a noisy picture of a ball.
CutProblem noisy_ball_problem(std::uint32_t side, std::uint64_t seed);

}  // namespace cellocut::testing
