// The relaxation as arrays for the iteration, and the iteration itself.
//
// Notation. Node i has a variable x_i in [0, 1], 1 on the source side; edge e has a dual flow y_e
// within its capacities. With t_i = to_sink - to_source the problem is the saddle point
//     min over x, max over y of   sum t_i x_i + sum y_e (x_from - x_to).
//
// Layout. Nodes are sorted by degree within windows; eight nodes make a slice, and arc j of all
// eight sits side by side (SELL-8). The caller gives neighbours numbers close together. Each node
// holds its own copy of the dual flow of its edges, counted outwards, so that one pass over the
// nodes does the dual step and the primal step: both copies of an edge are updated by the same
// operations with opposite signs and stay exact opposites. Rows are padded with arcs without
// capacity.
//
// Numbers are 32-bit floats in units of the mean capacity: the pass is bound by memory, and what
// they cannot resolve is repaired in integers (rounding.h). Nothing depends on the order in which
// tasks run: blocks of slices are fixed, and their sums are added up in order.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "solvers/residual_graph.h"

namespace cellocut::solvers::lp {

// Step sizes: dual y += step * weight * c/2 * dx, primal x -= step / weight / degree * gradient.
struct Steps {
  float step = 1;
  float weight = 1;
};

// Of the last step, in the norms of the preconditioner.
struct Movement {
  double primal = 0;  // squared
  double dual = 0;    // squared
  double cross = 0;   // dual movement times operator times primal movement
};

struct Gap {
  double primal = 0;
  double dual = 0;
  [[nodiscard]] double size() const { return primal - dual; }
};

class Operator {
 public:
  explicit Operator(const ResidualGraph& graph);

  // One iteration. A sampled one also measures the movement and counts towards the average.
  void iterate(const Steps& steps);
  Movement iterate_sampled(const Steps& steps);

  // Values of the relaxation at the current point and at the average since the last restart,
  // without the part that no labelling changes. Both points are feasible, so the gap is a true one.
  [[nodiscard]] Gap gap() const { return gap_of(x_, y_); }
  [[nodiscard]] Gap average_gap() const;
  // Goes on from the average or from where it is, and forgets the average. The movement is that
  // since the last restart.
  Movement restart(bool from_average);

  [[nodiscard]] float value(std::uint32_t node) const { return x_[position_[node]]; }
  // Dual flow of an edge that has arcs, in units of its capacities, from `from` to `to`.
  [[nodiscard]] double flow(std::size_t edge) const {
    return static_cast<double>(y_[slot_of_edge_[edge]]) * scale_;
  }
  [[nodiscard]] bool has_arcs(std::size_t edge) const { return slot_of_edge_[edge] != kNoSlot; }
  [[nodiscard]] std::int64_t bytes() const;

 private:
  using Lanes = Eigen::Array<float, 8, 1>;
  static constexpr std::uint32_t kLanes = 8;
  static constexpr std::size_t kNoSlot = ~std::size_t{0};
  static constexpr std::size_t kBlock = 256;  // slices

  void order_nodes(const ResidualGraph& graph);
  template <bool kSampled>
  Movement pass(const Steps& steps);
  [[nodiscard]] Gap gap_of(const Eigen::ArrayXf& x, const Eigen::ArrayXf& y) const;
  void load_average(Eigen::ArrayXf& x, Eigen::ArrayXf& y) const;
  template <class Sum, class Work>
  Sum over_blocks(const Work& work) const;

  std::uint32_t slices_ = 0;
  double scale_ = 1;
  std::vector<std::uint32_t> position_;    // of a node
  std::vector<std::uint32_t> node_;        // at a position
  std::vector<std::size_t> row_;           // first slot of a slice, one more than slices
  std::vector<std::uint32_t> head_;        // per slot, a position
  std::vector<std::size_t> slot_of_edge_;  // at the edge's `from`
  Eigen::ArrayXf upper_;                   // per slot, capacity outwards
  Eigen::ArrayXf lower_;                   // minus the capacity inwards
  Eigen::ArrayXf terminal_;                // t, per position
  Eigen::ArrayXf inverse_degree_;
  Eigen::ArrayXf x_, extrapolated_, next_extrapolated_, y_;
  Eigen::ArrayXf x_sum_, y_sum_;      // over the sampled iterations since the restart
  Eigen::ArrayXf x_start_, y_start_;  // at the restart
  std::int64_t samples_ = 0;
};

}  // namespace cellocut::solvers::lp
