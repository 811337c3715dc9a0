#include "cellocut/path/path_certificate.h"

#include <cmath>
#include <string>
#include <utility>

namespace cellocut {

namespace {

class PathChecker {
 public:
  explicit PathChecker(const PathClaim& claim)
      : claim_(claim), path_(claim.path.path), highest_(claim.path.count()) {}

  CertificateReport run() {
    CertificateReport report;
    bool passed = true;
    for (const auto& [name, check] :
         {std::pair{"sizes", &PathChecker::sizes}, std::pair{"anchors", &PathChecker::anchors},
          std::pair{"areas", &PathChecker::areas},
          std::pair{"breakpoints", &PathChecker::breakpoints},
          std::pair{"capacities", &PathChecker::capacities},
          std::pair{"conservation", &PathChecker::conservation}}) {
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
  if (claim_.initial.size() != cells || claim_.path.level.size() != cells) {
    return "labels or levels are not one per cell";
  }
  if (claim_.area_bits < 8 || claim_.area_bits > 50 || !(claim_.unit > 0) ||
      !std::isfinite(claim_.unit)) {
    return "the unit of areas is none";
  }
  if (highest_ == 0 || path_.breakpoints.size() + 1 != highest_) {
    return "labellings and breakpoints do not alternate";
  }
  facets_ = list_facets(claim_.complex);
  areas_ = quantise_areas(claim_.complex, facets_, claim_.unit, claim_.area_bits);
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
    if (anchors_[c] == Anchor::interior && claim_.path.level[c] != highest_) {
      return "cell " + std::to_string(c) + " is fixed interior and leaves";
    }
    if (anchors_[c] == Anchor::exterior && claim_.path.level[c] != 0) {
      return "cell " + std::to_string(c) + " is fixed exterior and is not";
    }
  }
  return {};
}

// A facet is cut by the labellings between the levels of its two cells.
std::string PathChecker::areas() {
  std::vector<InterfaceAreas> change(highest_ + 1);
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const std::size_t a = level(static_cast<std::int32_t>(facets_[f].cell));
    const std::size_t b = level(facets_[f].other);
    std::int64_t InterfaceAreas::*kind = is_supported(facets_[f], claim_.initial)
                                             ? &InterfaceAreas::supported
                                             : &InterfaceAreas::unsupported;
    change[std::min(a, b)].*kind += areas_.quantised[f];
    change[std::max(a, b)].*kind -= areas_.quantised[f];
  }
  InterfaceAreas now;
  for (std::size_t k = 0; k < highest_; ++k) {
    now.supported += change[k].supported;
    now.unsupported += change[k].unsupported;
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
      here.from_source += area * (is_supported(facets_[f], claim_.initial) ? lambda.q : lambda.p);
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
