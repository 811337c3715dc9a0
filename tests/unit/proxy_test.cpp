// The proxy keeps its distance from phi = 0, measured against analytic surfaces and not by the
// field.
#include "cellocut/proxy/proxy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <random>

#include "cellocut/field/distance_field.h"
#include "cellocut/proxy/blocks.h"
#include "cellocut/proxy/cluster_tree.h"
#include "cellocut/proxy/edge_collapses.h"
#include "cellocut/proxy/nearest_vertex.h"
#include "cellocut/proxy/refinement.h"
#include "cellocut/proxy/vertex_clusters.h"
#include "cellocut/surface/iso_surface.h"
#include "support/defective_meshes.h"

namespace cellocut {
namespace {

constexpr int kResolution = 96;

struct Thickened {
  Frame frame;
  SparseField phi;
  TriangleSoup surface;  // phi = 0, index coordinates
};

Thickened thicken(const TriangleSoup& soup, double steps) {
  Thickened t;
  t.frame = make_frame(bounding_box(soup), kResolution, steps + kBand + 1);
  t.phi = compute_distance_field(soup, t.frame, steps, silent_observer());
  t.surface = extract_iso_surface(t.phi);
  return t;
}

// The largest |phi(x)| in grid steps over a raster on the proxy's faces, phi in input units.
double largest_departure(const Proxy& proxy, const Frame& frame,
                         const std::function<double(const Point3&)>& phi) {
  double largest = 0;
  constexpr int kSteps = 12;
  for (const Triangle& face : proxy.mesh.triangles) {
    const Point3& a = proxy.mesh.points[face[0]];
    const Point3 u = proxy.mesh.points[face[1]] - a;
    const Point3 v = proxy.mesh.points[face[2]] - a;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Point3 p =
            (a + (static_cast<double>(i) / kSteps) * u) + (static_cast<double>(j) / kSteps) * v;
        largest = std::max(largest, std::fabs(phi(p)) / frame.spacing);
      }
    }
  }
  return largest;
}

std::vector<Triangle> decimate(DecimationMethod method, const TriangleSoup& surface, double share,
                               double error) {
  if (method == DecimationMethod::quadric) return collapse_edges(surface, share, error);
  VertexClusters clusters(surface, error, silent_observer());
  clusters.make(share);
  return clusters.faces();
}

std::size_t count_used(const std::vector<Triangle>& faces, std::size_t points) {
  std::vector<bool> used(points, false);
  for (const Triangle& face : faces) {
    for (const std::uint32_t corner : face) used[corner] = true;
  }
  return static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
}

class ProxyOfMethod : public testing::TestWithParam<DecimationMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, ProxyOfMethod,
                         testing::Values(DecimationMethod::clusters, DecimationMethod::quadric),
                         [](const auto& named) {
                           return named.param == DecimationMethod::clusters ? "clusters"
                                                                            : "quadric";
                         });

TEST_P(ProxyOfMethod, OfASphereStaysWithinHalfAStep) {
  const Thickened t = thicken(test::icosphere(6, 1, {0, 0, 0}), 2.0);
  const Proxy proxy = make_proxy(t.surface, t.phi, t.frame, {0.95, GetParam()}, silent_observer());
  const double epsilon = 2.0 * t.frame.spacing;
  const double largest = largest_departure(
      proxy, t.frame, [&](const Point3& p) { return std::fabs(norm(p) - 1) - epsilon; });
  // The facets of the icosphere and the interpolation of phi add a little to the half step.
  EXPECT_LE(largest, kProxyTolerance + 0.1);
  EXPECT_LE(proxy.largest_distance, kProxyTolerance);
  EXPECT_GE(proxy.removed_share, 0.9);
  EXPECT_EQ(proxy.faces_before, static_cast<std::int64_t>(t.surface.triangles.size()));
}

