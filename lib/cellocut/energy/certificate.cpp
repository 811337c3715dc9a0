// The checker of a minimum-cut certificate.
//
// Notation. The nodes are the cells and one more node, the outside. S is the set of interior
// anchors, T that of the exterior anchors with the outside in it. A facet f between cells c < d (or
// c and the outside) has one capacity u_f in both directions and carries the net flow x_f from c to
// d.
//
// Why the checks are a proof. Where |x_f| <= u_f everywhere and no free cell gains or loses, the
// net flow out of S equals the net flow across the interface of any labelling that keeps S interior
// and T exterior, and so is at most what that labelling costs (weak duality). Hence a labelling
// that costs as much is a minimum. The residual arc c -> d is open iff x_f < u_f, d -> c iff x_f >
// -u_f. What S reaches over open arcs is interior in every minimum, what reaches T is exterior in
// every minimum, and both sets are the same for every maximum flow (Ford and Fulkerson 1962; Picard
// and Queyranne 1980). If S reaches T, the flow was not maximal.
//
// Everything is derived here from the complex, L*, the mode, lambda and the flow. Nothing is taken
// from the functions of energy.h, the cut problem, its contraction or the solvers: what they have
// in common would not be checked. Flows between two anchors of one kind change nothing but must
// obey capacities.
#include "cellocut/energy/certificate.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "cellocut/base/first_index.h"
#include "cellocut/base/point.h"
#include "cellocut/base/wide_text.h"

namespace cellocut {

namespace {

// (Wide: capacities reach 2^70 (area_bits 50, lambda 2^20), sums of them 2^72; 64 bits would wrap.)

// What one check found.
struct Finding {
  bool passed = false;
  std::string detail;
};

Finding failed(std::string detail) { return {false, std::move(detail)}; }

// The sum of term(index) over all below `count`; in parallel.
template <class Term>
Wide sum_of(std::size_t count, const Term& term) {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, count, 1024), Wide{0},
      [&](const auto& range, Wide sum) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) sum += term(i);
        return sum;
      },
      std::plus<>());
}

// A facet as the checker sees it: the side `corner` of `cell`.
struct Side {
  std::uint32_t cell = 0;
  std::uint8_t corner = 0;
};

class Checker {
 public:
  explicit Checker(const CertificateClaim& claim) : claim_(claim), complex_(claim.complex) {}

  // What the user's points fix.
  enum class Guided : std::uint8_t { no, inside, outside };

  CertificateReport run();

 private:
  Finding check_sizes();
  Finding check_capacities();
  Finding check_conservation() const;
  Finding check_anchors() const;
  Finding check_energy(const CellLabels& labels) const;
  Finding check_flow_value() const;
  Finding check_canonical(bool from_interior, const CellLabels& labels) const;

  std::string parameter_defect() const;
  std::string complex_defect() const;
  std::string match_facets();
  std::string match_guided();
  std::string quantise();
  std::string cell_name(std::int64_t cell) const;

  std::size_t cell_count() const { return complex_.cells.size(); }
  std::int32_t neighbour(std::size_t cell, int k) const { return complex_.neighbours[cell][k]; }
  // L* of a cell or of the outside.
  std::uint8_t initial(std::int32_t cell) const {
    return cell == kOutside ? kExterior : claim_.initial[static_cast<std::size_t>(cell)];
  }
  bool interior_anchor(std::size_t cell) const {
    return (claim_.unary && claim_.initial[cell] == kInterior) || guided_[cell] == Guided::inside;
  }
  bool exterior_anchor(std::size_t cell) const;
  std::array<std::uint32_t, 3> corners_of(std::size_t cell, int k) const;
  std::uint32_t facet_of(std::size_t cell, int k) const { return facet_of_side_[4 * cell + k]; }
  // The flow that leaves `cell` across its facet k.
  Wide flow_out(std::size_t cell, int k) const;
  Wide net_flow_out(std::size_t cell) const;

  const CertificateClaim& claim_;
  const TetComplex& complex_;
  std::vector<Guided> guided_;                // per cell
  std::vector<Side> facets_;                  // ascending by (lower cell, corner)
  std::vector<std::uint32_t> facet_of_side_;  // [4 * cell + corner], both sides of a facet
  std::vector<Wide> capacities_;              // per facet
};

bool Checker::exterior_anchor(std::size_t cell) const {
  if (guided_[cell] == Guided::outside) return true;
  if (claim_.mode != ExteriorMode::hull_cells || claim_.initial[cell] != kExterior) return false;
  const auto& around = complex_.neighbours[cell];
  return std::find(around.begin(), around.end(), kOutside) != around.end();
}

