// TetGen's incremental Delaunay tetrahedralization (Si, "TetGen, a Delaunay-based quality
// tetrahedral mesh generator", ACM TOMS 41(2), 2015).
//
// What the library does that the contract does not allow, and what is done about it:
// - it keeps global state (the constants of its predicates), so one call at a time;
// - it reports by throwing an int;
// - it starts from the first four points of its own order that a floating-point determinant, not
// its
//   exact predicate, takes to span space; where the determinant is all rounding (the corners of a
//   tilted face, say) it fails an assertion and aborts the process. So the order is ours: four
//   points whose volume has a certain sign, then all others in rounds along a Hilbert curve;
// - it has a tolerance relative to the bounding box, whose third power it compares with: set so
// small
//   that it decides nothing, yet not so small that the power underflows;
// - it renumbers points when it drops some: -J keeps the numbers, and a lost point is an error
// here;
// - its cells have the opposite orientation: every cell is oriented here by the exact predicate.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/spatial_sort.h>
#include <tetgen.h>

#include <algorithm>
#include <boost/property_map/property_map.hpp>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

#include "backends/backends.h"
#include "cellocut/base/predicates.h"

namespace cellocut::backends {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

const char* describe(int code) {
  switch (code) {
    case 1:
      return "out of memory";
    case 2:
      return "internal error";
    case 3:
      return "self-intersection";
    case 4:
      return "a feature smaller than its tolerance";
    case 5:
      return "two facets too close";
    case 10:
      return "the points do not span space within its tolerance";
    default:
      return "unknown error";
  }
}

// Whether rounding cannot turn the sign of the determinant of (a, b, c, d) in any order of
// evaluation (Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
// predicates", 1997, with a larger constant).
bool certain_volume(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const Point3 u = a - d;
  const Point3 v = b - d;
  const Point3 w = c - d;
  const auto absolute = [](double x, double y) { return std::abs(x * y); };
  const double permanent = (absolute(v[0], w[1]) + absolute(w[0], v[1])) * std::abs(u[2]) +
                           (absolute(w[0], u[1]) + absolute(u[0], w[1])) * std::abs(v[2]) +
                           (absolute(u[0], v[1]) + absolute(v[0], u[1])) * std::abs(w[2]);
  const double bound = 16 * std::numeric_limits<double>::epsilon() * permanent;
  return std::abs(dot(u, cross(v, w))) > bound && std::isnormal(bound);
}

template <class Measure>
std::uint32_t farthest(const std::vector<Point3>& points, const Measure& measure) {
  std::uint32_t best = 0;
  double most = -1;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const double value = measure(points[i]);
    if (value > most) {
      most = value;
      best = i;
    }
  }
  return best;
}

// Four points far apart, so that their volume is as certain as can be had cheaply. O(n).
std::array<std::uint32_t, 4> spanning_points(const std::vector<Point3>& points) {
  const auto first =
      static_cast<std::uint32_t>(std::min_element(points.begin(), points.end()) - points.begin());
  const Point3& a = points[first];
  const std::uint32_t second =
      farthest(points, [&](const Point3& p) { return squared_norm(p - a); });
  const Point3& b = points[second];
  const std::uint32_t third =
      farthest(points, [&](const Point3& p) { return squared_norm(cross(b - a, p - a)); });
  const Point3& c = points[third];
  const std::uint32_t fourth = farthest(points, [&](const Point3& p) {
    return certain_volume(a, b, c, p) ? std::abs(six_volumes(a, b, c, p)) : -1;
  });
  if (!certain_volume(a, b, c, points[fourth])) {
    throw Error("tetgen: the points are so close to one plane that it cannot start; use cgal");
  }
  return {first, second, third, fourth};
}

// Lets CGAL sort indices by the points behind them.
struct PointOfIndex {
  using key_type = std::uint32_t;
  using value_type = Kernel::Point_3;
  using reference = Kernel::Point_3;
  using category = boost::readable_property_map_tag;
  const std::vector<Point3>* points;
  friend Kernel::Point_3 get(const PointOfIndex& map, std::uint32_t i) {
    const Point3& p = (*map.points)[i];
    return {p[0], p[1], p[2]};
  }
};

