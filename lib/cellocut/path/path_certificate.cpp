#include "cellocut/path/path_certificate.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

class PathChecker {
 public:
  explicit PathChecker(const PathClaim& claim)
      : claim_(claim), path_(claim.path.path), highest_(claim.path.count()) {}

  CertificateReport run() {
    CertificateReport report;
    bool passed = true;
    using Check = std::pair<const char*, std::string (PathChecker::*)()>;
    std::vector<Check> checks{{"sizes", &PathChecker::sizes},
                              {"anchors", &PathChecker::anchors},
                              {"areas", &PathChecker::areas},
                              {"breakpoints", &PathChecker::breakpoints}};
    if (path_.nested) {
      checks.emplace_back("capacities", &PathChecker::capacities);
      checks.emplace_back("conservation", &PathChecker::conservation);
    } else {
      checks.emplace_back("flows", &PathChecker::flows);
    }
    for (const auto& [name, check] : checks) {
      std::string defect = passed ? (this->*check)() : "an earlier check failed";
      passed = passed && defect.empty();
      report.checks.push_back({name, defect.empty(), std::move(defect)});
    }
    report.valid = passed;
    return report;
  }

 private:
  // Each returns what is wrong, or nothing.
  std::string sizes();
  std::string anchors();
  std::string areas();
  std::string breakpoints();
  std::string capacities();
  std::string conservation();
  std::string flows();
  [[nodiscard]] bool is_nested() const;
  std::string sizes_of_labellings() const;

  [[nodiscard]] InterfaceAreas areas_of(std::size_t f) const {
    return {areas_.supported[f], areas_.quantised[f] - areas_.supported[f]};
  }
  [[nodiscard]] std::size_t level(std::int32_t cell) const {
    return cell == kOutside ? 0 : claim_.path.level[static_cast<std::size_t>(cell)];
  }
  [[nodiscard]] Anchor anchor(std::int32_t cell) const {
    return cell == kOutside ? Anchor::exterior : anchors_[static_cast<std::size_t>(cell)];
  }
  [[nodiscard]] const Lambda& lambda_of(std::size_t level) const {
    if (level == 0) return path_.first;
    return level == highest_ ? path_.last : path_.breakpoints[level - 1];
  }

  const PathClaim& claim_;
  const FillPath& path_;
  std::size_t highest_;
  std::vector<Anchor> anchors_;  // per cell
  FacetList facets_;
  FacetAreas areas_;
};

std::string PathChecker::sizes() {
  const std::size_t cells = claim_.complex.cells.size();
  if (claim_.initial.size() != cells) return "labels are not one per cell";
  if (claim_.area_bits < 8 || claim_.area_bits > 50 || !(claim_.unit > 0) ||
      !std::isfinite(claim_.unit)) {
    return "the unit of areas is none";
  }
  if (highest_ == 0 || path_.breakpoints.size() + 1 != highest_) {
    return "labellings and breakpoints do not alternate";
  }
  facets_ = list_facets(claim_.complex);
  try {
    areas_ = quantise_areas(claim_.complex, facets_, claim_.unit, claim_.area_bits);
  } catch (const LimitError& error) {
    return error.what();
  }
  if (claim_.supported == nullptr) {
    areas_.supported = support_by_labels(facets_, areas_, claim_.initial);
  } else {
    areas_.supported = *claim_.supported;
    if (areas_.supported.size() != facets_.size()) return "support is not one per facet";
    for (std::size_t f = 0; f < facets_.size(); ++f) {
      if (areas_.supported[f] < 0 || areas_.supported[f] > areas_.quantised[f]) {
        return "facet " + std::to_string(f) + " has more support than area";
      }
    }
  }
  return sizes_of_labellings();
}

std::string PathChecker::sizes_of_labellings() const {
  const std::size_t cells = claim_.complex.cells.size();
  if (!path_.nested) {
    const auto whole = [cells](const auto& labelling) { return labelling.size() == cells; };
    const auto& interior = claim_.path.interior;
    const bool sized =
        interior.size() == highest_ && std::all_of(interior.begin(), interior.end(), whole);
    return sized ? "" : "labellings are not one label per cell";
  }
  if (claim_.path.level.size() != cells) return "levels are not one per cell";
  if (claim_.path.facet_flow.size() != facets_.size()) return "flows are not one per facet";
  for (const std::uint32_t level : claim_.path.level) {
    if (level > highest_) return "a level is above the highest";
  }
  return {};
}

std::string PathChecker::anchors() {
  anchors_ = anchor_cells(claim_.complex, claim_.initial, claim_.mode);
  for (const auto& [cells, anchor] : {std::pair{&claim_.guided.inside, Anchor::interior},
                                      std::pair{&claim_.guided.outside, Anchor::exterior}}) {
    for (const std::uint32_t cell : *cells) {
      if (cell >= anchors_.size()) return "a guided cell is not there";
      if (anchors_[cell] != Anchor::free && anchors_[cell] != anchor) {
        return "cell " + std::to_string(cell) + " is fixed to both labels";
      }
      anchors_[cell] = anchor;
    }
  }
  for (std::size_t c = 0; c < anchors_.size(); ++c) {
    if (anchors_[c] == Anchor::free) continue;
    const bool interior = anchors_[c] == Anchor::interior;
    bool kept = true;
    if (path_.nested) {
      kept = claim_.path.level[c] == (interior ? highest_ : 0);
    } else {
      for (std::size_t k = 0; k < highest_; ++k) kept = kept && claim_.path.holds(k, c) == interior;
    }
    if (!kept) {
      return "cell " + std::to_string(c) +
             (interior ? " is fixed interior and leaves" : " is fixed exterior and is not");
    }
  }
  if (path_.nested != is_nested()) {
    return std::string("labellings are ") + (path_.nested ? "not " : "") + "nested by this support";
  }
  return {};
}

