#include "cellocut/path/path_certificate.h"

#include <algorithm>
#include <cmath>

#include "cellocut/base/errors.h"

namespace cellocut {

PathChecker::PathChecker(const PathTerms& terms) : terms_(terms) {
  wrong_areas_ = find_areas();
  if (wrong_areas_.empty()) wrong_anchors_ = fix_cells();
}

std::string PathChecker::find_areas() {
  if (terms_.initial.size() != terms_.complex.cells.size()) return "labels are not one per cell";
  if (terms_.area_bits < 8 || terms_.area_bits > 50 || !(terms_.unit > 0) ||
      !std::isfinite(terms_.unit)) {
    return "the unit of areas is none";
  }
  facets_ = list_facets(terms_.complex);
  try {
    areas_ = quantise_areas(terms_.complex, facets_, terms_.unit, terms_.area_bits);
  } catch (const LimitError& error) {
    return error.what();
  }
  if (terms_.supported == nullptr) {
    areas_.supported = support_by_labels(facets_, areas_, terms_.initial);
    return {};
  }
  areas_.supported = *terms_.supported;
  if (areas_.supported.size() != facets_.size()) return "support is not one per facet";
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    if (areas_.supported[f] < 0 || areas_.supported[f] > areas_.quantised[f]) {
      return "facet " + std::to_string(f) + " has more support than area";
    }
  }
  return {};
}

std::string PathChecker::fix_cells() {
  anchors_ = anchor_cells(terms_.complex, terms_.initial, terms_.mode);
  for (const auto& [cells, anchor] : {std::pair{&terms_.guided.inside, Anchor::interior},
                                      std::pair{&terms_.guided.outside, Anchor::exterior}}) {
    for (const std::uint32_t cell : *cells) {
      if (cell >= anchors_.size()) return "a guided cell is not there";
      if (anchors_[cell] != Anchor::free && anchors_[cell] != anchor) {
        return "cell " + std::to_string(cell) + " is fixed to both labels";
      }
      anchors_[cell] = anchor;
    }
  }
  return {};
}

// What is supported lies between interior anchors and other cells.
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

void PathChecker::add_flow(const Lambda& lambda, const std::vector<Wide>& facet_flow) {
  if (!wrong_areas_.empty() || !wrong_anchors_.empty()) return;
  if (facet_flow.size() != facets_.size()) return;
  std::vector<Wide> if_exterior(anchors_.size(), 0);  // the least that a free cell adds
  std::vector<Wide> if_interior(anchors_.size(), 0);
  Wide bound = 0;
  const auto border = [&](std::int32_t free, Anchor beyond, Wide cost) {
    (beyond == Anchor::interior ? if_exterior : if_interior)[static_cast<std::size_t>(free)] +=
        cost;
  };
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    const Wide cost = cost_at(areas_of(f), lambda);
    const auto cell = static_cast<std::int32_t>(facets_[f].cell);
    const std::int32_t other = facets_[f].other;
    const Anchor a = anchor(cell);
    const Anchor b = anchor(other);
    if (a == Anchor::free && b == Anchor::free) {
      const Wide flow = facet_flow[f];
      if (flow > cost || -flow > cost) return;
      if_interior[facets_[f].cell] += flow;
      if_interior[static_cast<std::size_t>(other)] -= flow;
    } else if (a == Anchor::free) {
      border(cell, b, cost);
    } else if (b == Anchor::free) {
      border(other, a, cost);
    } else if (a != b) {
      bound += cost;
    }
  }
  for (std::size_t c = 0; c < anchors_.size(); ++c) {
    bound += std::min(if_exterior[c], if_interior[c]);
  }
  bounds_.emplace_back(lambda, bound);
}

// The checks of one path.
class PathCheck {
 public:
  PathCheck(const PathChecker& checker, const CellPath& path, const LambdaInterval& range)
      : checker_(checker), cells_(path), path_(path.path), range_(range), highest_(path.count()) {}