std::vector<std::uint32_t> insertion_order(const std::vector<Point3>& points) {
  const std::array<std::uint32_t, 4> start = spanning_points(points);
  std::vector<std::uint32_t> order(start.begin(), start.end());
  order.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (std::find(start.begin(), start.end(), i) == start.end()) order.push_back(i);
  }
  CGAL::spatial_sort(order.begin() + 4, order.end(),
                     CGAL::Spatial_sort_traits_adapter_3<Kernel, PointOfIndex>({&points}));
  return order;
}

// Fills `output` with quadruples of positions in `order`.
void run_tetgen(const std::vector<Point3>& points, const std::vector<std::uint32_t>& order,
                tetgenio& output) {
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  tetgenio input;
  input.firstnumber = 0;
  input.numberofpoints = static_cast<int>(order.size());
  input.pointlist = new REAL[3 * order.size()];  // freed by tetgenio
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::copy_n(points[order[i]].begin(), 3, input.pointlist + 3 * i);
  }
  // Quiet, numbered from zero, no renumbering, no output of points, faces and boundary.
  char switches[] = "QzJNFB";
  tetgenbehavior behaviour;
  if (!behaviour.parse_commandline(switches)) throw Error("tetgen: switches not understood");
  behaviour.no_sort = 1;
  behaviour.epsilon = 1e-100;
  try {
    ::tetrahedralize(&behaviour, &input, &output);
  } catch (int code) {
    const std::string message = std::string("tetgen: ") + describe(code);
    if (code == 1) throw LimitError(message);
    throw Error(message);
  }
}

class TetgenTetrahedralizer final : public Tetrahedralizer {
 public:
  [[nodiscard]] const TetrahedralizerInfo& info() const override {
    static const TetrahedralizerInfo info{
        "tetgen", "TetGen 1.5, incremental Delaunay with exact predicates; one call at a time",
        "AGPL-3.0-or-later",
        "Si: TetGen, a Delaunay-based quality tetrahedral mesh generator. ACM TOMS 41(2), 2015"};
    return info;
  }

 private:
  [[nodiscard]] std::vector<std::array<std::uint32_t, 4>> do_tetrahedralize(
      const std::vector<Point3>& points) const override {
    if (points.size() > static_cast<std::size_t>(std::numeric_limits<int>::max() / 3)) {
      throw LimitError("tetgen: too many points for its 32-bit indices");
    }
    const std::vector<std::uint32_t> order = insertion_order(points);
    tetgenio output;
    run_tetgen(points, order, output);

    std::vector<std::array<std::uint32_t, 4>> cells(
        static_cast<std::size_t>(output.numberoftetrahedra));
    std::vector<std::uint8_t> is_corner(points.size(), 0);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      std::array<std::uint32_t, 4>& cell = cells[c];
      for (std::size_t k = 0; k < 4; ++k) {
        cell[k] = order.at(static_cast<std::size_t>(output.tetrahedronlist[4 * c + k]));
        is_corner[cell[k]] = 1;
      }
      const int sign =
          orientation(points[cell[0]], points[cell[1]], points[cell[2]], points[cell[3]]);
      if (sign == 0) throw Error("tetgen: a cell is flat");
      if (sign < 0) std::swap(cell[2], cell[3]);
    }
    std::size_t lost = 0;
    for (const std::uint8_t corner : is_corner) lost += corner == 0 ? 1 : 0;
    if (lost != 0) {
      throw Error("tetgen: " + std::to_string(lost) +
                  " points were lost: it took them for copies of points nearby");
    }
    return cells;
  }
};

}  // namespace

std::unique_ptr<Tetrahedralizer> make_tetgen() { return std::make_unique<TetgenTetrahedralizer>(); }

}  // namespace cellocut::backends
