// `--surface union`: the field against its definition, point by point.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <deque>
#include <functional>

#include "cellocut/base/predicates.h"
#include "cellocut/field/sparse_grid.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/surface/interface.h"
#include "cellocut/surface/union_field.h"
#include "pipeline_runs.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut::testing {
namespace {

// All grid points of a frame, one value each.
class DenseGrid {
 public:
  DenseGrid(int extent, std::uint8_t value)
      : extent_(extent), values_(static_cast<std::size_t>(extent) * extent * extent, value) {}

  [[nodiscard]] std::uint8_t& at(int x, int y, int z) {
    return values_[(static_cast<std::size_t>(x) * extent_ + y) * extent_ + z];
  }
  [[nodiscard]] bool holds(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < extent_ && y < extent_ && z < extent_;
  }
  void for_each(const std::function<void(int, int, int)>& visit) const {
    for (int x = 0; x < extent_; ++x) {
      for (int y = 0; y < extent_; ++y) {
        for (int z = 0; z < extent_; ++z) visit(x, y, z);
      }
    }
  }

 private:
  int extent_;
  std::vector<std::uint8_t> values_;
};

constexpr std::uint8_t kBeyondHull = 2;

// For each grid point what `of_cell` is for the cell that holds it, kBeyondHull where none does.
DenseGrid cells_at_points(const RemeshResult& result, const CellLabels& of_cell) {
  const TetComplex& complex = result.complex;
  DenseGrid grid(result.frame.extent, kBeyondHull);
  for (std::uint32_t c = 0; c < complex.cells.size(); ++c) {
    std::array<Point3, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = result.frame.to_index(complex.points[complex.cells[c][k]]);
    std::array<int, 3> low{};
    std::array<int, 3> high{};
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] =
          static_cast<int>(std::ceil(std::min({p[0][axis], p[1][axis], p[2][axis], p[3][axis]})));
      high[axis] =
          static_cast<int>(std::floor(std::max({p[0][axis], p[1][axis], p[2][axis], p[3][axis]})));
    }
    for (int x = low[0]; x <= high[0]; ++x) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int z = low[2]; z <= high[2]; ++z) {
          const Point3 q{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
          if (orientation(q, p[1], p[2], p[3]) >= 0 && orientation(p[0], q, p[2], p[3]) >= 0 &&
              orientation(p[0], p[1], q, p[3]) >= 0 && orientation(p[0], p[1], p[2], q) >= 0) {
            grid.at(x, y, z) = of_cell[c];
          }
        }
      }
    }
  }
  return grid;
}

// By point: the fewest grid edges from one that is `open`, along points that are open or members;
// kUnreached beyond `most`.
constexpr std::uint8_t kUnreached = 255;
DenseGrid steps_from_open(int extent, const std::function<bool(int, int, int)>& member,
                          const std::function<bool(int, int, int)>& open, int most) {
  DenseGrid steps(extent, kUnreached);
  std::deque<std::array<int, 3>> queue;
  steps.for_each([&](int x, int y, int z) {
    if (!open(x, y, z)) return;
    steps.at(x, y, z) = 0;
    queue.push_back({x, y, z});
  });
  for (; !queue.empty(); queue.pop_front()) {
    const auto [x, y, z] = queue.front();
    const int taken = steps.at(x, y, z);
    if (taken == most) continue;
    for (int d = 0; d < 6; ++d) {
      std::array<int, 3> next{x, y, z};
      next[d / 2] += d % 2 == 0 ? 1 : -1;
      if (!steps.holds(next[0], next[1], next[2])) continue;
      if (steps.at(next[0], next[1], next[2]) != kUnreached) continue;
      if (!member(next[0], next[1], next[2])) continue;
      steps.at(next[0], next[1], next[2]) = static_cast<std::uint8_t>(taken + 1);
      queue.push_back(next);
    }
  }
  return steps;
}

struct Case {
  std::string name;
  TriangleSoup soup;
  std::int64_t lambda;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

// Two parallel sheets, 2.4 grid steps apart at R = 40: little more than the slabs around them fill.
TriangleSoup narrow_slot() {
  const Point3 normal{0.36, -0.48, 0.8};  // of length 1
  const TriangleSoup sheet = test::tilted_sheet(normal, 1, 8);
  const Box3 box = bounding_box(sheet.points);
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, box.high[axis] - box.low[axis]);
  TriangleSoup slot = sheet;
  test::append(slot, test::translated(sheet, 2.4 / 40 * longest * normal));
  return slot;
}

std::vector<Case> cases() {
  return {{"bowl_filled", test::open_bowl(), 1},
          {"bowl_open", test::open_bowl(), 20},
          {"sphere_filled", test::sphere_with_hole(), 5},
          {"sphere_hollow", test::sphere_with_hole(), 40},
          {"nested_spheres", test::nested_spheres(), 20},
          {"crossing_boxes", test::two_crossing_boxes(), 20},
          {"moebius", test::moebius_strip(), 20},
          {"narrow_slot", narrow_slot(), 20}};
}

class UnionField : public ::testing::TestWithParam<Case> {
 protected:
  static RemeshResult run_case(int resolution) {
    RemeshOptions options = at_resolution(resolution, SurfaceMode::union_);
    options.lambda_fill = {GetParam().lambda, 1};
    return run(GetParam().soup, options);
  }
};