std::array<std::uint32_t, 3> Checker::corners_of(std::size_t cell, int k) const {
  std::array<std::uint32_t, 3> corners{};
  for (int i = 0, n = 0; i < 4; ++i) {
    if (i != k) corners[n++] = complex_.cells[cell][i];
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

Wide Checker::flow_out(std::size_t cell, int k) const {
  const std::uint32_t f = facet_of(cell, k);
  const Wide flow = claim_.facet_flow[f];
  return facets_[f].cell == cell ? flow : -flow;
}

Wide Checker::net_flow_out(std::size_t cell) const {
  Wide net = 0;
  for (int k = 0; k < 4; ++k) net += flow_out(cell, k);
  return net;
}

std::string Checker::cell_name(std::int64_t cell) const {
  return cell == kOutside ? "the outside" : "cell " + std::to_string(cell);
}

std::string Checker::parameter_defect() const {
  constexpr std::int64_t kLargestTerm = std::int64_t{1} << 20;
  const Rational& lambda = claim_.lambda;
  if (lambda.numerator < 1 || lambda.numerator > kLargestTerm || lambda.denominator < 1 ||
      lambda.denominator > kLargestTerm) {
    return "lambda " + std::to_string(lambda.numerator) + "/" + std::to_string(lambda.denominator) +
           " is out of range";
  }
  if (claim_.area_bits < 8 || claim_.area_bits > 50) {
    return "area_bits " + std::to_string(claim_.area_bits) + " is out of range";
  }
  if (!(claim_.unit > 0) || !std::isfinite(claim_.unit)) return "the unit is not a length";
  if (claim_.mode != ExteriorMode::unbounded && claim_.mode != ExteriorMode::hull_cells) {
    return "the exterior mode is unknown";
  }
  const std::pair<const char*, const CellLabels*> labellings[] = {
      {"initial", &claim_.initial},
      {"smallest", &claim_.smallest_interior},
      {"largest", &claim_.largest_interior}};
  for (const auto& [name, labels] : labellings) {
    if (labels->size() != cell_count()) {
      return std::to_string(labels->size()) + " " + name + " labels for " +
             std::to_string(cell_count()) + " cells";
    }
    for (std::size_t c = 0; c < cell_count(); ++c) {
      if ((*labels)[c] != kInterior && (*labels)[c] != kExterior) {
        return std::string("the ") + name + " label of cell " + std::to_string(c) + " is " +
               std::to_string((*labels)[c]);
      }
    }
  }
  return {};
}

// Where each cell is fixed, to one label.
std::string Checker::match_guided() {
  guided_.assign(cell_count(), Guided::no);
  for (const auto& [cells, label] : {std::pair{&claim_.guided.inside, Guided::inside},
                                     std::pair{&claim_.guided.outside, Guided::outside}}) {
    for (const std::uint32_t cell : *cells) {
      if (cell >= cell_count()) return "a guided cell is not there";
      const bool contrary =
          label == Guided::outside ? interior_anchor(cell) : exterior_anchor(cell);
      if (guided_[cell] == Guided::no && !contrary) {
        guided_[cell] = label;
      } else if (guided_[cell] != label) {
        return "cell " + std::to_string(cell) + " is fixed to both labels";
      }
    }
  }
  return {};
}

std::string Checker::complex_defect() const {
  if (complex_.neighbours.size() != cell_count()) {
    return std::to_string(complex_.neighbours.size()) + " neighbour entries for " +
           std::to_string(cell_count()) + " cells";
  }
  // Cells are signed 32-bit in `neighbours`, sides of cells unsigned 32-bit here.
  if (cell_count() > std::numeric_limits<std::uint32_t>::max() / 4) return "too many cells";
  for (std::size_t c = 0; c < cell_count(); ++c) {
    for (int k = 0; k < 4; ++k) {
      if (complex_.cells[c][k] >= complex_.points.size()) {
        return "cell " + std::to_string(c) + " has a corner that is not there";
      }
      const std::int64_t other = neighbour(c, k);
      if (other < kOutside || other >= static_cast<std::int64_t>(cell_count()) ||
          other == static_cast<std::int64_t>(c)) {
        return "cell " + std::to_string(c) + " has a neighbour that is not there";
      }
    }
  }
  return {};
}

// Names every facet once, in the order of the claim, and finds it from both of its sides. Both
// cells must agree on who is beyond a facet and on its corners: a one-sided neighbour would let
// flow vanish.
std::string Checker::match_facets() {
  // The lower of two cells names the facet between them.
  const auto names = [this](std::size_t c, int k) {
    const std::int32_t other = neighbour(c, k);
    return other == kOutside || static_cast<std::size_t>(other) > c;
  };
  facet_of_side_.resize(4 * cell_count());
  std::uint32_t facets = 0;
  for (std::size_t c = 0; c < cell_count(); ++c) {
    for (int k = 0; k < 4; ++k) {
      if (names(c, k)) facet_of_side_[4 * c + k] = facets++;
    }
  }
  facets_.resize(facets);
  // Each side of a cell must be one side, and one alone, of the cell beyond: matched in both
  // directions, no side is left over or taken twice.
  const std::size_t unmatched = first_index(cell_count(), [&](std::size_t c) {
    for (int k = 0; k < 4; ++k) {
      const std::int32_t other = neighbour(c, k);
      if (names(c, k)) {
        facets_[facet_of(c, k)] = {static_cast<std::uint32_t>(c), static_cast<std::uint8_t>(k)};
      }
      if (other == kOutside) continue;
      const auto beyond = static_cast<std::size_t>(other);
      int matches = 0;
      int match = 0;
      for (int j = 0; j < 4; ++j) {
        if (neighbour(beyond, j) != static_cast<std::int32_t>(c)) continue;
        if (corners_of(beyond, j) != corners_of(c, k)) continue;
        match = j;
        ++matches;
      }
      if (matches != 1) return true;
      if (!names(c, k)) facet_of_side_[4 * c + k] = facet_of(beyond, match);
    }
    return false;
  });
  if (unmatched == cell_count()) return {};
  return "cell " + std::to_string(unmatched) + " does not match its neighbours";
}

Finding Checker::check_sizes() {
  std::string defect = parameter_defect();
  if (defect.empty()) defect = complex_defect();
  if (defect.empty()) defect = match_facets();
  if (defect.empty()) defect = match_guided();
  if (!defect.empty()) return failed(std::move(defect));
  if (claim_.supported != nullptr && claim_.supported->size() != facets_.size()) {
    return failed(std::to_string(claim_.supported->size()) + " supported areas for " +
                  std::to_string(facets_.size()) + " facets");
  }
  if (claim_.facet_flow.size() != facets_.size()) {
    return failed(std::to_string(claim_.facet_flow.size()) + " flows for " +
                  std::to_string(facets_.size()) + " facets");
  }
  return {true,
          std::to_string(cell_count()) + " cells, " + std::to_string(facets_.size()) + " facets"};
}

// Areas, quantised as energy.h documents, and from them the capacities. The largest power of two is
// sought from above on integer sums alone: at the first exponent the largest facet exceeds the
// limit by itself, and where it no longer yields one quantum the sum is the number of facets.
std::string Checker::quantise() {
  capacities_.assign(facets_.size(), 0);
  if (facets_.empty()) return {};
  std::vector<double> areas(facets_.size());
  const std::size_t endless = first_index(facets_.size(), [&](std::size_t f) {
    const auto [i, j, k] = corners_of(facets_[f].cell, facets_[f].corner);
    const Point3& a = complex_.points[i];
    const Point3 normal = cross(complex_.points[j] - a, complex_.points[k] - a);
    areas[f] = 0.5 * std::sqrt(dot(normal, normal)) / (claim_.unit * claim_.unit);
    return !std::isfinite(areas[f]);
  });
  if (endless < facets_.size()) return "facet " + std::to_string(endless) + " has no finite area";
  const double largest = *std::max_element(areas.begin(), areas.end());
  if (largest == 0) return "no facet has an area";

  const std::int64_t limit = std::int64_t{1} << claim_.area_bits;
  int magnitude = 0;  // largest in [2^(magnitude - 1), 2^magnitude)
  std::frexp(largest, &magnitude);
  for (int exponent = claim_.area_bits - magnitude + 2;; --exponent) {
    // In two steps, since areas may be so small that their scale is no double.
    const double first_scale = std::ldexp(1.0, exponent / 2);
    const double second_scale = std::ldexp(1.0, exponent - exponent / 2);
    const Wide sum = sum_of(facets_.size(), [&](std::size_t f) -> Wide {
      // At most 2^(area_bits + 2): whole numbers of quanta and halves of them are exact.
      const double scaled = areas[f] * first_scale * second_scale;
      const auto whole = static_cast<std::int64_t>(scaled);
      const std::int64_t quanta = scaled - static_cast<double>(whole) >= 0.5 ? whole + 1 : whole;
      return capacities_[f] = std::max(std::int64_t{1}, quanta);
    });
    if (sum <= limit) break;
    if (exponent + magnitude < -1) return "even one quantum a facet exceeds 2^area_bits";
  }
  const Wide numerator = claim_.lambda.numerator;
  const Wide denominator = claim_.lambda.denominator;
  const std::size_t beyond_area = first_index(facets_.size(), [&](std::size_t f) {
    if (claim_.supported == nullptr) {
      const auto [cell, corner] = facets_[f];
      const bool differ = claim_.initial[cell] != initial(neighbour(cell, corner));
      capacities_[f] *= differ ? denominator : numerator;
      return false;
    }
    const Wide supported = (*claim_.supported)[f];
    if (supported < 0 || supported > capacities_[f]) return true;
    capacities_[f] = supported * denominator + (capacities_[f] - supported) * numerator;
    return false;
  });
  if (beyond_area == facets_.size()) return {};
  return "facet " + std::to_string(beyond_area) + " has more support than area";
}

Finding Checker::check_capacities() {
  std::string defect = quantise();
  if (!defect.empty()) {
    capacities_.clear();
    return failed(std::move(defect));
  }
  const auto magnitude = [this](std::size_t f) {
    const Wide flow = claim_.facet_flow[f];
    return flow < 0 ? -flow : flow;
  };
  const std::size_t over =
      first_index(facets_.size(), [&](std::size_t f) { return magnitude(f) > capacities_[f]; });
  if (over < facets_.size()) {
    const auto [cell, corner] = facets_[over];
    return failed("facet " + std::to_string(over) + " between cell " + std::to_string(cell) +
                  " and " + cell_name(neighbour(cell, corner)) + " carries " +
                  to_decimal(claim_.facet_flow[over]) + ", its capacity is " +
                  to_decimal(capacities_[over]));
  }
  const Wide saturated = sum_of(facets_.size(), [&](std::size_t f) -> Wide {
    return magnitude(f) == capacities_[f] ? 1 : 0;
  });
  return {true,
          to_decimal(saturated) + " of " + std::to_string(facets_.size()) + " facets saturated"};
}

Finding Checker::check_conservation() const {
  std::size_t free_cells = 0;
  for (std::size_t c = 0; c < cell_count(); ++c) {
    if (interior_anchor(c) || exterior_anchor(c)) continue;
    ++free_cells;
    const Wide net = net_flow_out(c);
    if (net != 0) {
      return failed("free cell " + std::to_string(c) + " has a net outflow of " + to_decimal(net));
    }
  }
  return {true, std::to_string(free_cells) + " free cells"};
}

Finding Checker::check_anchors() const {
  std::size_t interior = 0;
  std::size_t exterior = 0;
  for (std::size_t c = 0; c < cell_count(); ++c) {
    const bool inside = interior_anchor(c);
    if (!inside && !exterior_anchor(c)) continue;
    ++(inside ? interior : exterior);
    const std::uint8_t kept = inside ? kInterior : kExterior;
    if (claim_.smallest_interior[c] == kept && claim_.largest_interior[c] == kept) continue;
    return failed(std::string(inside ? "interior" : "exterior") + " anchor " + std::to_string(c) +
                  " is given up");
  }
  return {true, std::to_string(interior) + " interior, " + std::to_string(exterior) +
                    " exterior and the outside"};
}

Finding Checker::check_energy(const CellLabels& labels) const {
  Wide energy = 0;
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const auto [cell, corner] = facets_[f];
    const std::int32_t other = neighbour(cell, corner);
    const std::uint8_t beyond =
        other == kOutside ? kExterior : labels[static_cast<std::size_t>(other)];
    if (labels[cell] != beyond) energy += capacities_[f];
  }
  return {energy == claim_.value,
          "energy " + to_decimal(energy) + ", claimed " + to_decimal(claim_.value)};
}

Finding Checker::check_flow_value() const {
  Wide flow = 0;
  for (std::size_t c = 0; c < cell_count(); ++c) {
    if (interior_anchor(c)) flow += net_flow_out(c);
  }
  return {flow == claim_.value,
          "flow " + to_decimal(flow) + ", claimed " + to_decimal(claim_.value)};
}

// Marks what the interior anchors reach over open residual arcs (from_interior), or what reaches
// the exterior anchors and the outside, and compares it with the labelling that it determines.
Finding Checker::check_canonical(bool from_interior, const CellLabels& labels) const {
  std::vector<std::uint8_t> marked(cell_count(), 0);
  std::vector<std::uint32_t> stack;
  const auto mark = [&](std::size_t cell) {
    if (marked[cell] != 0) return;
    marked[cell] = 1;
    stack.push_back(static_cast<std::uint32_t>(cell));
  };
  for (std::size_t c = 0; c < cell_count(); ++c) {
    if (from_interior ? interior_anchor(c) : exterior_anchor(c)) mark(c);
    if (from_interior) continue;
    // The outside is a seed as well: cells with an open arc to it.
    for (int k = 0; k < 4; ++k) {
      if (neighbour(c, k) == kOutside && flow_out(c, k) < capacities_[facet_of(c, k)]) mark(c);
    }
  }
  while (!stack.empty()) {
    const std::uint32_t cell = stack.back();
    stack.pop_back();
    if (from_interior ? exterior_anchor(cell) : interior_anchor(cell)) {
      return failed("the flow is not maximal: an augmenting path passes through cell " +
                    std::to_string(cell));
    }
    for (int k = 0; k < 4; ++k) {
      const std::int32_t other = neighbour(cell, k);
      const Wide capacity = capacities_[facet_of(cell, k)];
      const Wide flow = flow_out(cell, k);
      // The arc cell -> other, or other -> cell where the search runs against the arcs.
      if ((from_interior ? flow : -flow) >= capacity) continue;
      if (other != kOutside) {
        mark(static_cast<std::size_t>(other));
      } else if (from_interior) {
        return failed("the flow is not maximal: an augmenting path leaves the hull at cell " +
                      std::to_string(cell));
      }
    }
  }
  std::size_t interior = 0;
  for (std::size_t c = 0; c < cell_count(); ++c) {
    const std::uint8_t label = (marked[c] != 0) == from_interior ? kInterior : kExterior;
    if (label != labels[c]) {
      return failed("cell " + std::to_string(c) + " is " +
                    (label == kInterior ? "interior" : "exterior") + " by residual reachability");
    }
    interior += label == kInterior ? 1 : 0;
  }
  return {true, std::to_string(interior) + " interior cells"};
}

CertificateReport Checker::run() {
  CertificateReport report;
  struct Check {
    const char* name;
    const char* obstacle;  // nullptr: none
    std::function<Finding()> run;
  };
  // All of them at once: they only read, but for one that is alone. Whether all passed.
  const auto add = [&](const std::vector<Check>& checks) {
    std::vector<Finding> found(checks.size());
    tbb::parallel_for(std::size_t{0}, checks.size(), [&](std::size_t n) {
      const Check& check = checks[n];
      found[n] = check.obstacle == nullptr ? check.run()
                                           : failed(std::string("not checked: ") + check.obstacle);
    });
    for (std::size_t n = 0; n < checks.size(); ++n) {
      report.checks.push_back({checks[n].name, found[n].passed, std::move(found[n].detail)});
    }
    return std::all_of(report.checks.end() - static_cast<std::ptrdiff_t>(checks.size()),
                       report.checks.end(),
                       [](const CertificateCheck& check) { return check.passed; });
  };
  const bool sizes = add({{"sizes", nullptr, [&] { return check_sizes(); }}});
  const char* const no_sizes = sizes ? nullptr : "the sizes are wrong";
  const bool capacities = add({{"capacities", no_sizes, [&] { return check_capacities(); }}});
  const bool priced = sizes && capacities_.size() == facets_.size();
  const char* const no_areas = priced ? nullptr : "the capacities are unknown";
  add({{"conservation", no_sizes, [&] { return check_conservation(); }},
       {"anchors", no_sizes, [&] { return check_anchors(); }},
       {"smallest_energy", no_areas, [&] { return check_energy(claim_.smallest_interior); }},
       {"largest_energy", no_areas, [&] { return check_energy(claim_.largest_interior); }},
       {"flow_value", no_sizes, [&] { return check_flow_value(); }}});
  const bool feasible = capacities && report.checks[2].passed;
  const char* const no_flow = feasible ? nullptr : "the flow is not feasible";
  add({{"smallest_canonical", no_flow,
        [&] { return check_canonical(true, claim_.smallest_interior); }},
       {"largest_canonical", no_flow,
        [&] { return check_canonical(false, claim_.largest_interior); }}});

  report.valid = std::all_of(report.checks.begin(), report.checks.end(),
                             [](const CertificateCheck& check) { return check.passed; });
  return report;
}

}  // namespace

CertificateReport check_certificate(const CertificateClaim& claim) { return Checker(claim).run(); }

}  // namespace cellocut
