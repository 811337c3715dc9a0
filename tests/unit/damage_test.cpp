// Holes are cut where they may be, and nothing else changes.
#include "cellocut/damage/damage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <ostream>
#include <set>

#include "cellocut/base/errors.h"
#include "cellocut/validity/surface_report.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"
#include "validity_meshes.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

using Corners = std::array<Point3, 3>;

std::vector<Corners> corners_of(const TriangleSoup& mesh) {
  std::vector<Corners> result;
  result.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    result.push_back({mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]});
  }
  return result;
}

// The number of loops of edges with one face, and their lengths; fails where a vertex has more than
// two such edges.
std::vector<std::size_t> boundary_loops(const TriangleSoup& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) edges[{t[k], t[(k + 1) % 3]}] += 1;
  }
  std::map<std::uint32_t, std::uint32_t> next;
  for (const auto& [edge, count] : edges) {
    if (edges.count({edge.second, edge.first}) != 0) continue;
    EXPECT_TRUE(next.emplace(edge.second, edge.first).second) << "a pinched vertex";
  }
  std::vector<std::size_t> loops;
  while (!next.empty()) {
    std::size_t length = 0;
    std::uint32_t v = next.begin()->first;
    for (auto found = next.find(v); found != next.end(); found = next.find(v)) {
      v = found->second;
      next.erase(found);
      ++length;
    }
    loops.push_back(length);
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

struct Case {
  const char* name;
  TriangleSoup model;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class DamageOf : public ::testing::TestWithParam<Case> {};

TEST_P(DamageOf, LeavesOneSimpleLoopForEachHoleAndAllElse) {
  const TriangleSoup& model = GetParam().model;
  const SurfaceReport before = inspect_surface(model, SurfaceCheckOptions{.intersections = false});
  const std::vector<Corners> faces_before = corners_of(model);
  std::set<std::size_t> numbers;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const Damage damage = damage_mesh(model, {.seed = seed});
    numbers.insert(damage.holes.size());
    EXPECT_GE(damage.holes.size(), 6U);
    EXPECT_LE(damage.holes.size(), 12U);

    // The faces that stay are those that were there, in their order, corner by corner.
    std::set<std::uint32_t> gone;
    std::set<HoleKind> kinds;
    std::vector<std::size_t> lengths;
    double share = 0;
    for (const Hole& hole : damage.holes) {
      gone.insert(hole.faces.begin(), hole.faces.end());
      kinds.insert(hole.kind);
      lengths.push_back(hole.boundary.size());
      share += hole.share;
      EXPECT_GT(hole.area, 0);
      EXPECT_NEAR(hole.share, hole.area / before.area, 1e-12);
      EXPECT_NEAR(hole.width * hole.length, hole.area, 1e-12 * hole.area);
    }
    EXPECT_EQ(kinds.size(), 3U);
    EXPECT_GT(share, 0.03);
    EXPECT_LT(share, 0.4);
    std::vector<Corners> expected;
    for (std::uint32_t f = 0; f < faces_before.size(); ++f) {
      if (gone.count(f) == 0) expected.push_back(faces_before[f]);
    }
    EXPECT_EQ(corners_of(damage.mesh), expected);

    const SurfaceReport after =
        inspect_surface(damage.mesh, SurfaceCheckOptions{.intersections = false});
    EXPECT_EQ(after.points, static_cast<std::int64_t>(damage.mesh.points.size()))
        << "no point is left without a face";
    EXPECT_EQ(after.by_index.nonmanifold_edges, 0);
    EXPECT_EQ(after.by_index.nonmanifold_vertices, 0);
    EXPECT_EQ(after.by_index.misoriented_edges, 0);
    EXPECT_EQ(after.components.size(), before.components.size());
    // Each hole is a disc: it takes 1 off the Euler number.
    EXPECT_EQ(after.euler, before.euler - static_cast<std::int64_t>(damage.holes.size()));
    EXPECT_NEAR(after.area, before.area * (1 - share), 1e-9 * before.area);
    std::sort(lengths.begin(), lengths.end());
    EXPECT_EQ(boundary_loops(damage.mesh), lengths);
  }
  EXPECT_GT(numbers.size(), 1U) << "seeds give different numbers of holes";
}

TriangleSoup two_parts() {
  TriangleSoup mesh = test::icosphere(4);
  test::append(mesh, testing::gridded_box({2, -0.5, -0.5}, {3, 0.5, 0.5}, 16));
  return mesh;
}

INSTANTIATE_TEST_SUITE_P(Models, DamageOf,
                         ::testing::Values(Case{"sphere", test::icosphere(4)},
                                           Case{"torus", test::torus(1, 0.4, 96, 40)},
                                           Case{"slab",
                                                testing::gridded_box({0, 0, 0}, {3, 1, 0.3}, 24)},
                                           Case{"two_parts", two_parts()}),
                         [](const auto& of) { return std::string(of.param.name); });

TEST(Damage, KindsAreShapedAsTheyAreNamed) {
  const TriangleSoup sphere = test::icosphere(6);  // 81,920 faces
  const Damage damage = damage_mesh(sphere, {.seed = 3, .fewest = 12, .most = 12});
  for (const Hole& hole : damage.holes) {
    const double longer = hole.length / hole.width;
    switch (hole.kind) {
      case HoleKind::grazing:
        EXPECT_GE(hole.share, 0.4 * 0.008);
        EXPECT_LE(hole.share, 0.03);
        break;
      case HoleKind::gap:
        EXPECT_GT(longer, 3.5);
        EXPECT_LT(longer, 12);
        break;
      case HoleKind::stripe:
        EXPECT_GT(longer, 6);
        EXPECT_LT(longer, 25);
        break;
    }
  }
}

TEST(Damage, SameForTheSameSeed) {
  const TriangleSoup model = test::torus(1, 0.4, 96, 40);
  const Damage first = damage_mesh(model, {.seed = 7});
  const Damage again = damage_mesh(model, {.seed = 7});
  EXPECT_EQ(again.mesh.points, first.mesh.points);
  EXPECT_EQ(again.mesh.triangles, first.mesh.triangles);
  EXPECT_NE(damage_mesh(model, {.seed = 8}).mesh.triangles, first.mesh.triangles);
  EXPECT_EQ(damage_mesh(model, {.seed = 7, .fewest = 3, .most = 3}).holes.size(), 3U);
}

TEST(Damage, ColoursStayWithTheirVertices) {
  TriangleSoup model = test::icosphere(4);
  for (const Point3& p : model.points) {
    model.colours.push_back({static_cast<std::uint8_t>(100 * (p[0] + 1)), 7, 9});
  }
  const TriangleSoup mesh = damage_mesh(model, {}).mesh;
  ASSERT_EQ(mesh.colours.size(), mesh.points.size());
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    EXPECT_EQ(mesh.colours[v][0], static_cast<std::uint8_t>(100 * (mesh.points[v][0] + 1)));
  }
}