TEST_P(ProxyOfMethod, OfAThinSheetStaysWithinHalfAStep) {
  for (const Point3 normal : {Point3{0, 0, 1}, Point3{1, 2, 3}, Point3{1, 1, 0}}) {
    const Thickened t = thicken(test::tilted_sheet(normal, 1, 1), 1.0);
    const Proxy proxy =
        make_proxy(t.surface, t.phi, t.frame, {0.95, GetParam()}, silent_observer());
    EXPECT_LE(proxy.largest_distance, kProxyTolerance);
    EXPECT_GE(proxy.removed_share, 0.8);
    EXPECT_FALSE(proxy.mesh.empty());
  }
}

TEST_P(ProxyOfMethod, WithoutDecimationIsTheSurfaceItself) {
  const Thickened t = thicken(test::icosphere(3, 1, {0, 0, 0}), 2.0);
  const Proxy proxy = make_proxy(t.surface, t.phi, t.frame, {0, GetParam()}, silent_observer());
  EXPECT_EQ(proxy.removed_share, 0);
  EXPECT_EQ(proxy.mesh.triangles.size(), t.surface.triangles.size());
  ASSERT_EQ(proxy.mesh.points.size(), t.surface.points.size());
  double largest = 0;
  bool same_move = true;
  const Point3 first = t.frame.to_index(proxy.mesh.points[0]) - t.surface.points[0];
  for (std::size_t i = 0; i < t.surface.points.size(); ++i) {
    const Point3 move = t.frame.to_index(proxy.mesh.points[i]) - t.surface.points[i];
    for (const double x : move) largest = std::max(largest, std::fabs(x));
    same_move = same_move && norm(move - first) < 1e-9;
  }
  EXPECT_LE(largest, kTieBreak + 1e-9);
  EXPECT_GE(largest, 0.9 * kTieBreak);
  EXPECT_FALSE(same_move);
}

