#include "cellocut/surface/displacement_basis.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace cellocut {

namespace {

constexpr double kReach = 2.5;          // of a node, in spacings
constexpr std::size_t kLeastNodes = 9;  // for the six coefficients of a quadratic
constexpr double kLeastPivot = 1e-4;    // of the least squares; the largest is about 1

using Quadratic = Eigen::Matrix<double, 6, 1>;

// Walks along the surface among the rows, never further than `reach` from where it began.
class SurfaceWalk {
 public:
  SurfaceWalk(const LaplaceRows& rows, const std::vector<Point3>& points)
      : rows_(rows), points_(points), seen_(rows.rows(), 0) {}

  // Valid until the next call; the first is `from`.
  const std::vector<std::uint32_t>& within(std::uint32_t from, double reach) {
    found_.assign(1, from);
    seen_[from] = ++walk_;
    for (std::size_t i = 0; i < found_.size(); ++i) {
      for (std::uint32_t k = rows_.first[found_[i]]; k < rows_.first[found_[i] + 1]; ++k) {
        const std::uint32_t j = rows_.column[k];
        if (j >= rows_.rows() || seen_[j] == walk_) continue;
        if (!(squared_norm(points_[j] - points_[from]) < reach * reach)) continue;
        seen_[j] = walk_;
        found_.push_back(j);
      }
    }
    return found_;
  }

 private:
  const LaplaceRows& rows_;
  const std::vector<Point3>& points_;
  std::vector<std::uint32_t> seen_;  // by the walk of that number
  std::vector<std::uint32_t> found_;
  std::uint32_t walk_ = 0;
};

// Some at coarse vertices, and around them as far as nodes reach, no two nearer than the spacing.
std::vector<std::uint32_t> choose_nodes(const LaplaceRows& rows, SurfaceWalk& walk,
                                        const std::vector<std::uint8_t>& is_fine, double spacing) {
  enum : std::uint8_t { kOutside, kOpen, kTaken };
  std::vector<std::uint8_t> state(rows.rows(), kOutside);
  std::vector<std::uint32_t> region;
  for (std::uint32_t i = 0; i < is_fine.size(); ++i) {
    if (is_fine[i] != 0) continue;
    state[i] = kOpen;
    region.push_back(i);
  }
  const std::size_t coarse = region.size();
  for (std::size_t i = 0; i < coarse; ++i) {
    const bool at_border = [&] {
      for (std::uint32_t k = rows.first[region[i]]; k < rows.first[region[i] + 1]; ++k) {
        const std::uint32_t j = rows.column[k];
        if (j >= is_fine.size() || is_fine[j] != 0) return true;
      }
      return false;
    }();
    if (!at_border) continue;
    for (const std::uint32_t j : walk.within(region[i], kReach * spacing)) {
      if (state[j] != kOutside) continue;
      state[j] = kOpen;
      region.push_back(j);
    }
  }
  std::vector<std::uint32_t> nodes;
  for (const std::uint32_t i : region) {
    if (state[i] != kOpen) continue;
    nodes.push_back(i);
    for (const std::uint32_t j : walk.within(i, spacing)) state[j] = kTaken;
  }
  return nodes;
}

struct NodeInReach {
  std::uint32_t node;  // its number
  double weight;
};

// Weights of the nodes for vertex i instead of those of the kernel. False where they do not
// determine a quadratic.
bool fit_weights(const std::vector<Point3>& node_points, const Point3& at, const Point3& normal,
                 double spacing, std::vector<NodeInReach>& nodes) {
  if (nodes.size() < kLeastNodes) return false;
  const int least = static_cast<int>(
      std::min_element(normal.begin(), normal.end(),
                       [](double a, double b) { return std::fabs(a) < std::fabs(b); }) -
      normal.begin());
  Point3 axis{};
  axis[least] = 1;
  const Point3 across = cross(normal, axis);
  const double length = norm(across);
  if (!(length > 0)) return false;
  const Point3 e1 = (1 / (length * spacing)) * across;
  const Point3 e2 = cross(normal, e1);
  Eigen::Matrix<double, 6, 6> moments = Eigen::Matrix<double, 6, 6>::Zero();
  const auto quadratic = [&](std::uint32_t node) {
    const Point3 way = node_points[node] - at;
    const double x = dot(way, e1);
    const double y = dot(way, e2);
    Quadratic q;
    q << 1, x, y, x * x, x * y, y * y;
    return q;
  };
  for (const NodeInReach& n : nodes) {
    const Quadratic q = quadratic(n.node);
    moments.noalias() += n.weight * q * q.transpose();
  }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factors(moments);
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > kLeastPivot)) {
    return false;
  }
  const Quadratic row = factors.solve(Quadratic::Unit(0));
  for (NodeInReach& n : nodes) n.weight *= row.dot(quadratic(n.node));
  return true;
}

}  // namespace

RowMatrix make_displacement_basis(const LaplaceRows& rows, const std::vector<Point3>& points,
                                  const std::vector<Point3>& normals,
                                  std::vector<std::uint8_t> is_fine, double spacing) {
  const auto movable = static_cast<std::uint32_t>(is_fine.size());
  SurfaceWalk walk(rows, points);
  const std::vector<std::uint32_t> nodes = choose_nodes(rows, walk, is_fine, spacing);
  std::vector<Point3> node_points;
  node_points.reserve(nodes.size());
  std::vector<std::vector<NodeInReach>> in_reach(movable);
  const double reach = kReach * spacing;
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    node_points.push_back(points[nodes[n]]);
    for (const std::uint32_t i : walk.within(nodes[n], reach)) {
      if (i >= movable || is_fine[i] != 0) continue;
      const double near = 1 - squared_norm(points[i] - node_points[n]) / (reach * reach);
      in_reach[i].push_back({n, near * near * near * near});
    }
  }
  std::size_t entries = 0;
  for (std::uint32_t i = 0; i < movable; ++i) {
    if (is_fine[i] == 0 && !fit_weights(node_points, points[i], normals[i], spacing, in_reach[i])) {
      is_fine[i] = 1;
    }
    entries += is_fine[i] != 0 ? 1 : in_reach[i].size();
  }
  // Nodes that are left with no vertex have no number.
  constexpr int kUnused = -1;
  std::vector<int> number(nodes.size(), kUnused);
  int unknowns = 0;
  for (std::uint32_t i = 0; i < movable; ++i) {
    if (is_fine[i] != 0) continue;
    for (const NodeInReach& n : in_reach[i]) {
      if (number[n.node] == kUnused) number[n.node] = unknowns++;
    }
  }
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(entries);
  for (std::uint32_t i = 0; i < movable; ++i) {
    const auto row = static_cast<int>(i);
    if (is_fine[i] != 0) {
      triplets.emplace_back(row, unknowns++, 1.0);
    } else {
      for (const NodeInReach& n : in_reach[i]) triplets.emplace_back(row, number[n.node], n.weight);
    }
  }
  RowMatrix basis(static_cast<Eigen::Index>(movable), unknowns);
  basis.setFromTriplets(triplets.begin(), triplets.end());
  return basis;
}

}  // namespace cellocut
