#include "support/reference_cut.h"

#include <algorithm>
#include <deque>

#include "support/tiny_complexes.h"

namespace cellocut::testing {

namespace {

// The label on the far side of a facet; the unbounded region is exterior.
std::uint8_t label_beyond(const Facet& facet, const CellLabels& labels) {
  return facet.other == kOutside ? kExterior : labels[static_cast<std::size_t>(facet.other)];
}

}  // namespace

CertificateReport Claim::check() const {
  return check_certificate(
      {complex, initial, mode, lambda, unit, area_bits, flow, value, smallest, largest});
}

std::vector<std::string> Claim::failures() const {
  std::vector<std::string> names;
  const CertificateReport report = check();
  for (const CertificateCheck& check : report.checks) {
    if (!check.passed) names.push_back(check.name);
  }
  if (report.valid != names.empty()) names.emplace_back("valid contradicts the checks");
  return names;
}

ReferenceCut::ReferenceCut(const Claim& claim)
    : facets(list_facets(claim.complex)),
      anchors(anchor_cells(claim.complex, claim.initial, claim.mode)) {
  const FacetAreas areas = quantise_areas(claim.complex, facets, claim.unit, claim.area_bits);
  anchors.push_back(Anchor::exterior);
  incident.resize(anchors.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    // As facet_capacity has it, in 128 bits.
    const bool differ = claim.initial[facets[f].cell] != label_beyond(facets[f], claim.initial);
    capacities.push_back(Wide{differ ? claim.lambda.denominator : claim.lambda.numerator} *
                         areas.quantised[f]);
    incident[facets[f].cell].push_back(f);
    incident[head(f)].push_back(f);
  }
  flow.assign(facets.size(), 0);
}

std::size_t ReferenceCut::head(std::size_t facet) const {
  const std::int32_t other = facets[facet].other;
  return other == kOutside ? outside() : static_cast<std::size_t>(other);
}

std::vector<std::size_t> ReferenceCut::nodes_of(Anchor kind) const {
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (anchors[i] == kind) nodes.push_back(i);
  }
  return nodes;
}

Wide ReferenceCut::cost(const CellLabels& labels) const {
  Wide sum = 0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (labels[facets[f].cell] != label_beyond(facets[f], labels)) sum += capacities[f];
  }
  return sum;
}

Wide ReferenceCut::residual(std::size_t facet, bool from_lower) const {
  return from_lower ? capacities[facet] - flow[facet] : capacities[facet] + flow[facet];
}

std::vector<int> ReferenceCut::search(const std::vector<std::size_t>& seeds, bool forward,
                                      int without) const {
  std::vector<int> came_by(anchors.size(), kNotReached);
  for (const std::size_t i : seeds) came_by[i] = kSeed;
  std::deque<std::size_t> queue(seeds.begin(), seeds.end());
  while (!queue.empty()) {
    const std::size_t i = queue.front();
    queue.pop_front();
    for (const std::size_t f : incident[i]) {
      if (static_cast<int>(f) == without) continue;
      const bool lower = facets[f].cell == i;
      const std::size_t next = lower ? head(f) : facets[f].cell;
      if (came_by[next] != kNotReached || residual(f, lower == forward) <= 0) continue;
      came_by[next] = static_cast<int>(f);
      queue.push_back(next);
    }
  }
  return came_by;
}

Wide ReferenceCut::augment(const std::vector<int>& came_by, std::size_t node) {
  std::vector<std::pair<std::size_t, bool>> path;
  while (came_by[node] >= 0) {
    const auto f = static_cast<std::size_t>(came_by[node]);
    const bool from_lower = head(f) == node;
    path.emplace_back(f, from_lower);
    node = from_lower ? facets[f].cell : head(f);
  }
  Wide amount = residual(path.front().first, path.front().second);
  for (const auto& [f, lower] : path) amount = std::min(amount, residual(f, lower));
  for (const auto& [f, lower] : path) flow[f] += lower ? amount : -amount;
  return amount;
}

void ReferenceCut::maximise() {
  const std::vector<std::size_t> sources = nodes_of(Anchor::interior);
  const std::vector<std::size_t> sinks = nodes_of(Anchor::exterior);
  while (true) {
    const std::vector<int> came_by = search(sources, true);
    const auto sink = std::find_if(sinks.begin(), sinks.end(),
                                   [&](std::size_t i) { return came_by[i] != kNotReached; });
    if (sink == sinks.end()) return;
    value += augment(came_by, *sink);
  }
}

void ReferenceCut::solve(Claim& claim) {
  maximise();
  claim.value = static_cast<std::int64_t>(value);
  claim.flow.clear();
  for (const Wide f : flow) claim.flow.push_back(static_cast<std::int64_t>(f));
  const std::vector<int> from_interior = search(nodes_of(Anchor::interior), true);
  const std::vector<int> to_exterior = search(nodes_of(Anchor::exterior), false);
  claim.smallest.clear();
  claim.largest.clear();
  for (std::size_t c = 0; c < outside(); ++c) {
    claim.smallest.push_back(from_interior[c] != kNotReached ? kInterior : kExterior);
    claim.largest.push_back(to_exterior[c] != kNotReached ? kExterior : kInterior);
  }
}

Claim solved(TetComplex complex, CellLabels initial, ExteriorMode mode, Rational lambda,
             double unit, int area_bits) {
  Claim claim{std::move(complex), std::move(initial), mode, lambda, unit, area_bits, {}, 0, {}, {}};
  ReferenceCut(claim).solve(claim);
  return claim;
}

Claim tied_claim(ExteriorMode mode) {
  TetComplex complex = cube_grid({3, 3, 3});
  CellLabels labels = random_labels(complex, 0.35, 7);
  return solved(std::move(complex), std::move(labels), mode, {1, 1}, 3);
}

}  // namespace cellocut::testing
