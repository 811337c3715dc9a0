// Every registered solver on families of problems that do not come from meshes: one value, one
// smallest and one largest source side, each proved by its flow.
#include <gtest/gtest.h>

#include "solvers/comparison.h"
#include "solvers/solvers.h"
#include "support/cut_families.h"

namespace cellocut {
namespace {

class Family : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(Family, AllSolversAgree) {
  solvers::ComparisonOptions options;
  for (const auto& variant : solvers::registered()) {
    if (variant.make != nullptr && variant.make()->info().exact) {
      options.solvers.push_back(variant.name);
    }
  }
  ASSERT_GE(options.solvers.size(), 3U);
  for (const testing::FamilyMember& member : testing::cut_families(2000, GetParam())) {
    SCOPED_TRACE(member.name);
    options.reduce = false;
    auto runs = solvers::compare_solvers(member.problem, options);
    EXPECT_GT(runs.front().result.value, 0);
    // Reduced before the search, they answer the same about the whole problem.
    options.reduce = true;
    for (solvers::SolverRun& run : solvers::compare_solvers(member.problem, options)) {
      runs.push_back(std::move(run));
    }
    EXPECT_EQ(solvers::find_disagreement(runs), "");
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Family, ::testing::Range<std::uint64_t>(1, 9));

TEST(Families, AreTheSameForTheSameSeed) {
  const auto one = testing::cut_families(500, 7);
  const auto again = testing::cut_families(500, 7);
  const auto other = testing::cut_families(500, 8);
  for (std::size_t k = 0; k < one.size(); ++k) {
    SCOPED_TRACE(one[k].name);
    EXPECT_NO_THROW(one[k].problem.validate());
    EXPECT_EQ(cut_cost(one[k].problem, CutLabels(one[k].problem.node_count(), 0)),
              cut_cost(again[k].problem, CutLabels(one[k].problem.node_count(), 0)));
    ASSERT_EQ(one[k].problem.edges.size(), again[k].problem.edges.size());
    bool same_as_other = true;
    for (std::size_t e = 0; e < one[k].problem.edges.size(); ++e) {
      EXPECT_EQ(one[k].problem.edges[e].capacity, again[k].problem.edges[e].capacity);
      same_as_other =
          same_as_other && one[k].problem.edges[e].capacity == other[k].problem.edges[e].capacity;
    }
    EXPECT_FALSE(same_as_other);
  }
}

}  // namespace
}  // namespace cellocut
