// The fill path of whole models: against independent cuts, and its certificate against corruption.
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <random>

#include "pipeline_runs.h"
#include "support/defective_meshes.h"

namespace cellocut::testing {
namespace {

constexpr Lambda kFirst{1, 1};
constexpr Lambda kLast{1000, 1};

struct Case {
  std::string name;
  TriangleSoup soup;
  ExteriorMode exterior = ExteriorMode::unbounded;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

std::vector<Case> cases() {
  return {{"bowl", test::open_bowl()},
          {"bowl_hull_cells", test::open_bowl(), ExteriorMode::hull_cells},
          {"sphere_with_hole", test::sphere_with_hole()},
          {"crossing_boxes_hull_cells", test::two_crossing_boxes(), ExteriorMode::hull_cells},
          {"moebius", test::moebius_strip()}};
}

class CellPaths : public ::testing::TestWithParam<Case> {
 protected:
  CellPaths() : options_(at_resolution(64)) {
    options_.exterior = GetParam().exterior;
    options_.lambda_fill = {1, 1};
    result_ = pose_cut(GetParam().soup, options_, *backends::make("cgal"));
    path_ = find_path(result_, kFirst, kLast, *solvers::make("bk"));
  }

  [[nodiscard]] CertificateReport check(const CellPath& path) const {
    return path_checker(result_, options_).check(path, {kFirst, kLast});
  }

