// A minimum cut of a labelled complex by the plainest means, as a witness for tests: a maximum flow
// by breadth-first augmentation (Edmonds and Karp 1972) over all cells and facets, without
// contraction, in 128 bits. O(cells facets^2); for tiny complexes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "cellocut/energy/certificate.h"

namespace cellocut::testing {

__extension__ using Wide = __int128;

// A certificate's claim that owns what it refers to.
struct Claim {
  TetComplex complex;
  CellLabels initial;
  ExteriorMode mode = ExteriorMode::unbounded;
  Rational lambda;
  double unit = 1;
  int area_bits = 40;
  std::vector<std::int64_t> flow;
  std::int64_t value = 0;
  CellLabels smallest;
  CellLabels largest;

  [[nodiscard]] CertificateReport check() const;
  // Names of the checks that did not pass.
  [[nodiscard]] std::vector<std::string> failures() const;
};

// The graph of a claim: a node per cell and, last, one for the unbounded region. Capacities and
// flow may be changed at will.
struct ReferenceCut {
  // What a search came by, where not a facet.
  static constexpr int kSeed = -1;
  static constexpr int kNotReached = -2;

  FacetList facets;
  std::vector<Wide> capacities;
  std::vector<Anchor> anchors;                     // of every node
  std::vector<std::vector<std::size_t>> incident;  // facets of every node
  std::vector<Wide> flow;                          // from the lower cell to the other
  Wide value = 0;                                  // of the flow

  explicit ReferenceCut(const Claim& claim);

  [[nodiscard]] std::size_t outside() const { return anchors.size() - 1; }
  [[nodiscard]] std::size_t head(std::size_t facet) const;
  [[nodiscard]] std::vector<std::size_t> nodes_of(Anchor kind) const;
  [[nodiscard]] Wide cost(const CellLabels& labels) const;
  [[nodiscard]] Wide residual(std::size_t facet, bool from_lower) const;

  // Breadth first from `seeds` along open residual arcs (against them if not `forward`), not across
  // facet `without`. Per node: the facet by which it was reached, kSeed or kNotReached.
  [[nodiscard]] std::vector<int> search(const std::vector<std::size_t>& seeds, bool forward,
                                        int without = -1) const;
  // Pushes as much as fits along the path of a forward search to `node`; returns that amount.
  Wide augment(const std::vector<int>& came_by, std::size_t node);
  void maximise();

  // Makes the flow maximal and fills in what `claim` claims from it.
  void solve(Claim& claim);
};

// A true claim.
Claim solved(TetComplex complex, CellLabels initial, ExteriorMode mode, Rational lambda,
             double unit = 1, int area_bits = 40);

// One with many ties between cuts: a grid of equal cubes, lambda 1. 162 cells.
Claim tied_claim(ExteriorMode mode);

inline constexpr ExteriorMode kModes[] = {ExteriorMode::unbounded, ExteriorMode::hull_cells};

}  // namespace cellocut::testing
