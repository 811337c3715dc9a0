// The iso-surface of arbitrary grid values is an embedded closed manifold; of known shapes it has
// their topology.
#include "cellocut/surface/iso_surface.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "cellocut/validity/surface_report.h"
#include "hand_made_field.h"

namespace cellocut::testing {
namespace {

// Across the ends of the blocks of 8 grid points.
const openvdb::Coord kLow(5, 14, 6);

void expect_valid(const SparseField& field) {
  const TriangleSoup surface = extract_iso_surface(field);
  const SurfaceReport report = inspect_surface(surface);
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.by_position.nonmanifold_edges, 0);
  EXPECT_EQ(report.by_position.nonmanifold_vertices, 0);
  EXPECT_EQ(report.touching_edges, 0);
  EXPECT_EQ(report.touching_vertices, 0);
  EXPECT_GT(report.volume, 0);
}

using Draw = double (*)(std::mt19937_64&);

double any_value(std::mt19937_64& random) { return uniform(random, -1.99, 1.99); }
// Zero itself, the smallest numbers there are, and large ones beside them.
double hard_value(std::mt19937_64& random) {
  constexpr double kChoices[] = {0.0,
                                 -0.0,
                                 1e-30,
                                 -1e-30,
                                 1.99,
                                 -1.99,
                                 1e-7,
                                 -1e-7,
                                 std::numeric_limits<float>::denorm_min(),
                                 -std::numeric_limits<float>::denorm_min()};
  return kChoices[random() % std::size(kChoices)];
}
double mostly_inside(std::mt19937_64& random) { return uniform(random, -1.99, 0.7); }
double mostly_outside(std::mt19937_64& random) { return uniform(random, -0.7, 1.99); }
// Signs that alternate between neighbours more often than not: ambiguous faces everywhere.
double mixed_value(std::mt19937_64& random) {
  return random() % 4 == 0 ? hard_value(random) : any_value(random);
}

class RandomFields : public ::testing::TestWithParam<Draw> {};

TEST_P(RandomFields, AreEmbedded) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const int size = 2 + static_cast<int>(seed % 5);
    expect_valid(closed_block(kLow, size, [&](int x, int, int) {
      // At least one inside point.
      const double value = GetParam()(random);
      return x == 0 ? -std::fabs(value) - 0.001 : value;
    }));
    if (HasFailure()) break;
  }
}

std::string name_of(const ::testing::TestParamInfo<Draw>& each) {
  constexpr const char* kNames[] = {"AnyValue", "HardValue", "MostlyInside", "MostlyOutside",
                                    "MixedValue"};
  return kNames[each.index];
}

INSTANTIATE_TEST_SUITE_P(IsoSurface, RandomFields,
                         ::testing::Values(&any_value, &hard_value, &mostly_inside, &mostly_outside,
                                           &mixed_value),
                         name_of);

TEST(IsoSurface, CheckerboardIsEmbedded) {
  for (const double value : {1e-30, 1.0}) {
    expect_valid(closed_block(
        kLow, 6, [value](int x, int y, int z) { return (x + y + z) % 2 == 0 ? -value : 1.5; }));
  }
}

TEST(IsoSurface, EmptyAndUniformFieldsHaveNoSurface) {
  EXPECT_TRUE(extract_iso_surface(SparseField()).empty());
  for (const double value : {-1.0, 0.0, 1.0}) {
    EXPECT_TRUE(extract_iso_surface(stored_block(kLow, 4, [value](int, int, int) {
                  return value;
                })).empty());
  }
}

TEST(IsoSurface, ZeroIsOutside) {
  EXPECT_TRUE(
      extract_iso_surface(closed_block(kLow, 1, [](int, int, int) { return 0.0; })).empty());
  const TriangleSoup surface =
      extract_iso_surface(closed_block(kLow, 1, [](int, int, int) { return -1e-6; }));
  EXPECT_EQ(surface.points.size(), 6U);
  EXPECT_EQ(surface.triangles.size(), 8U);
}

// Where the values leave room, a vertex lies where the values say; elsewhere at the clearance.
TEST(IsoSurface, VerticesLieInsideTheirEdges) {
  const TriangleSoup surface =
      extract_iso_surface(closed_block(kLow, 1, [](int, int, int) { return -0.5; }));
  for (const Point3& p : surface.points) {
    double distance = 0;
    for (int axis = 0; axis < 3; ++axis) distance += std::fabs(p[axis] - kLow[axis]);
    EXPECT_NEAR(distance, 0.25, 1e-7);
  }
  std::mt19937_64 random(3);
  const TriangleSoup rough =
      extract_iso_surface(closed_block(kLow, 6, [&](int, int, int) { return hard_value(random); }));
  for (const Point3& p : rough.points) {
    int fractions = 0;
    for (const double x : p) {
      const double fraction = x - std::floor(x);
      if (fraction == 0) continue;
      ++fractions;
      EXPECT_GE(fraction, kClearance);
      EXPECT_LE(fraction, 1 - kClearance);
    }
    EXPECT_TRUE(fractions == 1 || fractions == 3);
  }
}