  RemeshOptions options_;
  RemeshResult result_;
  CellPath path_;
};

TEST_P(CellPaths, AgreeWithCutsAtRandomLambdas) {
  std::mt19937_64 random(5);
  ASSERT_GE(path_.count(), 2U);
  for (int n = 0; n < 20; ++n) {
    const double exponent = static_cast<double>(random() % 1'000'000) / 1e6;
    const auto numerator = static_cast<std::int64_t>(std::pow(1000.0, exponent) * 1000);
    const Lambda lambda{numerator, 1000};
    RemeshOptions options = options_;
    options.lambda_fill = {lambda.p, lambda.q};
    RemeshResult single = pose_cut(GetParam().soup, options, *backends::make("cgal"));
    minimise_cut(single, options, *solvers::make("ibfs"));
    const std::size_t k = labelling_at(path_.path, lambda);
    EXPECT_TRUE(cost_at(path_.path.areas[k], lambda) == Wide{single.cut.value})
        << "lambda " << to_double(lambda);
    EXPECT_EQ(path_.labels(k), single.largest_interior) << "lambda " << to_double(lambda);
  }
}

TEST_P(CellPaths, AreTheSameForEveryExactSolver) {
  for (const char* name : {"ibfs", "push_relabel"}) {
    const CellPath other = find_path(result_, kFirst, kLast, *solvers::make(name));
    EXPECT_EQ(other.level, path_.level);
    EXPECT_EQ(other.path.areas, path_.path.areas);
    EXPECT_TRUE(other.path.breakpoints == path_.path.breakpoints);
    EXPECT_TRUE(check(other).valid);
  }
}

TEST_P(CellPaths, HaveSolidsThatShrink) {
  const std::vector<PathSolid> solids = path_solids(result_.complex, path_);
  ASSERT_EQ(solids.size(), path_.count());
  for (std::size_t k = 1; k < solids.size(); ++k) EXPECT_LT(solids[k].cells, solids[k - 1].cells);
  for (std::size_t k = 0; k < solids.size(); k += 7) {
    const CellLabels labels = path_.labels(k);
    double volume = 0;
    std::int64_t cells = 0;
    std::int64_t components = 0;
    std::vector<std::uint8_t> seen(labels.size(), 0);
    for (std::uint32_t c = 0; c < labels.size(); ++c) {
      if (labels[c] != kInterior) continue;
      volume += cell_volume(result_.complex, c);
      ++cells;
      if (seen[c] != 0) continue;
      ++components;
      std::vector<std::uint32_t> stack{c};
      seen[c] = 1;
      while (!stack.empty()) {
        const std::uint32_t here = stack.back();
        stack.pop_back();
        for (const std::int32_t other : result_.complex.neighbours[here]) {
          if (other == kOutside || seen[other] != 0 || labels[other] != kInterior) continue;
          seen[other] = 1;
          stack.push_back(static_cast<std::uint32_t>(other));
        }
      }
    }
    EXPECT_NEAR(solids[k].volume, volume, 1e-9 * volume);
    EXPECT_EQ(solids[k].cells, cells);
    EXPECT_EQ(solids[k].components, components);
  }
}

TEST_P(CellPaths, HaveACertificateThatRefusesWhatIsWrong) {
  const CertificateReport report = check(path_);
  for (const CertificateCheck& check : report.checks) {
    EXPECT_TRUE(check.passed) << check.name << ": " << check.detail;
  }
  ASSERT_TRUE(report.valid);
  const auto expect_refused = [&](const std::string& at,  // empty: any
                                  const std::function<void(CellPath&)>& corrupt) {
    CellPath wrong = path_;
    corrupt(wrong);
    const CertificateReport found = check(wrong);
    EXPECT_FALSE(found.valid) << at;
    for (const CertificateCheck& c : found.checks) {
      if (c.passed) continue;
      EXPECT_EQ(c.name, at.empty() ? c.name : at);
      break;
    }
  };
  // A free cell that changes sides within the path.
  std::size_t cell = 0;
  while (path_.level[cell] == 0 || path_.level[cell] == path_.count()) ++cell;
  std::size_t anchored = 0;
  while (result_.anchors[anchored] != Anchor::interior) ++anchored;
  std::size_t carrying = 0;
  while (path_.facet_flow[carrying] == 0) ++carrying;
  expect_refused("sizes", [](CellPath& p) { p.level.pop_back(); });
  expect_refused("sizes", [](CellPath& p) { p.path.breakpoints.pop_back(); });
  expect_refused("anchors", [&](CellPath& p) { --p.level[anchored]; });
  expect_refused("areas", [&](CellPath& p) { ++p.level[cell]; });
  expect_refused("areas", [](CellPath& p) { ++p.path.areas[0].supported; });
  expect_refused("breakpoints", [](CellPath& p) { ++p.path.breakpoints[0].p; });
  expect_refused("breakpoints", [](CellPath& p) { p.path.first = p.path.breakpoints[0]; });
  expect_refused("capacities", [&](CellPath& p) { p.facet_flow[carrying] <<= 60; });
  expect_refused("conservation", [&](CellPath& p) { p.facet_flow[carrying] = 0; });
  // In each kind of zone: what changes sides, what never leaves, what never enters.
  const auto cell_of = [&](std::size_t f) { return result_.facets[f].cell; };
  int kinds = 0;
  for (const auto& kind : std::vector<std::function<bool(std::uint32_t)>>{
           [&](std::uint32_t level) { return level == 0; },
           [&](std::uint32_t level) { return level == path_.count(); },
           [&](std::uint32_t level) { return level > 0 && level < path_.count(); }}) {
    std::size_t f = 0;
    while (f < path_.facet_flow.size() &&
           (path_.facet_flow[f] == 0 || !kind(path_.level[cell_of(f)]))) {
      ++f;
    }
    if (f == path_.facet_flow.size()) continue;  // nothing flows in zones of that kind
    ++kinds;
    expect_refused("", [f](CellPath& p) { p.facet_flow[f] = 1000 * p.facet_flow[f]; });
  }
  EXPECT_GE(kinds, 2);
  // A wider range than the flow is for.
  CellPath wide = path_;
  wide.path.first = {1, 2};
  const CertificateReport wider = path_checker(result_, options_).check(wide, {{1, 2}, kLast});
  EXPECT_TRUE(wider.checks[4].passed) << wider.checks[4].name;
  EXPECT_FALSE(wider.checks[5].passed) << wider.checks[5].name;
  expect_refused("breakpoints", [](CellPath& p) { p.path.first = {1, 2}; });  // or than asked for
  // A labelling that is left out: its zone joins the next one, with areas and crossing to match.
  // (Whether capacities or balances tell first depends on the zones.)
  if (path_.count() >= 3) {
    expect_refused("", [](CellPath& p) {
      for (std::uint32_t& level : p.level) level -= level >= 2 ? 1 : 0;
      p.path.areas.erase(p.path.areas.begin() + 1);
      p.path.breakpoints.erase(p.path.breakpoints.begin());
      p.path.breakpoints[0] = crossing(p.path.areas[0], p.path.areas[1]);
    });
  }
}

// Support measured on facets: labellings are not nested, and each is found on its own.
class CellPathsByFacets : public ::testing::TestWithParam<Case> {
 protected:
  CellPathsByFacets() : options_(at_resolution(48)) {
    options_.exterior = GetParam().exterior;
    options_.support = SupportRule::facets;
    options_.lambda_fill = {1, 1};
    result_ = pose_cut(GetParam().soup, options_, *backends::make("cgal"));
    checker_.emplace(path_checker(result_, options_));
    path_ = find_path(result_, kFirst, kLast, *solvers::make("push_relabel"), silent_observer(),
                      &*checker_);
  }

