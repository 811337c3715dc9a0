// A cut problem as a graph of Boost.Graph with explicit terminals, for the adapters to its maximum
// flow algorithms.
#pragma once

#include <array>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/property_map/property_map.hpp>
#include <cstdint>
#include <vector>

#include "cellocut/cut/cut_solver.h"

namespace cellocut::solvers {

// An arc and its opposite of capacity 0 for each direction of an edge that has capacity, and for
// each terminal arc; arcs in rows by their tail. (One pair for both directions would be smaller,
// but push_relabel_max_flow, where it turns its preflow into a flow, takes an arc for an opposite
// by its capacity of 0, and returns what does not balance.)
class BoostInstance {
 public:
  using Graph =
      boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                         boost::no_property, std::uint32_t, std::uint64_t>;
  using Arc = boost::graph_traits<Graph>::edge_descriptor;

  BoostInstance(const CutProblem& problem, const SolveContext& context);

  [[nodiscard]] const Graph& graph() const { return graph_; }
  [[nodiscard]] std::uint32_t source() const { return source_; }
  [[nodiscard]] std::uint32_t sink() const { return source_ + 1; }

  [[nodiscard]] std::int64_t capacity(const Arc& arc) const { return capacity_[number(arc)]; }
  [[nodiscard]] const Arc& opposite(const Arc& arc) const { return opposite_[number(arc)]; }
  [[nodiscard]] std::int64_t residual(const Arc& arc) const { return residual_[number(arc)]; }
  // Polls for cancellation every few thousand calls: the algorithms have no other door for it.
  void set_residual(const Arc& arc, std::int64_t value) {
    constexpr std::uint32_t kPollInterval = 1U << 12U;
    if (++writes_ % kPollInterval == 0) context_.check();
    residual_[number(arc)] = value;
  }

  // Net flow per edge of the problem that this was made from, once an algorithm has set all
  // residual capacities.
  [[nodiscard]] std::vector<std::int64_t> edge_flow() const;
  [[nodiscard]] std::int64_t bytes() const;

 private:
  [[nodiscard]] std::size_t number(const Arc& arc) const {
    return boost::get(boost::edge_index, graph_, arc);
  }

  const SolveContext& context_;
  Graph graph_;
  std::uint32_t source_ = 0;
  std::vector<std::int64_t> capacity_;                      // by arc
  std::vector<std::int64_t> residual_;                      // by arc
  std::vector<Arc> opposite_;                               // by arc
  std::vector<std::array<std::uint64_t, 2>> arcs_of_edge_;  // forwards and back
  std::uint32_t writes_ = 0;
};

// The same as property maps, which is how Boost.Graph wants to see them.
struct BoostCapacities {
  using key_type = BoostInstance::Arc;
  using value_type = std::int64_t;
  using reference = std::int64_t;
  using category = boost::readable_property_map_tag;
  const BoostInstance* instance;
  friend std::int64_t get(const BoostCapacities& map, const key_type& arc) {
    return map.instance->capacity(arc);
  }
};

struct BoostResiduals {
  using key_type = BoostInstance::Arc;
  using value_type = std::int64_t;
  using reference = std::int64_t;
  using category = boost::read_write_property_map_tag;
  BoostInstance* instance;
  friend std::int64_t get(const BoostResiduals& map, const key_type& arc) {
    return map.instance->residual(arc);
  }
  friend void put(const BoostResiduals& map, const key_type& arc, std::int64_t value) {
    map.instance->set_residual(arc, value);
  }
};

struct BoostOpposites {
  using key_type = BoostInstance::Arc;
  using value_type = BoostInstance::Arc;
  using reference = const BoostInstance::Arc&;
  using category = boost::readable_property_map_tag;
  const BoostInstance* instance;
  friend reference get(const BoostOpposites& map, const key_type& arc) {
    return map.instance->opposite(arc);
  }
};

}  // namespace cellocut::solvers
