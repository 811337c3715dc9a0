// The filter before the exact test never says apart of faces that meet, and says so of many others.
#include "cellocut/validity/face_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// Two faces of their own corners, with coordinates up to `extent` by axis.
void expect_no_false_proof(std::mt19937_64& random, const Point3& extent) {
  const auto share = [&random] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  std::vector<Point3> points(6);
  for (Point3& p : points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = extent[axis] * share();
  }
  // The second face has a corner on either side of a point of the first.
  const Point3 inside = (1.0 / 3) * points[0] + ((1.0 / 3) * points[1] + (1.0 / 3) * points[2]);
  points[4] = inside + (inside - points[3]);
  if (is_degenerate(points[0], points[1], points[2])) return;
  if (is_degenerate(points[3], points[4], points[5])) return;
  const Triangle s{0, 1, 2};
  const Triangle t{3, 4, 5};
  if (!faces_intersect(points, s, t)) return;
  EXPECT_FALSE(PreparedFace(points, s).certainly_apart(points, t));
  EXPECT_FALSE(PreparedFace(points, t).certainly_apart(points, s));
}

// Products of three lengths near the largest and the smallest double: each factor is finite, what
// overflows or underflows on the way must not count as a proof.
TEST(FaceFilter, OverflowAndUnderflowAreNoProof) {
  std::mt19937_64 random(3);
  const auto power = [&random](double from, double to) {
    const double share = static_cast<double>(random() >> 11) * 0x1p-53;
    return std::pow(10.0, from + (to - from) * share);
  };
  for (int round = 0; round < 20000; ++round) {
    const double large = power(102, 104.5);
    expect_no_false_proof(random, {large, large, large});  // a height
    const double wide = power(153.9, 154.7);
    expect_no_false_proof(random, {wide, wide, power(-3, 9)});  // a normal
    const double thin = power(-163.2, -161.7);
    const double flat = power(-80, 80);
    expect_no_false_proof(random,
                          {power(80, 120), thin * flat, thin / flat});  // a normal, denormal
  }
}

// Of each kind one that was taken for a proof.
TEST(FaceFilter, PairsThatMeetFarOut) {
  const std::vector<std::vector<Point3>> pairs{
      {{-8.3421033155823223e+102, -1.2410590451239267e+102, 6.735205469089568e+102},
       {2.5184140641648877e+102, -2.3342230011300335e+102, -7.4491738592746292e+102},
       {3.4019374264386244e+102, -9.4527192738715326e+102, -1.4232891103324418e+102},
       {2.4888243996562194e+102, -5.5768285637034345e+102, 7.3600010207183535e+100},
       {-7.2159267793127943e+102, -2.0216180701560991e+102, 5.5475635845244635e+102},
       {-1.8136281205123844e+102, -6.6539047462283449e+102, 5.8694067347821404e+102}},
      {{-8.159764319483375e+153, -3.043909348566921e+154, -0.0106542040054506},
       {3.6600777156405435e+154, 3.478757878082639e+154, 0.0085294995126905578},
       {-3.0370879105760385e+154, 1.1037217950247182e+154, -0.0046655157556914854},
       {-5.8175492577449945e+153, 2.068439092034179e+154, -0.0042013447775347372},
       {-7.0718419076057453e+153, 1.3507124957384327e+153, -0.0035768469839600309},
       {1.5306806312495873e+154, -6.3891067208822782e+153, -0.0054842670353554219}},
      {{0, 0, 0},
       {-2.3278781106116243e+99, -2.021924665735525e-207, -2.0382169200536993e-119},
       {3.3229614743115709e+99, 8.0148501088504316e-207, 2.0156528093804644e-119},
       {-3.5079641566841255e+100, 4.5529693100620514e-207, 4.4627099767318839e-121},
       {3.6517453608404088e+100, -8.8544667752864734e-208, 7.927428240345108e-120},
       {2.4391689745857734e+99, 1.9611739043882637e-207, 3.6372277246200822e-120}}};
  for (const std::vector<Point3>& points : pairs) {
    EXPECT_TRUE(faces_intersect(points, {0, 1, 2}, {3, 4, 5}));
    EXPECT_FALSE(PreparedFace(points, {0, 1, 2}).certainly_apart(points, {3, 4, 5}));
    EXPECT_FALSE(PreparedFace(points, {3, 4, 5}).certainly_apart(points, {0, 1, 2}));
  }
}

}  // namespace
}  // namespace cellocut