  RemeshOptions options_;
  RemeshResult result_;
  std::optional<PathChecker> checker_;  // has seen the flows of the path
  CellPath path_;
};

TEST_P(CellPathsByFacets, AgreeWithCutsAtRandomLambdas) {
  ASSERT_GE(path_.count(), 2U);
  ASSERT_FALSE(path_.path.nested);
  std::mt19937_64 random(6);
  const std::vector<PathSolid> solids = path_solids(result_.complex, path_);
  for (int n = 0; n < 20; ++n) {
    const double exponent = static_cast<double>(random() % 1'000'000) / 1e6;
    const Lambda lambda{static_cast<std::int64_t>(std::pow(1000.0, exponent) * 1000), 1000};
    RemeshOptions options = options_;
    options.lambda_fill = {lambda.p, lambda.q};
    RemeshResult single = pose_cut(GetParam().soup, options, *backends::make("cgal"));
    minimise_cut(single, options, *solvers::make("ibfs"));
    EXPECT_TRUE(single.certificate.valid);
    const std::size_t k = labelling_at(path_.path, lambda);
    EXPECT_TRUE(cost_at(path_.path.areas[k], lambda) == Wide{single.cut.value});
    EXPECT_EQ(path_.labels(k), single.largest_interior) << "lambda " << to_double(lambda);
    double volume = 0;
    for (std::uint32_t c = 0; c < single.label.size(); ++c) {
      if (single.largest_interior[c] == kInterior) volume += cell_volume(single.complex, c);
    }
    EXPECT_NEAR(solids[k].volume, volume, 1e-9 * volume);
  }
}

// Flows of the search are no proof where the path has one of its own.
TEST_P(CellPaths, HaveNoCertificateAsIfNotNested) {
  ASSERT_TRUE(check(path_).valid);
  CellPath wrong = path_;
  for (std::size_t k = 0; k < path_.count(); ++k) {
    const CellLabels labels = path_.labels(k);
    wrong.interior.emplace_back(labels.begin(), labels.end());
  }
  wrong.path.nested = false;
  wrong.path.solves = 1000;
  const CertificateReport report = check(wrong);
  EXPECT_FALSE(report.valid);
  EXPECT_FALSE(report.checks[1].passed) << report.checks[1].name;
}

TEST_P(CellPaths, HaveNoCertificateInAUnitThatAreasDoNotFitInto) {
  result_.frame.unit = 1e-200;
  EXPECT_FALSE(check(path_).valid);
}

TEST_P(CellPathsByFacets, HaveACertificateThatRefusesWhatIsWrong) {
  ASSERT_TRUE(checker_->check(path_, {kFirst, kLast}).valid);
  const auto expect_refused = [&](const std::string& at,
                                  const std::function<void(CellPath&)>& corrupt) {
    CellPath wrong = path_;
    corrupt(wrong);
    for (const CertificateCheck& c : checker_->check(wrong, {kFirst, kLast}).checks) {
      if (c.passed) continue;
      EXPECT_EQ(c.name, at);
      return;
    }
    ADD_FAILURE() << at << ": passed";
  };
  std::size_t anchored = 0;
  while (result_.anchors[anchored] != Anchor::interior) ++anchored;
  std::size_t free = 0;
  while (result_.anchors[free] != Anchor::free) ++free;
  expect_refused("sizes", [](CellPath& p) { p.interior.pop_back(); });
  expect_refused("sizes", [](CellPath& p) { p.interior[0].pop_back(); });
  expect_refused("anchors", [&](CellPath& p) { p.interior[0][anchored] = false; });
  expect_refused("areas", [&](CellPath& p) { p.interior[0][free].flip(); });
  expect_refused("areas", [](CellPath& p) { ++p.path.areas[0].supported; });
  expect_refused("breakpoints", [](CellPath& p) { ++p.path.breakpoints[0].p; });
  expect_refused("breakpoints", [](CellPath& p) { p.path.first = {1, 2}; });
  expect_refused("breakpoints", [](CellPath& p) { p.path.last = {1001, 1}; });
  CellPath wide = path_;
  wide.path.first = {1, 2};
  EXPECT_FALSE(checker_->check(wide, {{1, 2}, kLast}).checks.back().passed);
  // A labelling that is left out, with areas and crossing to match.
  ASSERT_GE(path_.count(), 3U);
  for (std::size_t k = 1; k + 1 < path_.count(); ++k) {
    expect_refused("flows", [k](CellPath& p) {
      const auto gone = static_cast<std::ptrdiff_t>(k);
      p.interior.erase(p.interior.begin() + gone);
      p.path.areas.erase(p.path.areas.begin() + gone);
      p.path.breakpoints.erase(p.path.breakpoints.begin() + gone);
      p.path.breakpoints[k - 1] = crossing(p.path.areas[k - 1], p.path.areas[k]);
    });
  }
  // Without the first labelling, or the last, the range ends where they do.
  expect_refused("flows", [](CellPath& p) {
    p.interior.erase(p.interior.begin());
    p.path.areas.erase(p.path.areas.begin());
    p.path.breakpoints.erase(p.path.breakpoints.begin());
  });
  expect_refused("flows", [](CellPath& p) {
    p.interior.pop_back();
    p.path.areas.pop_back();
    p.path.breakpoints.pop_back();
  });
}

TEST_P(CellPathsByFacets, AreProvedByMaximumFlowsAlone) {
  const auto is_proved = [&](const std::function<void(std::vector<Wide>&)>& change) {
    PathChecker checker = path_checker(result_, options_);
    find_cell_path(result_.graph, result_.facets, result_.areas, kFirst, kLast,
                   *solvers::make("push_relabel"), silent_observer(),
                   [&](const Lambda& lambda, std::vector<Wide> flow) {
                     change(flow);
                     checker.add_flow(lambda, flow);
                   });
    return checker.check(path_, {kFirst, kLast}).valid;
  };
  EXPECT_TRUE(is_proved([](std::vector<Wide>&) {}));
  EXPECT_FALSE(is_proved([](std::vector<Wide>& flow) { flow.clear(); }));
  EXPECT_FALSE(is_proved([](std::vector<Wide>& flow) { flow.assign(flow.size(), 0); }));
  EXPECT_FALSE(is_proved([](std::vector<Wide>& flow) {  // more than capacities allow
    for (Wide& f : flow) f *= 1000;
  }));
  EXPECT_FALSE(
      path_checker(result_, options_).check(path_, {kFirst, kLast}).valid);  // has seen none
}

// A flow that breaks capacities may have the bound that a wrong labelling costs: here a maximum
// flow where edges between free cells are a thousand times as wide.
TEST_P(CellPathsByFacets, AreNotProvedByFlowsThatAreTooLarge) {
  constexpr Lambda kNear{1001, 1000};
  PathChecker checker = path_checker(result_, options_);
  std::vector<CutLabels> sides;
  for (const Lambda& lambda : {kFirst, kNear}) {
    CellGraph graph = build_cell_graph(result_.complex, result_.facets, result_.areas,
                                       result_.anchors, {lambda.p, lambda.q});
    for (CutEdge& edge : graph.problem.edges) {
      edge.capacity *= 1000;
      edge.reverse_capacity *= 1000;
    }
    const CutResult cut = solvers::make("push_relabel")->solve(graph.problem);
    std::vector<Wide> flow(result_.facets.size(), 0);
    for (std::size_t e = 0; e < cut.edge_flow.size(); ++e) {
      flow[graph.edge_facet[e]] = cut.edge_flow[e];
    }
    checker.add_flow(lambda, flow);
    sides.push_back(cut.largest_source_side);
  }
  ASSERT_EQ(sides[0], sides[1]);
  CellPath wrong;
  wrong.path.nested = false;
  wrong.path.first = kFirst;
  wrong.path.last = kNear;
  const CellLabels labels = expand_labels(result_.graph, sides[0]);
  std::vector<bool> interior(labels.size());
  for (std::size_t c = 0; c < labels.size(); ++c) interior[c] = labels[c] == kInterior;
  wrong.interior.push_back(std::move(interior));
  const ParametricProblem problem =
      make_parametric_problem(result_.graph, result_.facets, result_.areas);
  wrong.path.areas.push_back(areas_of(problem, sides[0]));
  ASSERT_GT(cost_at(wrong.path.areas[0], kFirst), cost_at(path_.path.areas[0], kFirst));
  const CertificateReport report = checker.check(wrong, {kFirst, kNear});
  for (const CertificateCheck& check : report.checks) {
    EXPECT_EQ(check.passed, check.name != "flows") << check.name << ": " << check.detail;
  }
}

TEST_P(CellPathsByFacets, ACutWithOtherSupportThanClaimedIsRefused) {
  options_.lambda_fill = {20, 1};  // at 1 support makes no difference
  result_ = pose_cut(GetParam().soup, options_, *backends::make("cgal"));
  minimise_cut(result_, options_, *solvers::make("bk"));
  ASSERT_TRUE(result_.certificate.valid);
  ASSERT_NE(result_.areas.supported,
            support_by_labels(result_.facets, result_.areas, result_.initial_label));
  RemeshOptions by_labels = options_;
  by_labels.support = SupportRule::labels;  // the checker derives support from L*
  adopt_cut(result_, by_labels, result_.cut);
  EXPECT_FALSE(result_.certificate.valid);
  result_.areas.supported[0] = result_.areas.quantised[0] + 1;
  adopt_cut(result_, options_, result_.cut);
  ASSERT_FALSE(result_.certificate.valid);
  EXPECT_FALSE(result_.certificate.checks[1].passed);  // capacities
}

INSTANTIATE_TEST_SUITE_P(Pipeline, CellPathsByFacets,
                         ::testing::Values(Case{"bowl", test::open_bowl()},
                                           Case{"boxes_hull_cells", test::two_crossing_boxes(),
                                                ExteriorMode::hull_cells}),
                         [](const ::testing::TestParamInfo<Case>& c) { return c.param.name; });

INSTANTIATE_TEST_SUITE_P(Pipeline, CellPaths, ::testing::ValuesIn(cases()),
                         [](const ::testing::TestParamInfo<Case>& c) { return c.param.name; });

}  // namespace
}  // namespace cellocut::testing