// As ParametricProblem::nested(): what is supported lies between interior anchors and other cells.
bool PathChecker::is_nested() const {
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (areas_.supported[f] == 0) continue;
    const Anchor a = anchor(static_cast<std::int32_t>(facets_[f].cell));
    const Anchor b = anchor(facets_[f].other);
    const bool at_free_cell = a == Anchor::free || b == Anchor::free;
    if (at_free_cell && a != Anchor::interior && b != Anchor::interior) return false;
  }
  return true;
}

// Where nested a facet is cut by the labellings between the levels of its two cells.
std::string PathChecker::areas() {
  if (!path_.nested) {
    for (std::size_t k = 0; k < highest_; ++k) {
      InterfaceAreas found;
      for (std::size_t f = 0; f < facets_.size(); ++f) {
        const std::int32_t other = facets_[f].other;
        const bool beyond =
            other != kOutside && claim_.path.holds(k, static_cast<std::size_t>(other));
        if (claim_.path.holds(k, facets_[f].cell) != beyond) found += areas_of(f);
      }
      if (!(found == path_.areas[k])) {
        return "the areas of labelling " + std::to_string(k) + " differ";
      }
    }
    return {};
  }
  std::vector<InterfaceAreas> change(highest_ + 1);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const std::size_t a = level(static_cast<std::int32_t>(facets_[f].cell));
    const std::size_t b = level(facets_[f].other);
    const InterfaceAreas both = areas_of(f);
    change[std::min(a, b)] += both;
    change[std::max(a, b)] += {-both.supported, -both.unsupported};
  }
  InterfaceAreas now;
  for (std::size_t k = 0; k < highest_; ++k) {
    now += change[k];
    if (!(now == path_.areas[k])) return "the areas of labelling " + std::to_string(k) + " differ";
  }
  return {};
}

std::string PathChecker::breakpoints() {
  if (path_.first.p < 1 || path_.first.q < 1 || path_.last.q < 1 || !(path_.first < path_.last)) {
    return "the range is none";
  }
  for (std::size_t k = 0; k + 1 < highest_; ++k) {
    const Lambda& lambda = path_.breakpoints[k];
    const Lambda& before = k == 0 ? path_.first : path_.breakpoints[k - 1];
    if (lambda.q < 1 || !(before < lambda) || !(lambda < path_.last)) {
      return "breakpoint " + std::to_string(k) + " is out of order";
    }
    if (cost_at(path_.areas[k], lambda) != cost_at(path_.areas[k + 1], lambda)) {
      return "the neighbours of breakpoint " + std::to_string(k) + " cost different amounts";
    }
  }
  return {};
}

std::string PathChecker::capacities() {
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const auto cell = static_cast<std::int32_t>(facets_[f].cell);
    const Wide flow = claim_.path.facet_flow[f];
    const bool within = anchor(cell) == Anchor::free && anchor(facets_[f].other) == Anchor::free &&
                        level(cell) == level(facets_[f].other);
    const Wide capacity = within ? Wide{lambda_of(level(cell)).p} * areas_.quantised[f] : 0;
    if (flow > capacity || -flow > capacity) {
      return "facet " + std::to_string(f) + " carries more than it can";
    }
  }
  return {};
}

std::string PathChecker::flows() {
  // One for each breakpoint and end, and one for each labelling: what the search has solved.
  const std::size_t needed = path_.breakpoints.size() + 2 + highest_;
  return path_.solves >= static_cast<int>(needed) ? "" : "there are fewer flows than breakpoints";
}

std::string PathChecker::conservation() {
  struct Balance {
    Wide from_source = 0;  // what anchors can give
    Wide to_sink = 0;      // what the exterior can take
    Wide out = 0;          // what goes to free cells, net
  };
  std::vector<Balance> balance(claim_.complex.cells.size());
  // What facet f means for `cell`; `flow` is that from it to the other.
  const auto add = [&](std::size_t f, std::int32_t cell, std::int32_t other, Wide flow) {
    if (anchor(cell) != Anchor::free) return;
    Balance& here = balance[static_cast<std::size_t>(cell)];
    const Lambda& lambda = lambda_of(level(cell));
    const Wide area = areas_.quantised[f];
    if (anchor(other) == Anchor::interior) {
      here.from_source += cost_at(areas_of(f), lambda);
    } else if (anchor(other) == Anchor::exterior) {
      here.to_sink += area * lambda.p;
    } else if (level(cell) == level(other)) {
      here.out += flow;
    } else {
      here.out += area * (level(cell) > level(other) ? lambda.p : -Wide{lambda.p});
    }
  };
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const auto cell = static_cast<std::int32_t>(facets_[f].cell);
    const Wide flow = claim_.path.facet_flow[f];
    add(f, cell, facets_[f].other, flow);
    if (facets_[f].other != kOutside) add(f, facets_[f].other, cell, -flow);
  }
  for (std::size_t c = 0; c < balance.size(); ++c) {
    if (anchors_[c] != Anchor::free) continue;
    const Balance& here = balance[c];
    const Wide drawn = here.out + here.to_sink;  // where its facets to the exterior are saturated
    bool kept = false;
    if (claim_.path.level[c] == 0) {
      kept = here.out <= here.from_source && here.from_source <= drawn;
    } else if (claim_.path.level[c] == highest_) {
      kept = 0 <= drawn && drawn <= here.from_source;
    } else {
      kept = drawn == here.from_source;
    }
    if (!kept) return "cell " + std::to_string(c) + " draws what it does not pass on";
  }
  return {};
}

}  // namespace

CertificateReport check_path(const PathClaim& claim) { return PathChecker(claim).run(); }

}  // namespace cellocut