// The shape's distance, cut off to the band.
template <class Distance>
SparseField shape(int size, const Distance& distance) {
  auto grid = std::make_shared<SparseField::Grid>();
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      for (int z = 0; z < size; ++z) {
        const double value = distance(x, y, z);
        if (std::fabs(value) < kBand) {
          grid->tree.setValueOn(openvdb::Coord(x, y, z), static_cast<float>(value));
        }
      }
    }
  }
  return SparseField(std::move(grid));
}

double sphere(double x, double y, double z) {
  return std::hypot(x - 12.3, y - 11.7, z - 12.1) - 8.4;
}
double torus(double x, double y, double z) {
  return std::hypot(std::hypot(x - 16.2, y - 15.9) - 9.3, z - 16.4) - 3.1;
}

TEST(IsoSurface, OfASphereIsASphere) {
  const TriangleSoup surface = extract_iso_surface(shape(25, sphere));
  const SurfaceReport report = inspect_surface(surface);
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.components.size(), 1U);
  EXPECT_EQ(report.euler, 2);
  EXPECT_NEAR(report.volume, 4.0 / 3.0 * M_PI * 8.4 * 8.4 * 8.4, 25);
  for (const Point3& p : surface.points) EXPECT_LT(std::fabs(sphere(p[0], p[1], p[2])), 0.05);
}

TEST(IsoSurface, OfATorusIsATorus) {
  const SurfaceReport report = inspect_surface(extract_iso_surface(shape(33, torus)));
  EXPECT_TRUE(report.valid());
  EXPECT_EQ(report.components.size(), 1U);
  EXPECT_EQ(report.euler, 0);
  EXPECT_NEAR(report.volume, 2 * M_PI * M_PI * 9.3 * 3.1 * 3.1, 50);
}

TEST(IsoSurface, JoinsInsidePointsAcrossAFaceAndAcrossACell) {
  for (const auto& other : {Point3{1, 1, 0}, Point3{1, 0, 1}, Point3{0, 1, 1}, Point3{1, 1, 1}}) {
    for (const double value : {-1e-20, -0.4, -1.9}) {
      const SparseField field = closed_block(kLow, 2, [&](int x, int y, int z) {
        const bool in =
            (x == 0 && y == 0 && z == 0) || (x == other[0] && y == other[1] && z == other[2]);
        return in ? value : 0.9;
      });
      const SurfaceReport report = inspect_surface(extract_iso_surface(field));
      EXPECT_TRUE(report.valid());
      EXPECT_EQ(report.components.size(), 1U);
      EXPECT_EQ(report.euler, 2);
    }
  }
}

TEST(IsoSurface, SeparatesOutsidePointsThatDoNotShareAnEdge) {
  for (const auto& other : {Point3{2, 2, 1}, Point3{2, 2, 2}}) {
    const SparseField field = closed_block(kLow, 4, [&](int x, int y, int z) {
      const bool out =
          (x == 1 && y == 1 && z == 1) || (x == other[0] && y == other[1] && z == other[2]);
      return out ? 0.9 : -0.9;
    });
    const SurfaceReport report = inspect_surface(extract_iso_surface(field));
    EXPECT_TRUE(report.valid());
    EXPECT_EQ(report.components.size(), 3U);  // the outer one and two voids
    EXPECT_EQ(report.euler, 6);
  }
}

TEST(IsoSurface, IsTheSameForAnyNumberOfThreads) {
  const SparseField field = shape(33, torus);
  std::vector<TriangleSoup> surfaces;
  for (const std::size_t threads : {1, 2, 8}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    surfaces.push_back(extract_iso_surface(field));
  }
  for (const TriangleSoup& surface : surfaces) {
    EXPECT_EQ(surface.points, surfaces[0].points);
    EXPECT_EQ(surface.triangles, surfaces[0].triangles);
  }
}

// A frame's rounding keeps the surface embedded, far from the origin too.
TEST(IsoSurface, StaysEmbeddedInInputUnits) {
  for (const double offset : {0.0, 1.0, 1e3, 1e6}) {
    std::mt19937_64 random(11);
    TriangleSoup surface = extract_iso_surface(
        closed_block(kLow, 6, [&](int, int, int) { return mixed_value(random); }));
    const Frame frame =
        make_frame({{offset, offset, offset}, {offset + 1, offset + 0.7, offset + 0.3}}, 512, 3);
    to_input_units(surface, frame);
    EXPECT_TRUE(inspect_surface(surface).valid()) << offset;
  }
}

}  // namespace
}  // namespace cellocut::testing
