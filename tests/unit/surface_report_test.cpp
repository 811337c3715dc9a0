#include "cellocut/validity/surface_report.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "validity_meshes.h"

namespace cellocut {
namespace {

using testing::box;
using testing::flipped;
using testing::icosphere;
using testing::joined;
using testing::moebius_strip;
using testing::tetrahedron;
using testing::torus;
using testing::unit_tetrahedron;

void expect_same(const IncidenceCounts& a, const IncidenceCounts& b) {
  EXPECT_EQ(a.boundary_edges, b.boundary_edges);
  EXPECT_EQ(a.nonmanifold_edges, b.nonmanifold_edges);
  EXPECT_EQ(a.misoriented_edges, b.misoriented_edges);
  EXPECT_EQ(a.nonmanifold_vertices, b.nonmanifold_vertices);
  EXPECT_EQ(a.duplicate_faces, b.duplicate_faces);
}

void expect_same(const SurfaceReport& a, const SurfaceReport& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangles, b.triangles);
  expect_same(a.by_index, b.by_index);
  expect_same(a.by_position, b.by_position);
  EXPECT_EQ(a.degenerate_faces, b.degenerate_faces);
  EXPECT_EQ(a.nonfinite_points, b.nonfinite_points);
  EXPECT_EQ(a.intersecting_pairs, b.intersecting_pairs);
  EXPECT_EQ(a.pairs, b.pairs);
  EXPECT_EQ(a.touching_edges, b.touching_edges);
  EXPECT_EQ(a.touching_vertices, b.touching_vertices);
  ASSERT_EQ(a.components.size(), b.components.size());
  for (std::size_t i = 0; i < a.components.size(); ++i) {
    EXPECT_EQ(a.components[i].triangles, b.components[i].triangles);
    EXPECT_EQ(a.components[i].volume, b.components[i].volume);  // the same bits
  }
  EXPECT_EQ(a.volume, b.volume);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.euler, b.euler);
}

TEST(SurfaceReport, ClosedBox) {
  const SurfaceReport report = inspect_surface(box({1, 2, 3}, {3, 5, 7}));
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.points, 8);
  EXPECT_EQ(report.triangles, 12);
  expect_same(report.by_index, IncidenceCounts{});
  expect_same(report.by_position, IncidenceCounts{});
  EXPECT_EQ(report.euler, 2);
  ASSERT_EQ(report.components.size(), 1U);
  EXPECT_EQ(report.components[0].triangles, 12);
  EXPECT_DOUBLE_EQ(report.volume, 24);
  EXPECT_DOUBLE_EQ(report.area, 2 * (6 + 8 + 12));
}

TEST(SurfaceReport, InwardBoxHasNegativeVolume) {
  const SurfaceReport report = inspect_surface(flipped(box()));
  EXPECT_DOUBLE_EQ(report.volume, -1);
  EXPECT_EQ(report.by_index.misoriented_edges, 0);
}

TEST(SurfaceReport, OpenBox) {
  TriangleSoup soup = box();
  soup.triangles.resize(10);  // without the side x = 1
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_FALSE(report.valid());
  EXPECT_EQ(report.by_index.boundary_edges, 4);
  EXPECT_EQ(report.by_index.nonmanifold_vertices, 0);
  EXPECT_EQ(report.euler, 1);
}

TEST(SurfaceReport, EmptyMeshIsNotValid) {
  const SurfaceReport report = inspect_surface(TriangleSoup{});
  EXPECT_FALSE(report.valid());
  EXPECT_EQ(report.triangles, 0);
  EXPECT_TRUE(report.components.empty());
}

TEST(SurfaceReport, UntestedIntersectionsAreNotValid) {
  SurfaceCheckOptions options;
  options.intersections = false;
  EXPECT_FALSE(inspect_surface(box(), options).valid());
}

TEST(SurfaceReport, StrayPointsDoNotCount) {
  TriangleSoup soup = box();
  soup.points.insert(soup.points.end(), {{5, 5, 5}, {NAN, 0, 0}});
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.points, 8);
  EXPECT_EQ(report.euler, 2);
  EXPECT_DOUBLE_EQ(report.volume, 1);
}

TEST(SurfaceReport, BowTieVertex) {
  // Two tetrahedra with one corner in common, by index.
  TriangleSoup soup = unit_tetrahedron();
  soup.points.insert(soup.points.end(), {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}});
  for (const Triangle& t : flipped(unit_tetrahedron()).triangles) {
    Triangle moved = t;
    for (std::uint32_t& v : moved) v = v == 0 ? 0 : v + 3;
    soup.triangles.push_back(moved);
  }
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_EQ(report.by_index.nonmanifold_vertices, 1);
  EXPECT_EQ(report.by_index.nonmanifold_edges, 0);
  EXPECT_EQ(report.by_index.boundary_edges, 0);
  EXPECT_EQ(report.intersecting_pairs, 0);
  EXPECT_EQ(report.touching_vertices, 0);
  EXPECT_EQ(report.components.size(), 2U);
  EXPECT_EQ(report.euler, 3);
  EXPECT_FALSE(report.valid());
}