TEST(Damage, Refuses) {
  for (const test::NamedSoup& bad : test::all_defective_meshes()) {
    const bool closed = bad.name == "two_crossing_boxes" || bad.name == "nested_spheres" ||
                        bad.name == "bow_tie_vertex";
    if (closed) continue;
    EXPECT_THAT([&] { damage_mesh(bad.soup, {}); },
                ThrowsMessage<InputError>(HasSubstr("not closed and manifold")))
        << bad.name;
  }
  EXPECT_THAT([] { damage_mesh(test::bow_tie_vertex(), {}); },
              ThrowsMessage<InputError>(HasSubstr("1 non-manifold vertices")));
  EXPECT_THAT(
      [] {
        damage_mesh(test::box({0, 0, 0}, {1, 1, 1}), {});
      },
      ThrowsMessage<InputError>(HasSubstr("too coarse")));
  EXPECT_THAT([] { damage_mesh(TriangleSoup{}, {}); }, ThrowsMessage<InputError>("no faces"));
  const TriangleSoup good = test::icosphere(3);
  EXPECT_THROW(damage_mesh(good, {.fewest = 0}), UsageError);
  EXPECT_THROW(damage_mesh(good, {.fewest = 5, .most = 4}), UsageError);
}

}  // namespace
}  // namespace cellocut
