// The filter before the exact test never says apart of faces that meet, and says so of many others.
#include "cellocut/validity/face_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "cellocut/validity/triangle_pair.h"

namespace cellocut {
namespace {

struct Tally {
  int apart = 0;  // pairs that do not meet
  int proved = 0;
};

// Pairs of faces among seven points of a small lattice: many are coplanar, many touch. `flat`: all
// points in one plane, as in the flat parts of a surface.
Tally compare(bool flat, unsigned seed, double scale) {
  std::mt19937_64 random(seed);
  const auto coordinate = [&random, scale] {
    return scale * (static_cast<double>(random() % 7) - 3.0) / 3.0;
  };
  Tally tally;
  for (int round = 0; round < 20000; ++round) {
    std::vector<Point3> points;
    for (int n = 0; n < 7; ++n) {
      const double x = coordinate();
      const double y = coordinate();
      points.push_back({x, y, flat ? x - 2 * y : coordinate()});
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    const auto corner = [&] { return static_cast<std::uint32_t>(random() % points.size()); };
    const Triangle s{corner(), corner(), corner()};
    const Triangle t{corner(), corner(), corner()};
    const auto is_face = [&points](const Triangle& f) {
      return !is_degenerate(points[f[0]], points[f[1]], points[f[2]]);
    };
    if (!is_face(s) || !is_face(t)) continue;
    const bool proved = PreparedFace(points, s).certainly_apart(points, t);
    const bool meet = faces_intersect(points, s, t);
    EXPECT_FALSE(proved && meet) << "round " << round;
    tally.apart += meet ? 0 : 1;
    tally.proved += proved ? 1 : 0;
  }
  return tally;
}

TEST(FaceFilter, NeverSaysApartOfFacesThatMeet) {
  for (const double scale : {1.0, 1e-3, 0.1, 3e8}) {
    const Tally tally = compare(false, 1, scale);
    EXPECT_GT(tally.apart, 2000);
    EXPECT_GT(tally.proved, tally.apart / 2);
  }
}

TEST(FaceFilter, ProvesManyThatLieApartInOnePlane) {
  for (const double scale : {1.0, 1e-3, 0.1, 3e8}) {
    const Tally tally = compare(true, 2, scale);
    EXPECT_GT(tally.apart, 1000);
    // (On a lattice many of the others touch the line that would part them.)
    EXPECT_GT(tally.proved, tally.apart / 3);
  }
}

}  // namespace
}  // namespace cellocut