TEST(SurfaceReport, TwoOpenFansAtOneVertex) {
  const TriangleSoup soup{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                          {{0, 1, 2}, {0, 3, 4}}};
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_EQ(report.by_index.nonmanifold_vertices, 1);
  EXPECT_EQ(report.by_index.boundary_edges, 6);
}

TEST(SurfaceReport, TetrahedraTouchingInAVertexByPosition) {
  const SurfaceReport report = inspect_surface(
      joined(unit_tetrahedron(), tetrahedron({-0.0, 0, -0.0}, {-1, 0, 0}, {0, 0, -1}, {0, -1, 0})));
  EXPECT_TRUE(report.valid());  // a contact is no defect
  EXPECT_EQ(report.by_index.nonmanifold_vertices, 0);
  EXPECT_EQ(report.by_position.nonmanifold_vertices, 1);
  EXPECT_EQ(report.touching_vertices, 1);
  EXPECT_EQ(report.touching_edges, 0);
  EXPECT_EQ(report.euler, 4);
}

TEST(SurfaceReport, TetrahedraTouchingInAnEdgeByPosition) {
  const SurfaceReport report = inspect_surface(
      joined(unit_tetrahedron(), tetrahedron({0, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1})));
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.by_position.nonmanifold_edges, 1);
  EXPECT_EQ(report.by_position.nonmanifold_vertices, 2);
  EXPECT_EQ(report.touching_edges, 1);
  EXPECT_EQ(report.touching_vertices, 2);
  EXPECT_EQ(report.intersecting_pairs, 0);
  EXPECT_EQ(report.components.size(), 2U);
}

TEST(SurfaceReport, ThreeFacesAtAnEdge) {
  const TriangleSoup soup{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                          {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_EQ(report.by_index.nonmanifold_edges, 1);
  EXPECT_EQ(report.by_index.nonmanifold_vertices, 2);
  EXPECT_EQ(report.by_index.boundary_edges, 6);
  EXPECT_EQ(report.by_index.misoriented_edges, 0);
  EXPECT_EQ(report.touching_edges, 0);
  EXPECT_EQ(report.components.size(), 1U);
}

TEST(SurfaceReport, FlippedFace) {
  TriangleSoup soup = box();
  std::swap(soup.triangles[0][0], soup.triangles[0][1]);
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_EQ(report.by_index.misoriented_edges, 3);
  EXPECT_EQ(report.by_index.boundary_edges, 0);
  EXPECT_FALSE(report.valid());
}

TEST(SurfaceReport, DuplicateFace) {
  TriangleSoup soup = box();
  soup.triangles.push_back({soup.triangles[3][1], soup.triangles[3][0], soup.triangles[3][2]});
  soup.triangles.push_back(soup.triangles[3]);
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_EQ(report.by_index.duplicate_faces, 2);
  EXPECT_EQ(report.by_index.nonmanifold_edges, 3);
  EXPECT_EQ(report.intersecting_pairs, 3);
  EXPECT_EQ(report.pairs,
            (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{3, 12}, {3, 13}, {12, 13}}));
}

TEST(SurfaceReport, DuplicateByPositionOnly) {
  const TriangleSoup one{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const SurfaceReport report = inspect_surface(joined(one, flipped(one)));
  EXPECT_EQ(report.by_index.duplicate_faces, 0);
  EXPECT_EQ(report.by_index.boundary_edges, 6);
  EXPECT_EQ(report.by_position.duplicate_faces, 1);
  EXPECT_EQ(report.by_position.boundary_edges, 0);
  EXPECT_EQ(report.by_position.nonmanifold_vertices, 0);
  EXPECT_EQ(report.intersecting_pairs, 1);
}

TEST(SurfaceReport, SeamsCloseByPosition) {
  TriangleSoup soup = box();
  TriangleSoup seams;
  for (const Triangle& t : soup.triangles) {
    seams = joined(seams, {{soup.points[t[0]], soup.points[t[1]], soup.points[t[2]]}, {{0, 1, 2}}});
  }
  const SurfaceReport report = inspect_surface(seams);
  EXPECT_EQ(report.by_index.boundary_edges, 36);
  expect_same(report.by_position, IncidenceCounts{});
  EXPECT_EQ(report.touching_edges, 0);
  EXPECT_EQ(report.intersecting_pairs, 0);
  EXPECT_EQ(report.components.size(), 12U);
}

TEST(SurfaceReport, TJunction) {
  // Point 3 lies inside the edge (0, 1) of the large face.
  const TriangleSoup soup{{{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, 0, 0}, {1, -1, 0.5}},
                          {{0, 1, 2}, {0, 4, 3}, {3, 4, 1}}};
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_EQ(report.by_index.boundary_edges, 7);
  EXPECT_EQ(report.by_index.nonmanifold_edges, 0);
  EXPECT_EQ(report.intersecting_pairs, 2);  // each small face lies along a part of the edge
}

TEST(SurfaceReport, MoebiusStrip) {
  const SurfaceReport report = inspect_surface(moebius_strip(24));
  EXPECT_EQ(report.by_index.boundary_edges, 48);
  EXPECT_EQ(report.by_index.misoriented_edges, 1);
  EXPECT_EQ(report.by_index.nonmanifold_vertices, 0);
  EXPECT_EQ(report.euler, 0);
  EXPECT_EQ(report.intersecting_pairs, 0);
}

TEST(SurfaceReport, Torus) {
  const SurfaceReport report = inspect_surface(torus(60, 30, 2, 0.5));
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.euler, 0);
  EXPECT_NEAR(report.volume, 2 * std::numbers::pi * std::numbers::pi * 2 * 0.25, 0.15);
  EXPECT_LT(report.volume, 2 * std::numbers::pi * std::numbers::pi * 2 * 0.25);
}

TEST(SurfaceReport, NestedSpheres) {
  const TriangleSoup inner = flipped(icosphere(3, 0.5));
  const SurfaceReport report = inspect_surface(joined(inner, icosphere(3, 1)));
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.euler, 4);
  ASSERT_EQ(report.components.size(), 2U);
  EXPECT_GT(report.components[0].volume, 0);
  EXPECT_NEAR(report.components[1].volume, -report.components[0].volume / 8, 1e-12);
  EXPECT_NEAR(report.volume, report.components[0].volume * 7 / 8, 1e-12);
  EXPECT_NEAR(report.components[0].volume, 4 * std::numbers::pi / 3, 0.05);
}