TEST_P(UnionField, IsWhatItsDefinitionSays) {
  const RemeshResult result = run_case(40);
  expect_sound(result);
  const int extent = result.frame.extent;
  CellLabels absorbed(result.label.size(), kExterior);
  for (std::size_t c = 0; c < absorbed.size(); ++c) {
    if (result.initial_label[c] == kExterior) absorbed[c] = result.label[c];
  }
  DenseGrid in_absorbed = cells_at_points(result, absorbed);
  DenseGrid in_interior = cells_at_points(result, result.label);
  const cellocut::UnionField made =
      compute_union_field(result.phi, result.complex, result.initial_label, result.label,
                          result.frame, silent_observer());
  const FieldTree& phi = result.phi.grid().tree;
  const auto phi_at = [&](int x, int y, int z) { return phi.getValue(openvdb::Coord(x, y, z)); };
  const auto outside = [&](int x, int y, int z) {
    return phi_at(x, y, z) > 0 && in_absorbed.at(x, y, z) != kInterior;
  };
  const auto beyond_cells = [&](int x, int y, int z) {
    return outside(x, y, z) && in_interior.at(x, y, z) != kInterior;
  };
  DenseGrid steps = steps_from_open(extent, outside, beyond_cells, 4);

  TriangleSoup boundary =
      interface_triangles(result.complex, list_interface(result.complex, absorbed));
  for (Point3& p : boundary.points) p = result.frame.to_index(p);
  const NearestTriangle nearest(boundary);
  const FieldTree& field = made.field.grid().tree;
  std::int64_t beyond = 0;
  std::int64_t left_out = 0;
  std::int64_t closed_points = 0;
  const auto is_closed = [&](int x, int y, int z) {
    return outside(x, y, z) && steps.at(x, y, z) == kUnreached;
  };
  const auto is_open = [&](int x, int y, int z) { return outside(x, y, z) && !is_closed(x, y, z); };
  // Whether the point is a corner of a cell of the grid that has an open corner: only there does
  // the value bear on the surface, not the sign alone.
  const auto beside_open = [&](int x, int y, int z) {
    for (int n = 0; n < 27; ++n) {
      const int i = x + n / 9 - 1;
      const int j = y + n / 3 % 3 - 1;
      const int k = z + n % 3 - 1;
      const bool on_grid = std::min({i, j, k}) >= 0 && std::max({i, j, k}) < extent;
      if (on_grid && is_open(i, j, k)) return true;
    }
    return false;
  };
  in_absorbed.for_each([&](int x, int y, int z) {
    const bool closed = is_closed(x, y, z);
    const bool solid = !outside(x, y, z) || closed;
    const float value = field.getValue(openvdb::Coord(x, y, z));
    ASSERT_EQ(value < 0, solid) << x << " " << y << " " << z;
    const Point3 p{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
    const NearestPoint found = nearest(p, 3);
    double region = std::min(found.distance, static_cast<double>(kBand));
    if (in_absorbed.at(x, y, z) == kInterior) region = -region;
    double expected = std::min(static_cast<double>(phi_at(x, y, z)), region);
    if (closed) expected = -expected;
    if (beside_open(x, y, z)) {
      ASSERT_NEAR(static_cast<double>(value), expected, 0x1p-14) << x << " " << y << " " << z;
    }
    const bool in_cell = in_interior.at(x, y, z) == kInterior;
    beyond += solid && !in_cell ? 1 : 0;
    left_out += !solid && in_cell ? 1 : 0;
    closed_points += closed ? 1 : 0;
  });
  const double volume = std::pow(result.frame.spacing, 3);
  EXPECT_NEAR(made.departures.beyond, static_cast<double>(beyond) * volume, 1e-9);
  EXPECT_NEAR(made.departures.left_out, static_cast<double>(left_out) * volume, 1e-9);
  if (GetParam().name == "narrow_slot") {
    EXPECT_GT(closed_points, 0);
  }
  EXPECT_NEAR(made.departures.closed, static_cast<double>(closed_points) * volume, 1e-9);
}

// Beyond 2 h from the supported facets the solid departs from the labelling in cells with L*
// interior alone.
TEST_P(UnionField, HonoursTheLabelling) {
  const RemeshResult result = run_case(64);
  TriangleSoup supported =
      interface_triangles(result.complex, list_interface(result.complex, result.initial_label));
  for (Point3& p : supported.points) p = result.frame.to_index(p);
  const NearestTriangle nearest(supported);
  DenseGrid initial = cells_at_points(result, result.initial_label);
  DenseGrid in_interior = cells_at_points(result, result.label);
  const cellocut::UnionField made =
      compute_union_field(result.phi, result.complex, result.initial_label, result.label,
                          result.frame, silent_observer());
  const FieldTree& field = made.field.grid().tree;
  initial.for_each([&](int x, int y, int z) {
    const bool solid = field.getValue(openvdb::Coord(x, y, z)) < 0;
    const bool in_cell = in_interior.at(x, y, z) == kInterior;
    if (solid == in_cell || initial.at(x, y, z) == kInterior) return;
    EXPECT_TRUE(nearest({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)}, 2)
                    .found())
        << x << " " << y << " " << z;
  });
}

TEST_P(UnionField, IsTheSameForAnyNumberOfThreads) {
  std::vector<RemeshResult> results;
  for (const std::size_t threads : {1, 2, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(run_case(48));
  }
  for (std::size_t n = 1; n < results.size(); ++n) {
    EXPECT_EQ(results[n].surface.points, results[0].surface.points);
    EXPECT_EQ(results[n].surface.triangles, results[0].surface.triangles);
    EXPECT_EQ(results[n].supported, results[0].supported);
  }
}

INSTANTIATE_TEST_SUITE_P(Pipeline, UnionField, ::testing::ValuesIn(cases()),
                         [](const ::testing::TestParamInfo<Case>& c) { return c.param.name; });

}  // namespace
}  // namespace cellocut::testing
