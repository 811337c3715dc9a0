#include "solvers/lp/operator.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace cellocut::solvers::lp {

namespace {

constexpr std::uint32_t kNone = 0xffff'ffffU;

double mean_capacity(const ResidualGraph& graph) {
  double sum = 0;
  std::size_t count = 0;
  for (const std::int64_t capacity : graph.residual) {
    if (capacity == 0) continue;
    sum += static_cast<double>(capacity);
    ++count;
  }
  for (const std::int64_t terminal : graph.terminal) {
    if (count > 0 && !graph.arcs.empty()) break;
    sum += std::abs(static_cast<double>(terminal));
    ++count;
  }
  return sum > 0 ? sum / static_cast<double>(count) : 1;
}

}  // namespace

void Operator::order_nodes(const ResidualGraph& graph) {
  // Few enough that neighbours stay in few cache lines.
  constexpr std::size_t kWindow = 512;
  const std::uint32_t nodes = graph.node_count();
  node_.resize(nodes);
  std::iota(node_.begin(), node_.end(), 0U);
  const auto degree = [&](std::uint32_t i) { return graph.row[i + 1] - graph.row[i]; };
  for (std::size_t begin = 0; begin < nodes; begin += kWindow) {
    const std::size_t end = std::min<std::size_t>(begin + kWindow, nodes);
    std::stable_sort(node_.begin() + static_cast<std::ptrdiff_t>(begin),
                     node_.begin() + static_cast<std::ptrdiff_t>(end),
                     [&](std::uint32_t a, std::uint32_t b) { return degree(a) > degree(b); });
  }
  position_.resize(nodes);
  for (std::uint32_t p = 0; p < nodes; ++p) position_[node_[p]] = p;
}

Operator::Operator(const ResidualGraph& graph) : scale_(mean_capacity(graph)) {
  order_nodes(graph);
  const std::uint32_t nodes = graph.node_count();
  slices_ = (nodes + kLanes - 1) / kLanes;
  node_.resize(std::size_t{slices_} * kLanes, kNone);

  row_.assign(std::size_t{slices_} + 1, 0);
  for (std::uint32_t p = 0; p < nodes; ++p) {
    const std::uint32_t i = node_[p];
    row_[p / kLanes + 1] =
        std::max<std::size_t>(row_[p / kLanes + 1], graph.row[i + 1] - graph.row[i]);
  }
  for (std::uint32_t s = 0; s < slices_; ++s) row_[s + 1] = row_[s] + kLanes * row_[s + 1];

  const auto slots = static_cast<Eigen::Index>(row_[slices_]);
  const auto positions = static_cast<Eigen::Index>(node_.size());
  head_.resize(row_[slices_]);
  slot_of_edge_.assign(graph.residual.size() / 2, kNoSlot);
  upper_.setZero(slots);
  lower_.setZero(slots);
  terminal_.setZero(positions);
  inverse_degree_.setZero(positions);
  x_.setZero(positions);
  for (std::uint32_t p = 0; p < node_.size(); ++p) {
    const std::size_t first = row_[p / kLanes] + p % kLanes;
    for (std::size_t k = first; k < row_[p / kLanes + 1]; k += kLanes) head_[k] = p;
    if (node_[p] == kNone) continue;
    const std::uint32_t i = node_[p];
    double degree = 0;
    std::size_t k = first;
    for (std::uint32_t a = graph.row[i]; a < graph.row[i + 1]; ++a, k += kLanes) {
      const Arc arc = graph.arcs[a];
      const auto slot = static_cast<Eigen::Index>(k);
      head_[k] = position_[arc.head];
      upper_[slot] = static_cast<float>(static_cast<double>(graph.residual[arc.id]) / scale_);
      lower_[slot] = static_cast<float>(-static_cast<double>(graph.residual[arc.id ^ 1U]) / scale_);
      degree += std::max(upper_[slot], -lower_[slot]);
      if ((arc.id & 1U) == 0) slot_of_edge_[arc.id / 2] = k;
    }
    terminal_[p] = static_cast<float>(-static_cast<double>(graph.terminal[i]) / scale_);
    // A node that only its terminal acts on goes to its side at once.
    if (degree == 0) degree = std::abs(terminal_[p]);
    inverse_degree_[p] = degree > 0 ? static_cast<float>(1 / degree) : 0;
    x_[p] = terminal_[p] < 0 ? 1.0F : (terminal_[p] > 0 ? 0.0F : 0.5F);
  }
  extrapolated_ = x_;
  next_extrapolated_ = x_;
  y_.setZero(slots);
  x_sum_.setZero(positions);
  y_sum_.setZero(slots);
  x_start_ = x_;
  y_start_ = y_;
}