TEST(SurfaceReport, VolumeKeepsItsDigitsFarFromTheOrigin) {
  const SurfaceReport report = inspect_surface(
      tetrahedron({4096, 4096, 4096}, {4097, 4096, 4096}, {4096, 4097, 4096}, {4096, 4096, 4097}));
  EXPECT_DOUBLE_EQ(report.volume, 1.0 / 6);
}

TEST(SurfaceReport, DegenerateFaces) {
  TriangleSoup soup{{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {0, 0, 1}, {0, 0, 0}, {0.1, 0.3, 0}},
                    {{0, 1, 2},    // three points on one line
                     {0, 3, 3},    // a repeated corner
                     {0, 3, 4},    // equal coordinates
                     {0, 1, 3}}};  // a proper face
  SurfaceReport report = inspect_surface(soup);
  EXPECT_EQ(report.degenerate_faces, 3);
  EXPECT_EQ(report.intersecting_pairs, 0);
  EXPECT_FALSE(report.valid());
  // A thousandth of the last digit off the line is enough: exact, not a tolerance.
  soup = {{{0, 0, 0}, {1, 1, 0}, {3, std::nextafter(3.0, 4.0), 0}}, {{0, 1, 2}}};
  EXPECT_EQ(inspect_surface(soup).degenerate_faces, 0);
  const double tiny = std::numeric_limits<double>::denorm_min();
  soup = {{{0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(inspect_surface(soup).degenerate_faces, 0);
  soup = {{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.3, 0.3, 0.3}}, {{0, 1, 2}}};
  EXPECT_EQ(inspect_surface(soup).degenerate_faces, 1);
}

TEST(SurfaceReport, NonfinitePoints) {
  TriangleSoup soup = box();
  soup.points[7][1] = std::numeric_limits<double>::infinity();
  soup.points[3][2] = NAN;
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_EQ(report.nonfinite_points, 2);
  EXPECT_EQ(report.degenerate_faces, 0);
  EXPECT_TRUE(std::isfinite(report.volume));
  EXPECT_TRUE(std::isfinite(report.area));
  EXPECT_FALSE(report.valid());
}

TEST(SurfaceReport, CollapsedFaceDoesNotOpenTheSurface) {
  // Edge (0, 1) of a box is split by a point with the coordinates of corner 0: the two slivers
  // between them close the surface by index, and without them it is closed by position.
  TriangleSoup soup = box();
  const std::uint32_t copy = 8;
  soup.points.push_back(soup.points[0]);
  for (Triangle& t : soup.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (t[k] == 0 && t[(k + 1) % 3] == 1) t[k] = copy;  // the face below (0, 1) ...
    }
  }
  // ... now has edges (8, 1) and (4, 8), which the slivers join to (0, 1) and (4, 0).
  soup.triangles.push_back({0, 1, copy});
  soup.triangles.push_back({4, 0, copy});
  const SurfaceReport report = inspect_surface(soup);
  EXPECT_EQ(report.by_index.boundary_edges, 0);
  EXPECT_EQ(report.degenerate_faces, 2);
  expect_same(report.by_position, IncidenceCounts{});
}

TEST(SurfaceReport, IndexOutOfRange) {
  TriangleSoup soup = box();
  soup.triangles[5][2] = 8;
  try {
    inspect_surface(soup);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "face 5 names point 8, but there are only 8 points");
  }
}

