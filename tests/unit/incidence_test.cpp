// How faces meet, against a count by looking at all of them, on sets of faces that meet in any way.
#include "cellocut/validity/incidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <utility>

namespace cellocut {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::uint32_t first_of(std::vector<std::uint32_t>& sets, std::uint32_t i) {
  while (sets[i] != i) i = sets[i];
  return i;
}

// Whether the faces around the vertex are one cycle or one path.
bool is_manifold(const std::vector<Triangle>& faces, std::uint32_t v) {
  std::map<std::uint32_t, std::vector<std::uint32_t>> link;
  for (const Triangle& t : faces) {
    for (int k = 0; k < 3; ++k) {
      if (t[k] != v) continue;
      link[t[(k + 1) % 3]].push_back(t[(k + 2) % 3]);
      link[t[(k + 2) % 3]].push_back(t[(k + 1) % 3]);
    }
  }
  if (link.empty()) return true;
  std::set<std::uint32_t> seen{link.begin()->first};
  std::vector<std::uint32_t> open{link.begin()->first};
  while (!open.empty()) {
    const std::uint32_t w = open.back();
    open.pop_back();
    for (const std::uint32_t x : link[w]) {
      if (seen.insert(x).second) open.push_back(x);
    }
  }
  const bool connected = seen.size() == link.size();
  return connected && std::all_of(link.begin(), link.end(),
                                  [](const auto& node) { return node.second.size() <= 2; });
}

Incidence count_slowly(const std::vector<Triangle>& faces, std::uint32_t points) {
  Incidence result;
  std::map<Edge, std::vector<std::pair<std::uint32_t, bool>>> edges;  // faces, and which way
  std::map<Triangle, std::int64_t> same;
  std::set<std::uint32_t> corners;
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    result.component.push_back(f);
    Triangle t = faces[f];
    if (!is_proper(t)) continue;
    ++result.proper_faces;
    for (int k = 0; k < 3; ++k) {
      const Edge edge = std::minmax(t[k], t[(k + 1) % 3]);
      edges[edge].emplace_back(f, t[k] < t[(k + 1) % 3]);
      corners.insert(t[k]);
    }
    std::sort(t.begin(), t.end());
    if (same[t]++ > 0) ++result.counts.duplicate_faces;
  }
  result.vertices = static_cast<std::int64_t>(corners.size());
  result.edges = static_cast<std::int64_t>(edges.size());
  for (const auto& [edge, at] : edges) {
    if (at.size() == 1) ++result.counts.boundary_edges;
    if (at.size() > 2) ++result.counts.nonmanifold_edges;
    if (at.size() == 2 && at[0].second == at[1].second) ++result.counts.misoriented_edges;
    for (const auto& [face, way] : at) {
      const std::uint32_t a = first_of(result.component, at[0].first);
      const std::uint32_t b = first_of(result.component, face);
      result.component[std::max(a, b)] = std::min(a, b);
      if (at.size() > 2) result.nonmanifold_edges.push_back({edge.first, edge.second, face});
    }
  }
  std::sort(result.nonmanifold_edges.begin(), result.nonmanifold_edges.end());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    result.component[f] = first_of(result.component, f);
  }
  std::vector<Triangle> proper;
  std::copy_if(faces.begin(), faces.end(), std::back_inserter(proper), is_proper);
  for (std::uint32_t v = 0; v < points; ++v) {
    result.nonmanifold_vertex.push_back(is_manifold(proper, v) ? 0 : 1);
    result.counts.nonmanifold_vertices += result.nonmanifold_vertex.back();
  }
  return result;
}

void expect_same(const std::vector<Triangle>& faces, std::uint32_t points) {
  const Incidence is = count_incidence(faces, corners_by_point(faces, points), silent_observer());
  const Incidence expected = count_slowly(faces, points);
  EXPECT_EQ(is.counts.boundary_edges, expected.counts.boundary_edges);
  EXPECT_EQ(is.counts.nonmanifold_edges, expected.counts.nonmanifold_edges);
  EXPECT_EQ(is.counts.misoriented_edges, expected.counts.misoriented_edges);
  EXPECT_EQ(is.counts.nonmanifold_vertices, expected.counts.nonmanifold_vertices);
  EXPECT_EQ(is.counts.duplicate_faces, expected.counts.duplicate_faces);
  EXPECT_EQ(is.vertices, expected.vertices);
  EXPECT_EQ(is.edges, expected.edges);
  EXPECT_EQ(is.proper_faces, expected.proper_faces);
  EXPECT_EQ(is.nonmanifold_vertex, expected.nonmanifold_vertex);
  EXPECT_EQ(is.nonmanifold_edges, expected.nonmanifold_edges);
  EXPECT_EQ(is.component, expected.component);
}

TEST(Incidence, AnyFacesOnFewPoints) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 3000; ++round) {
    const auto points = static_cast<std::uint32_t>(3 + random() % 6);
    const auto corner = [&] { return static_cast<std::uint32_t>(random() % points); };
    std::vector<Triangle> faces(1 + random() % 12);
    for (Triangle& t : faces) t = {corner(), corner(), corner()};
    expect_same(faces, points);
    if (HasFailure()) FAIL() << "round " << round;
  }
}

// Closed surfaces, among them those whose vertices have more faces than the quick way takes, and
// what a few faces turned, doubled or moved make of them.
TEST(Incidence, DoubleConesAndWhatDefectsMakeOfThem) {
  std::mt19937_64 random(6);
  for (int round = 0; round < 2000; ++round) {
    const auto rim = static_cast<std::uint32_t>(3 + random() % 18);
    std::vector<Triangle> faces;
    for (std::uint32_t i = 0; i < rim; ++i) {
      faces.push_back({i, (i + 1) % rim, rim});
      faces.push_back({(i + 1) % rim, i, rim + 1});
    }
    const auto any = [&]() -> Triangle& { return faces[random() % faces.size()]; };
    for (std::uint64_t defects = random() % 4; defects > 0; --defects) {
      switch (random() % 4) {
        case 0:
          std::swap(any()[0], any()[1]);
          break;
        case 1:
          faces.push_back(any());
          break;
        case 2:
          any()[random() % 3] = static_cast<std::uint32_t>(random() % (rim + 2));
          break;
        default:
          faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(random() % faces.size()));
      }
    }
    std::shuffle(faces.begin(), faces.end(), random);
    expect_same(faces, rim + 2);
    if (HasFailure()) FAIL() << "round " << round;
  }
}

}  // namespace
}  // namespace cellocut