TEST_P(ProxyOfMethod, HasNoPointThatNoFaceUses) {
  const Thickened t = thicken(test::moebius_strip(), 1.0);
  const Proxy proxy = make_proxy(t.surface, t.phi, t.frame, {0.95, GetParam()}, silent_observer());
  std::vector<bool> used(proxy.mesh.points.size(), false);
  for (const Triangle& face : proxy.mesh.triangles) {
    for (const std::uint32_t corner : face) used.at(corner) = true;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
}

TEST(Refinement, SplitsACoarseCoverUntilItIsClose) {
  const Thickened t = thicken(test::icosphere(5, 1, {0, 0, 0}), 3.0);
  // A cover of the outer sphere and of the inner by far too few faces.
  const std::vector<Triangle> coarse = collapse_edges(t.surface, 0.99, 2.0);
  ASSERT_LT(coarse.size(), t.surface.triangles.size() / 60);
  const Refinement refined =
      refine_to_surface(t.surface, coarse, t.phi, kProxyTolerance, silent_observer());
  EXPECT_LE(refined.largest_distance, kProxyTolerance);
  EXPECT_GT(refined.faces.size(), coarse.size());
  EXPECT_LT(refined.faces.size(), t.surface.triangles.size() / 4);
  // It is still a cover: directions from the centre meet both spheres.
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Point3 centre = t.frame.to_index({0, 0, 0});
  for (int n = 0; n < 200; ++n) {
    const Point3 direction{normal(random), normal(random), normal(random)};
    const auto hits =
        std::count_if(refined.faces.begin(), refined.faces.end(), [&](const Triangle& face) {
          std::array<double, 3> volume{};
          for (int k = 0; k < 3; ++k) {
            const Point3 a = t.surface.points[face[k]] - centre;
            const Point3 b = t.surface.points[face[(k + 1) % 3]] - centre;
            volume[k] = dot(direction, cross(a, b));
          }
          const auto same = [&](double sign) {
            return std::all_of(volume.begin(), volume.end(),
                               [sign](double v) { return sign * v > 0; });
          };
          const Point3& corner = t.surface.points[face[0]];
          return dot(corner - centre, direction) > 0 && (same(1) || same(-1));
        });
    EXPECT_GE(hits, 2);
  }
}

TEST_P(ProxyOfMethod, DecimationKeepsCornersOfTheSurface) {
  const Thickened t = thicken(test::tilted_sheet({1, 2, 3}, 1, 1), 1.0);
  const std::vector<Triangle> faces = decimate(GetParam(), t.surface, 0.95, kProxyTolerance);
  EXPECT_LE(faces.size(), t.surface.triangles.size() / 10);
  EXPECT_GE(faces.size(), t.surface.triangles.size() / 25);
  for (const Triangle& face : faces) {
    for (const std::uint32_t corner : face) ASSERT_LT(corner, t.surface.points.size());
    EXPECT_NE(face[0], face[1]);
    EXPECT_NE(face[1], face[2]);
    EXPECT_NE(face[2], face[0]);
  }
  EXPECT_EQ(decimate(GetParam(), t.surface, 0, kProxyTolerance).size(), t.surface.triangles.size());
}

TEST(VertexClusters, LeaveTheShareOfVerticesAskedFor) {
  const Thickened t = thicken(test::icosphere(5, 1, {0, 0, 0}), 3.0);
  VertexClusters clusters(t.surface, kProxyTolerance, silent_observer());
  const auto points = static_cast<double>(t.surface.points.size());
  for (const double share : {0.3, 0.97, 0.5, 0.9}) {
    clusters.make(share);
    const auto left = static_cast<double>(count_used(clusters.faces(), t.surface.points.size()));
    EXPECT_NEAR(left, (1 - share) * points, 0.002 * left + 20) << share;
  }
}

TEST(VertexClusters, UndoneAreWhatTheyWereMadeFrom) {
  const Thickened t = thicken(test::icosphere(4, 1, {0, 0, 0}), 3.0);
  VertexClusters clusters(t.surface, kProxyTolerance, silent_observer());
  clusters.make(0.97);
  std::size_t left = count_used(clusters.faces(), t.surface.points.size());
  std::vector<std::uint32_t> all(t.surface.points.size());
  std::iota(all.begin(), all.end(), 0U);
  int rounds = 0;
  while (clusters.undo(all)) {
    const std::size_t more = count_used(clusters.faces(), t.surface.points.size());
    EXPECT_GT(more, left);
    left = more;
    ++rounds;
  }
  EXPECT_GT(rounds, 3);
  // All undone: the surface itself, each face from its lowest corner.
  std::vector<Triangle> expected = t.surface.triangles;
  for (Triangle& face : expected) {
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(clusters.faces(), expected);
}

TEST(VertexClusters, KeepTheCornersOfABox) {
  const Thickened t = thicken(test::box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}), 1.0);
  const std::vector<Triangle> faces =
      decimate(DecimationMethod::clusters, t.surface, 0.99, kProxyTolerance);
  for (int corner = 0; corner < 8; ++corner) {
    const Point3 at =
        t.frame.to_index({(corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.4 : -0.4,
                          (corner & 4) != 0 ? 0.3 : -0.3});
    double nearest = 1e9;
    for (const Triangle& face : faces) {
      for (const std::uint32_t v : face) {
        nearest = std::min(nearest, norm(t.surface.points[v] - at));
      }
    }
    // The rounded corner of the slab begins one step away.
    EXPECT_LE(nearest, 2.0) << corner;
  }
}

// A sheet with a round window: splitting a face that lies across the window does not bring it near.
TEST_P(ProxyOfMethod, OfASheetWithAWindowStaysWithinHalfAStep) {
  TriangleSoup sheet;
  constexpr int kSides = 48;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * 3.14159265358979 * i / kSides;
    for (const double radius : {0.2, 0.5}) {
      sheet.points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    const auto a = static_cast<std::uint32_t>(2 * i);
    const std::uint32_t b = (a + 2) % (2 * kSides);
    sheet.triangles.push_back({a, a + 1, b});
    sheet.triangles.push_back({b, a + 1, b + 1});
  }
  const Thickened t = thicken(sheet, 2.0);
  const Proxy proxy = make_proxy(t.surface, t.phi, t.frame, {0.98, GetParam()}, silent_observer());
  EXPECT_LE(proxy.largest_distance, kProxyTolerance);
  EXPECT_GE(proxy.removed_share, 0.9);
  const double largest = largest_departure(proxy, t.frame, [&](const Point3& p) {
    const double across = std::hypot(p[0], p[1]);
    const double beside = std::max({0.0, 0.2 - across, across - 0.5});
    return std::hypot(beside, p[2]) - 2 * t.frame.spacing;
  });
  EXPECT_LE(largest, kProxyTolerance + 0.2);
}

// A square grid of unit spacing, folded twice along its columns: a trough. (No point lies in all of
// its three planes; with one fold the points of the fold would do for all.)
constexpr std::uint32_t kTroughSize = 17;
constexpr std::uint32_t kFirstFold = 5;
constexpr std::uint32_t kSecondFold = 11;

struct Trough {
  std::vector<ClusterLeaf> leaves;
  std::vector<std::array<std::uint32_t, 2>> edges;
};

Trough make_trough() {
  Trough trough;
  for (std::uint32_t i = 0; i < kTroughSize; ++i) {
    for (std::uint32_t j = 0; j < kTroughSize; ++j) {
      ClusterLeaf leaf;
      const double height = i < kFirstFold    ? kFirstFold - static_cast<double>(i)
                            : i > kSecondFold ? static_cast<double>(i) - kSecondFold
                                              : 0;
      leaf.at = {static_cast<double>(i), static_cast<double>(j), height};
      // The planes of the faces on both sides.
      for (const double x : {i - 0.5, i + 0.5}) {
        const double slope = x < kFirstFold ? 1 : x > kSecondFold ? -1 : 0;
        const Point3 normal = {slope, 0, 1};
        leaf.quadric += plane_quadric(leaf.at, normal, 0.5);
        leaf.normal = leaf.normal + normal;
      }
      leaf.normal = (1 / norm(leaf.normal)) * leaf.normal;
      trough.leaves.push_back(leaf);
      const std::uint32_t here = i * kTroughSize + j;
      if (i + 1 < kTroughSize) trough.edges.push_back({here, here + kTroughSize});
      if (j + 1 < kTroughSize) trough.edges.push_back({here, here + 1});
    }
  }
  return trough;
}

TEST(ClusterTree, CostsAreThoseOfTheirMembersAndOnlyGrow) {
  const Trough trough = make_trough();
  const ClusterTree tree = grow_cluster_tree(trough.leaves, trough.edges, 1e9);
  ASSERT_EQ(tree.leaves, trough.leaves.size());
  // One root: with no limit on the error all become one.
  EXPECT_EQ(std::count(tree.parent.begin(), tree.parent.end(), ClusterTree::kNone), 1);
  for (std::size_t i = 0; i < tree.size(); ++i) {
    if (tree.parent[i] == ClusterTree::kNone) continue;
    EXPECT_GT(tree.parent[i], i);
    EXPECT_LE(tree.cost[i], tree.cost[tree.parent[i]]);
  }
  std::vector<std::vector<std::uint32_t>> members(tree.size());
  for (std::uint32_t i = 0; i < tree.leaves; ++i) members[i] = {i};
  for (std::uint32_t i = 0; i < tree.size(); ++i) {
    const std::uint32_t representative = tree.representative[i];
    EXPECT_EQ(std::count(members[i].begin(), members[i].end(), representative), 1);
    double cost = 0;
    for (const std::uint32_t leaf : members[i]) {
      cost += trough.leaves[leaf].quadric.at(trough.leaves[representative].at);
    }
    if (i >= tree.leaves) {
      EXPECT_GE(tree.cost[i], 0.999 * cost);
    }
    if (tree.parent[i] == ClusterTree::kNone) continue;
    std::vector<std::uint32_t>& parent = members[tree.parent[i]];
    parent.insert(parent.end(), members[i].begin(), members[i].end());
  }
  EXPECT_EQ(members.back().size(), tree.leaves);
}

TEST(ClusterTree, PlanesMergeBeforeTheyMeetAcrossFolds) {
  const Trough trough = make_trough();
  const ClusterTree tree = grow_cluster_tree(trough.leaves, trough.edges, 1e9);
  // What costs next to nothing: parts of the planes, none with both slopes.
  const auto root_below = [&](std::uint32_t i, float cost) {
    while (tree.parent[i] != ClusterTree::kNone && tree.cost[tree.parent[i]] <= cost) {
      i = tree.parent[i];
    }
    return i;
  };
  std::vector<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < tree.leaves; ++i) roots.push_back(root_below(i, 2.0F));
  for (std::uint32_t i = 0; i < kFirstFold * kTroughSize; ++i) {
    const auto beyond = roots.begin() + (kSecondFold + 1) * kTroughSize;
    EXPECT_EQ(std::find(beyond, roots.end(), roots[i]), roots.end());
  }
  std::sort(roots.begin(), roots.end());
  roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
  EXPECT_LE(roots.size(), 10U);
}

