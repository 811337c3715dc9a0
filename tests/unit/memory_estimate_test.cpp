// The estimate follows what costs memory; how near it comes is measured in docs/performance.md.
#include "cellocut/memory_estimate.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "cellocut/base/errors.h"
#include "cellocut/pipeline.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut {
namespace {

RemeshOptions at(int resolution) {
  RemeshOptions options;
  options.resolution = resolution;
  return options;
}

std::int64_t fixed_part(const TriangleSoup& soup) {
  RemeshOptions none = at(8);
  // Next to no cell of eight steps is met by a mesh eight steps wide.
  none.decimation.removed_share = 0.99;
  return estimate_memory(soup, none);
}

TEST(MemoryEstimate, GrowsWithTheAreaInGridSteps) {
  const TriangleSoup sphere = test::icosphere(4, 1, {0, 0, 0});
  const auto growing = [&](int resolution) {
    return static_cast<double>(estimate_memory(sphere, at(resolution)) - fixed_part(sphere));
  };
  EXPECT_NEAR(growing(1024) / growing(512), 4, 0.3);
  EXPECT_NEAR(growing(4096) / growing(1024), 16, 0.5);
}

TEST(MemoryEstimate, CountsSpaceOnceAndFacesEach) {
  const TriangleSoup sphere = test::icosphere(4, 1, {0, 0, 0});
  TriangleSoup twice = sphere;
  test::append(twice, sphere);
  const std::int64_t more = estimate_memory(twice, at(512)) - estimate_memory(sphere, at(512));
  EXPECT_GT(more, 100 * static_cast<std::int64_t>(sphere.triangles.size()));
  EXPECT_LT(more, 1000 * static_cast<std::int64_t>(sphere.triangles.size()));
}

// A needle becomes a pipe: what counts is the area of phi = 0.
TEST(MemoryEstimate, GrowsWithEpsilonWhereThatIsWide) {
  TriangleSoup needle;
  needle.points = {{0, 0, 0}, {1, 0, 0}, {1, 1e-6, 0}};
  needle.triangles = {{0, 1, 2}};
  const auto with_epsilon = [&](double epsilon) {
    RemeshOptions options = at(512);
    options.epsilon = epsilon;
    return static_cast<double>(estimate_memory(needle, options) - fixed_part(needle));
  };
  EXPECT_EQ(with_epsilon(1.0 / 512), with_epsilon(4.0 / 512));
  EXPECT_NEAR(with_epsilon(0.1) / with_epsilon(0.05), 2, 0.5);
  EXPECT_GT(with_epsilon(0.5), 10 * with_epsilon(1.0 / 512));
}

// Large faces are walked over, small ones are points: both find the same space.
TEST(MemoryEstimate, DoesNotDependOnHowASurfaceIsCut) {
  const TriangleSoup coarse = test::box({0, 0, 0}, {1, 0.7, 0.4});
  TriangleSoup fine = coarse;
  for (int level = 0; level < 7; ++level) {
    TriangleSoup next;
    for (const Triangle& t : fine.triangles) {
      const Point3& a = fine.points[t[0]];
      const Point3& b = fine.points[t[1]];
      const Point3& c = fine.points[t[2]];
      const std::array<Point3, 6> p{a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)};
      const auto first = static_cast<std::uint32_t>(next.points.size());
      next.points.insert(next.points.end(), p.begin(), p.end());
      for (const Triangle& part : {Triangle{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}) {
        next.triangles.push_back({first + part[0], first + part[1], first + part[2]});
      }
    }
    fine = std::move(next);
  }
  const auto of_space = [](const TriangleSoup& soup) {
    return static_cast<double>(estimate_memory(soup, at(256)) - fixed_part(soup));
  };
  EXPECT_NEAR(of_space(fine) / of_space(coarse), 1, 0.05);
}

TEST(MemoryEstimate, RefusesWhatIsAboveTheLimitAndNamesWhatFits) {
  const TriangleSoup sphere = test::icosphere(4, 1, {0, 0, 0});
  RemeshOptions options = at(1024);
  const std::int64_t needed = estimate_memory(sphere, options);
  options.memory_limit = needed;
  EXPECT_EQ(check_memory(sphere, options), needed);
  options.memory_limit = needed / 2;
  try {
    check_memory(sphere, options);
    FAIL();
  } catch (const LimitError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("--memory"), std::string::npos) << what;
    const std::size_t named = what.find("; --resolution ");
    ASSERT_NE(named, std::string::npos) << what;
    options.resolution = std::stoi(what.substr(named + 15));
  }
  EXPECT_GT(options.resolution, 512);
  EXPECT_LE(check_memory(sphere, options), options.memory_limit);
  options.memory_limit = 1;
  EXPECT_THROW(check_memory(sphere, options), LimitError);
  options.memory_limit = 0;
  EXPECT_GT(check_memory(sphere, options), 0);
}

TEST(MemoryEstimate, SomeMemoryIsThere) { EXPECT_GT(available_memory(), std::int64_t{1} << 26); }

}  // namespace
}  // namespace cellocut