  [[nodiscard]] CertificateReport run() const {
    CertificateReport report;
    bool passed = true;
    using Check = std::pair<const char*, std::string (PathCheck::*)() const>;
    std::vector<Check> checks{{"sizes", &PathCheck::sizes},
                              {"anchors", &PathCheck::anchors},
                              {"areas", &PathCheck::areas},
                              {"breakpoints", &PathCheck::breakpoints}};
    if (path_.nested) {
      checks.emplace_back("capacities", &PathCheck::capacities);
      checks.emplace_back("conservation", &PathCheck::conservation);
    } else {
      checks.emplace_back("flows", &PathCheck::flows);
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
  [[nodiscard]] std::string sizes() const;
  [[nodiscard]] std::string anchors() const;
  [[nodiscard]] std::string areas() const;
  [[nodiscard]] std::string breakpoints() const;
  [[nodiscard]] std::string capacities() const;
  [[nodiscard]] std::string conservation() const;
  [[nodiscard]] std::string flows() const;

  [[nodiscard]] std::size_t level(std::int32_t cell) const {
    return cell == kOutside ? 0 : cells_.level[static_cast<std::size_t>(cell)];
  }
  [[nodiscard]] const Lambda& lambda_of(std::size_t level) const {
    if (level == 0) return path_.first;
    return level == highest_ ? path_.last : path_.breakpoints[level - 1];
  }

  const PathChecker& checker_;
  const CellPath& cells_;
  const FillPath& path_;
  const LambdaInterval& range_;
  std::size_t highest_;
};

std::string PathCheck::sizes() const {
  if (!checker_.wrong_areas_.empty()) return checker_.wrong_areas_;
  if (highest_ == 0 || path_.breakpoints.size() + 1 != highest_) {
    return "labellings and breakpoints do not alternate";
  }
  const std::size_t cells = checker_.terms_.complex.cells.size();
  if (!path_.nested) {
    const auto whole = [cells](const auto& labelling) { return labelling.size() == cells; };
    const auto& interior = cells_.interior;
    const bool sized =
        interior.size() == highest_ && std::all_of(interior.begin(), interior.end(), whole);
    return sized ? "" : "labellings are not one label per cell";
  }
  if (cells_.level.size() != cells) return "levels are not one per cell";
  if (cells_.facet_flow.size() != checker_.facets_.size()) return "flows are not one per facet";
  for (const std::uint32_t level : cells_.level) {
    if (level > highest_) return "a level is above the highest";
  }
  return {};
}

std::string PathCheck::anchors() const {
  if (!checker_.wrong_anchors_.empty()) return checker_.wrong_anchors_;
  for (std::size_t c = 0; c < checker_.anchors_.size(); ++c) {
    if (checker_.anchors_[c] == Anchor::free) continue;
    const bool interior = checker_.anchors_[c] == Anchor::interior;
    bool kept = true;
    if (path_.nested) {
      kept = cells_.level[c] == (interior ? highest_ : 0);
    } else {
      for (std::size_t k = 0; k < highest_; ++k) kept = kept && cells_.holds(k, c) == interior;
    }
    if (!kept) {
      return "cell " + std::to_string(c) +
             (interior ? " is fixed interior and leaves" : " is fixed exterior and is not");
    }
  }
  if (path_.nested != checker_.is_nested()) {
    return std::string("labellings are ") + (path_.nested ? "not " : "") + "nested by this support";
  }
  return {};
}

// Where nested a facet is cut by the labellings between the levels of its two cells.
std::string PathCheck::areas() const {
  if (!path_.nested) {
    for (std::size_t k = 0; k < highest_; ++k) {
      InterfaceAreas found;
      for (std::size_t f = 0; f < checker_.facets_.size(); ++f) {
        const std::int32_t other = checker_.facets_[f].other;
        const bool beyond = other != kOutside && cells_.holds(k, static_cast<std::size_t>(other));
        if (cells_.holds(k, checker_.facets_[f].cell) != beyond) found += checker_.areas_of(f);
      }
      if (!(found == path_.areas[k])) {
        return "the areas of labelling " + std::to_string(k) + " differ";
      }
    }
    return {};
  }
  std::vector<InterfaceAreas> change(highest_ + 1);
  for (std::size_t f = 0; f < checker_.facets_.size(); ++f) {
    const std::size_t a = level(static_cast<std::int32_t>(checker_.facets_[f].cell));
    const std::size_t b = level(checker_.facets_[f].other);
    const InterfaceAreas both = checker_.areas_of(f);
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

std::string PathCheck::breakpoints() const {
  if (path_.first.p < 1 || path_.first.q < 1 || path_.last.q < 1 || !(path_.first < path_.last)) {
    return "the range is none";
  }
  if (!(path_.first == range_.from && path_.last == range_.to)) return "the range is another one";
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

std::string PathCheck::capacities() const {
  for (std::size_t f = 0; f < checker_.facets_.size(); ++f) {
    const auto cell = static_cast<std::int32_t>(checker_.facets_[f].cell);
    const Wide flow = cells_.facet_flow[f];
    const bool within = checker_.anchor(cell) == Anchor::free &&
                        checker_.anchor(checker_.facets_[f].other) == Anchor::free &&
                        level(cell) == level(checker_.facets_[f].other);
    const Wide capacity =
        within ? Wide{lambda_of(level(cell)).p} * checker_.areas_.quantised[f] : 0;
    if (flow > capacity || -flow > capacity) {
      return "facet " + std::to_string(f) + " carries more than it can";
    }
  }
  return {};
}

std::string PathCheck::flows() const {
  const auto is_proved = [&](const Lambda& lambda, const InterfaceAreas& areas) {
    const Wide cost = cost_at(areas, lambda);
    return std::any_of(checker_.bounds_.begin(), checker_.bounds_.end(), [&](const auto& bound) {
      // (Costs are in units that change with the terms of the fraction.)
      return bound.first.p == lambda.p && bound.first.q == lambda.q && bound.second == cost;
    });
  };
  if (!is_proved(path_.first, path_.areas.front())) return "no flow proves the first labelling";
  for (std::size_t k = 0; k + 1 < highest_; ++k) {  // (at which both neighbours cost the same)
    if (!is_proved(path_.breakpoints[k], path_.areas[k])) {
      return "no flow proves the neighbours of breakpoint " + std::to_string(k);
    }
  }
  return is_proved(path_.last, path_.areas.back()) ? "" : "no flow proves the last labelling";
}

std::string PathCheck::conservation() const {
  struct Balance {
    Wide from_source = 0;  // what anchors can give
    Wide to_sink = 0;      // what the exterior can take
    Wide out = 0;          // what goes to free cells, net
  };
  std::vector<Balance> balance(checker_.terms_.complex.cells.size());
  // What facet f means for `cell`; `flow` is that from it to the other.
  const auto add = [&](std::size_t f, std::int32_t cell, std::int32_t other, Wide flow) {
    if (checker_.anchor(cell) != Anchor::free) return;
    Balance& here = balance[static_cast<std::size_t>(cell)];
    const Lambda& lambda = lambda_of(level(cell));
    const Wide area = checker_.areas_.quantised[f];
    if (checker_.anchor(other) == Anchor::interior) {
      here.from_source += cost_at(checker_.areas_of(f), lambda);
    } else if (checker_.anchor(other) == Anchor::exterior) {
      here.to_sink += area * lambda.p;
    } else if (level(cell) == level(other)) {
      here.out += flow;
    } else {
      here.out += area * (level(cell) > level(other) ? lambda.p : -Wide{lambda.p});
    }
  };
  for (std::size_t f = 0; f < checker_.facets_.size(); ++f) {
    const auto cell = static_cast<std::int32_t>(checker_.facets_[f].cell);
    const Wide flow = cells_.facet_flow[f];
    add(f, cell, checker_.facets_[f].other, flow);
    if (checker_.facets_[f].other != kOutside) add(f, checker_.facets_[f].other, cell, -flow);
  }
  for (std::size_t c = 0; c < balance.size(); ++c) {
    if (checker_.anchors_[c] != Anchor::free) continue;
    const Balance& here = balance[c];
    const Wide drawn = here.out + here.to_sink;  // where its facets to the exterior are saturated
    bool kept = false;
    if (cells_.level[c] == 0) {
      kept = here.out <= here.from_source && here.from_source <= drawn;
    } else if (cells_.level[c] == highest_) {
      kept = 0 <= drawn && drawn <= here.from_source;
    } else {
      kept = drawn == here.from_source;
    }
    if (!kept) return "cell " + std::to_string(c) + " draws what it does not pass on";
  }
  return {};
}

CertificateReport PathChecker::check(const CellPath& path, const LambdaInterval& range) const {
  return PathCheck(*this, path, range).run();
}

}  // namespace cellocut