TEST(ClusterTree, NoPairDepartsByMoreThanTheErrorAllowed) {
  const Trough trough = make_trough();
  constexpr double kError = 0.25;
  const ClusterTree tree = grow_cluster_tree(trough.leaves, trough.edges, kError);
  EXPECT_GT(std::count(tree.parent.begin(), tree.parent.end(), ClusterTree::kNone), 1);
  std::vector<Quadric> sum(tree.size());
  for (std::size_t i = 0; i < tree.leaves; ++i) sum[i] = trough.leaves[i].quadric;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const Point3& at = trough.leaves[tree.representative[i]].at;
    EXPECT_LE(sum[i].at(at), (kError * kError + 1e-9) * sum[i].area);
    if (tree.parent[i] != ClusterTree::kNone) sum[tree.parent[i]] += sum[i];
  }
}

TEST(Groups, HoldTheirThingsInOrder) {
  std::mt19937 random(3);
  std::vector<std::uint32_t> group_of(1000);
  for (std::uint32_t& g : group_of) {
    g = static_cast<std::uint32_t>(random() % 8);
    if (g == 7) g = Groups::kNone;
  }
  const Groups groups = group(group_of, 9);  // 7 and 8 are empty
  ASSERT_EQ(groups.count(), 9U);
  for (std::uint32_t g = 0; g < 9; ++g) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < group_of.size(); ++i) {
      if (group_of[i] == g) expected.push_back(i);
    }
    EXPECT_EQ(std::vector<std::uint32_t>(groups[g].begin(), groups[g].end()), expected);
  }
}