template <class Sum, class Work>
Sum Operator::over_blocks(const Work& work) const {
  const std::size_t blocks = (slices_ + kBlock - 1) / kBlock;
  std::vector<Sum> sums(blocks);
  const auto run = [&](std::size_t b) {
    sums[b] = work(b * kBlock, std::min<std::size_t>((b + 1) * kBlock, slices_));
  };
  if (blocks < 4) {
    for (std::size_t b = 0; b < blocks; ++b) run(b);
  } else {
    tbb::parallel_for(std::size_t{0}, blocks, run, tbb::static_partitioner());
  }
  Sum total{};
  for (const Sum& sum : sums) total += sum;
  return total;
}

namespace {

struct MovementSum : Movement {
  MovementSum& operator+=(const MovementSum& other) {
    primal += other.primal;
    dual += other.dual;
    cross += other.cross;
    return *this;
  }
};

struct GapSum : Gap {
  GapSum& operator+=(const GapSum& other) {
    primal += other.primal;
    dual += other.dual;
    return *this;
  }
};

}  // namespace

template <bool kSampled>
Movement Operator::pass(const Steps& steps) {
  using Map = Eigen::Map<Lanes>;
  using ConstMap = Eigen::Map<const Lanes>;
  const float dual_step = 0.5F * steps.step * steps.weight;
  const float primal_step = steps.step / steps.weight;
  const float* from = extrapolated_.data();
  const auto work = [&](std::size_t begin, std::size_t end) {
    MovementSum sum;
    for (std::size_t s = begin; s < end; ++s) {
      const std::size_t p = s * kLanes;
      const Lanes here = ConstMap(from + p);
      Lanes gradient = ConstMap(terminal_.data() + p);
      Lanes dual = Lanes::Zero();
      Lanes change = Lanes::Zero();
      for (std::size_t k = row_[s]; k < row_[s + 1]; k += kLanes) {
        const std::uint32_t* head = head_.data() + k;
        Lanes there;
        for (std::uint32_t l = 0; l < kLanes; ++l) there[l] = from[head[l]];
        const Lanes upper = ConstMap(upper_.data() + k);
        const Lanes lower = ConstMap(lower_.data() + k);
        Map y(y_.data() + k);
        const Lanes size = upper.max(-lower);
        const Lanes moved = (y + dual_step * size * (here - there)).min(upper).max(lower);
        gradient += moved;
        if constexpr (kSampled) {
          const Lanes step = moved - y;
          change += step;
          dual += (size > 0).select(step * step / size, 0.0F);
          Map(y_sum_.data() + k) += moved;
        }
        y = moved;
      }
      Map x(x_.data() + p);
      const ConstMap inverse_degree(inverse_degree_.data() + p);
      const Lanes moved = (x - primal_step * inverse_degree * gradient).min(1.0F).max(0.0F);
      if constexpr (kSampled) {
        const Lanes step = moved - x;
        sum.primal += static_cast<double>(
            (inverse_degree > 0).select(step * step / inverse_degree, 0.0F).sum());
        sum.dual += static_cast<double>(dual.sum());
        sum.cross += static_cast<double>((step * change).sum());
        Map(x_sum_.data() + p) += moved;
      }
      Map(next_extrapolated_.data() + p) = 2.0F * moved - x;
      x = moved;
    }
    return sum;
  };
  const MovementSum movement = over_blocks<MovementSum>(work);
  extrapolated_.swap(next_extrapolated_);
  if (kSampled) ++samples_;
  return movement;
}