class Impatient final : public Observer {
 public:
  explicit Impatient(int polls) : left_(polls) {}
  [[nodiscard]] bool cancelled() const override { return --left_ < 0; }

 private:
  mutable std::atomic<int> left_;
};

TEST(SurfaceReport, Cancels) {
  const TriangleSoup soup = icosphere(5);
  SurfaceCheckOptions options;
  for (const int polls : {0, 1, 5, 15}) {
    Impatient observer(polls);
    options.observer = &observer;
    EXPECT_THROW(inspect_surface(soup, options), Cancelled) << polls;
  }
}

TEST(SurfaceReport, ProgressEndsAtOne) {
  class Listener final : public Observer {
   public:
    void progress(double done) override {
      double old = largest.load();
      while (old < done && !largest.compare_exchange_weak(old, done)) {
      }
    }
    std::atomic<double> largest{0};
  } listener;
  SurfaceCheckOptions options;
  options.observer = &listener;
  inspect_surface(icosphere(4), options);
  EXPECT_NEAR(listener.largest, 1, 1e-9);
}

// Intersecting, non-manifold, with copies and collapsed faces: every count is exercised.
TriangleSoup damaged_soup() {
  std::mt19937 random(7);
  TriangleSoup soup = joined(icosphere(4), icosphere(4, 0.9, {0.3, 0.2, 0.1}));
  std::uniform_int_distribution<std::uint32_t> any_point(
      0, static_cast<std::uint32_t>(soup.points.size()) - 1);
  for (int i = 0; i < 200; ++i) {
    soup.triangles.push_back({any_point(random), any_point(random), any_point(random)});
    soup.triangles.push_back(soup.triangles[any_point(random)]);
    soup.points[any_point(random)] = soup.points[any_point(random)];
  }
  soup.triangles.push_back({1, 2, 1});
  return soup;
}

TEST(SurfaceReport, SameForAnyNumberOfThreads) {
  const TriangleSoup soup = damaged_soup();
  SurfaceCheckOptions options;
  options.max_pairs = 500;
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    return inspect_surface(soup, options);
  };
  const SurfaceReport one = with_threads(1);
  EXPECT_GT(one.intersecting_pairs, 500);
  EXPECT_EQ(one.pairs.size(), 500U);
  EXPECT_GT(one.by_index.duplicate_faces, 0);
  EXPECT_GT(one.by_position.nonmanifold_edges, 0);
  EXPECT_GT(one.degenerate_faces, 0);
  for (const std::size_t threads : {2U, 8U}) {
    SCOPED_TRACE(threads);
    expect_same(one, with_threads(threads));
  }
}

TEST(SurfaceReport, ListsTheFirstPairs) {
  const TriangleSoup soup = damaged_soup();
  SurfaceCheckOptions options;
  options.max_pairs = std::numeric_limits<std::size_t>::max();
  const SurfaceReport all = inspect_surface(soup, options);
  ASSERT_EQ(static_cast<std::int64_t>(all.pairs.size()), all.intersecting_pairs);
  EXPECT_TRUE(std::is_sorted(all.pairs.begin(), all.pairs.end()));
  EXPECT_EQ(std::adjacent_find(all.pairs.begin(), all.pairs.end()), all.pairs.end());
  for (const std::size_t limit : {0U, 1U, 100U}) {
    options.max_pairs = limit;
    const SurfaceReport some = inspect_surface(soup, options);
    EXPECT_EQ(some.intersecting_pairs, all.intersecting_pairs);
    ASSERT_EQ(some.pairs.size(), limit);
    EXPECT_TRUE(std::equal(some.pairs.begin(), some.pairs.end(), all.pairs.begin()));
  }
}

}  // namespace
}  // namespace cellocut
