// Families of maximum-flow problems that do not come from meshes, after generators of the first
// DIMACS challenge (Johnson and McGeoch, editors: Network Flows and Matching, AMS 1993).
// The same problem on every machine for the same size and seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cellocut/cut/cut_problem.h"

namespace cellocut::testing {

// A grid `width` nodes wide and `length` long, four neighbours each; the source feeds one short
// side, the sink drains the other. Capacities 1 to 1000 in either direction.
CutProblem long_grid(std::uint32_t width, std::uint32_t length, std::uint64_t seed);

// A grid of side^3 nodes, six neighbours each, capacities 1 to 1000; one node in ten has a source
// or a sink of up to 5000.
CutProblem random_grid(std::uint32_t side, std::uint64_t seed);

// In the manner of genrmf (Goldfarb and Grigoriadis, 1988): `depth` square frames of side^2 nodes.
// Within a frame neighbours are joined both ways with 1000 side^2, so that no cut goes there; each
// node has one arc of 1 to 1000 to the next frame, by a random permutation. Source and sink are a
// corner of the first frame and the opposite one of the last.
CutProblem layered_frames(std::uint32_t side, std::uint32_t depth, std::uint64_t seed);

// In the manner of the washington generator's random level graph: `levels` levels of `width` nodes,
// each with three arcs of 1 to 1000 to random nodes of the next level. The source feeds the first
// level and the last drains into the sink, as much as the arcs there let through.
CutProblem random_levels(std::uint32_t width, std::uint32_t levels, std::uint64_t seed);

struct FamilyMember {
  std::string name;
  CutProblem problem;
};
// One of each family with about that many nodes, at least some 60.
std::vector<FamilyMember> cut_families(std::uint32_t nodes, std::uint64_t seed);

}  // namespace cellocut::testing