void Operator::iterate(const Steps& steps) { (void)pass<false>(steps); }

Movement Operator::iterate_sampled(const Steps& steps) { return pass<true>(steps); }

Gap Operator::gap_of(const Eigen::ArrayXf& x, const Eigen::ArrayXf& y) const {
  return over_blocks<GapSum>([&](std::size_t begin, std::size_t end) {
    GapSum sum;
    for (std::size_t s = begin; s < end; ++s) {
      for (std::uint32_t l = 0; l < kLanes; ++l) {
        const auto p = static_cast<Eigen::Index>(s * kLanes + l);
        double cut = 0;
        double gradient = terminal_[p];
        for (std::size_t k = row_[s] + l; k < row_[s + 1]; k += kLanes) {
          const auto slot = static_cast<Eigen::Index>(k);
          const double fall = x[p] - x[static_cast<Eigen::Index>(head_[k])];
          if (fall > 0) cut += fall * upper_[slot];
          gradient += y[slot];
        }
        sum.primal += terminal_[p] * static_cast<double>(x[p]) + cut;
        sum.dual += std::min(gradient, 0.0);
      }
    }
    return sum;
  });
}

void Operator::load_average(Eigen::ArrayXf& x, Eigen::ArrayXf& y) const {
  const float share = samples_ > 0 ? 1.0F / static_cast<float>(samples_) : 0.0F;
  // Rounding may leave the box by an ulp.
  x = (x_sum_ * share).min(1.0F).max(0.0F);
  y = (y_sum_ * share).min(upper_).max(lower_);
}

Gap Operator::average_gap() const {
  Eigen::ArrayXf x;
  Eigen::ArrayXf y;
  load_average(x, y);
  return gap_of(x, y);
}

Movement Operator::restart(bool from_average) {
  if (from_average && samples_ > 0) {
    load_average(x_, y_);
    extrapolated_ = x_;
  }
  const MovementSum movement = over_blocks<MovementSum>([&](std::size_t begin, std::size_t end) {
    MovementSum sum;
    const auto squares = [](const auto& step, const auto& size) {
      return static_cast<double>((size > 0).select(step * step / size, 0.0F).sum());
    };
    const auto first = static_cast<Eigen::Index>(begin * kLanes);
    const auto count = static_cast<Eigen::Index>((end - begin) * kLanes);
    sum.primal = squares(x_.segment(first, count) - x_start_.segment(first, count),
                         inverse_degree_.segment(first, count));
    const auto slot = static_cast<Eigen::Index>(row_[begin]);
    const auto slots = static_cast<Eigen::Index>(row_[end] - row_[begin]);
    sum.dual = squares(y_.segment(slot, slots) - y_start_.segment(slot, slots),
                       upper_.segment(slot, slots).max(-lower_.segment(slot, slots)));
    return sum;
  });
  x_start_ = x_;
  y_start_ = y_;
  x_sum_.setZero();
  y_sum_.setZero();
  samples_ = 0;
  return movement;
}

std::int64_t Operator::bytes() const {
  const auto slots = static_cast<std::int64_t>(head_.size());
  const auto positions = static_cast<std::int64_t>(node_.size());
  return slots * 6 * 4 + positions * 9 * 4 +
         static_cast<std::int64_t>(slot_of_edge_.size() * sizeof(std::size_t) +
                                   row_.size() * sizeof(std::size_t));
}

}  // namespace cellocut::solvers::lp