TEST(NearestVertex, EqualsBruteForce) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0, 12);
  std::vector<Point3> points;
  points.reserve(701);
  for (int i = 0; i < 700; ++i) points.push_back({place(random), place(random), place(random)});
  points.push_back(points[3]);  // a tie: the lower index wins
  const NearestVertex nearest(points);
  for (int n = 0; n < 500; ++n) {
    const Point3 p{place(random), place(random), place(random)};
    std::array<std::uint32_t, 2> excluded{NearestVertex::kNone, NearestVertex::kNone};
    for (std::uint32_t& next : excluded) {
      std::uint32_t expected = NearestVertex::kNone;
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (i == excluded[0] || i == excluded[1]) continue;
        if (expected == NearestVertex::kNone ||
            squared_norm(points[i] - p) < squared_norm(points[expected] - p)) {
          expected = i;
        }
      }
      ASSERT_LT(squared_norm(points[expected] - p), 4.0);
      const std::uint32_t found = nearest(p, excluded);
      EXPECT_EQ(found, expected);
      next = found;
    }
  }
}

TEST(NearestVertex, FindsNothingFarAway) {
  const std::vector<Point3> points{{1, 1, 1}, {9, 9, 9}};
  const NearestVertex nearest(points);
  EXPECT_EQ(nearest({5, 5, 5}, {}), NearestVertex::kNone);
  EXPECT_EQ(nearest({1.5, 1, 1}, std::array<std::uint32_t, 1>{0}), NearestVertex::kNone);
}

}  // namespace
}  // namespace cellocut
