#include "cellocut/surface/fairing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "cellocut/base/errors.h"
#include "cellocut/surface/laplacian.h"
#include "cellocut/surface/normal_moves.h"
#include "cellocut/surface/patch_solvers.h"
#include "cellocut/surface/patches.h"

namespace cellocut {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostTraceSteps = 1000;
// Of a vertex's first distance to the input, or of the clearance: how near it may come.
constexpr double kGuardOfDistance = 0.75;
constexpr double kGuardOfClearance = 0.5;
// In steps: a vertex that goes no further beyond its bound is stopped there without more ado.
constexpr double kToleratedExcess = 0.1;
constexpr double kPinStiffness = 10;  // per step; the bending term of one vertex has about 7
constexpr int kMostPinningPasses = 3;
constexpr int kFineRings = 2;       // of completed vertices at the rim and at pins
constexpr double kNodeSpacing = 3;  // steps
constexpr int kSpreadingSweeps = 5;
constexpr double kAcceptedGrowth = 1.2;  // of the bending energy in a round
constexpr double kSettledMove = 0.05;    // steps; a round that moves no vertex further is the last

void require(bool holds, const char* what) {
  if (!holds) throw UsageError(what);
}

// Lengths in grid steps, relative to a vertex of the patch: the solvers' thresholds are numbers of
// steps, and the place of the mesh in space does not cost digits.
struct Scale {
  Point3 origin{};
  double step = 1;

  [[nodiscard]] Point3 to_steps(const Point3& p) const {
    const Point3 d = p - origin;
    return {d[0] / step, d[1] / step, d[2] / step};
  }
  [[nodiscard]] Point3 from_steps(const Point3& p) const { return origin + step * p; }
};

class PatchFairing {
 public:
  PatchFairing(const FairingPatch& patch, const TriangleSoup& surface, const NearestTriangle& input,
               double step, double clearance, const FairingOptions& options,
               const Observer& observer)
      : patch_(patch),
        input_(input),
        options_(options),
        observer_(observer),
        scale_{surface.points[patch.vertices[0]], step},
        clearance_(clearance / step) {
    start_.reserve(patch.vertices.size());
    for (const std::uint32_t v : patch.vertices) {
      start_.push_back(scale_.to_steps(surface.points[v]));
    }
    points_ = start_;
    rows_ = laplace_pattern(patch);
  }

  // False where the patch has to stay as it is.
  bool run() {
    if (!patch_.has_rim()) return false;
    look_at_input();
    bending_before_ = bending_after_ = measure_bending();
    double length = options_.smoothing_steps;
    if (!smooth_facets(length)) return false;
    double bending = measure_bending();
    bool settled = false;
    for (int round = 0; round < options_.rounds && !settled; ++round) {
      const std::vector<Point3> last = points_;
      spread_vertices();
      settled = move_along_normals() < kSettledMove;
      const double moved = measure_bending();
      if (moved <= kAcceptedGrowth * bending) {
        bending = moved;
        continue;
      }
      // Still so rough that moves along normals tangle it: less far, and from something smoother.
      points_ = last;
      settled = false;
      length *= 2;
      if (!smooth_facets(length)) return false;
      bending = measure_bending();
    }
    stop_short_of_input(&stopped_);
    const double bending_after = measure_bending();
    if (!(bending_after <= bending_before_)) return false;
    bending_after_ = bending_after;
    return true;
  }

  // In the units of the surface.
  [[nodiscard]] Point3 target(std::uint32_t i) const { return scale_.from_steps(points_[i]); }
  [[nodiscard]] double move(std::uint32_t i) const {
    return scale_.step * norm(points_[i] - start_[i]);
  }
  [[nodiscard]] std::int64_t stopped() const { return stopped_; }
  [[nodiscard]] double bending_before() const { return bending_before_; }
  [[nodiscard]] double bending_after() const { return bending_after_; }

 private:
  [[nodiscard]] bool is_held(std::uint32_t i) const { return patch_.depth[i] > options_.rim_rings; }

  [[nodiscard]] NearestPoint nearest(const Point3& p, double limit = kInfinity) const {
    NearestPoint found = input_(scale_.from_steps(p), limit * scale_.step);
    found.distance /= scale_.step;
    return found;
  }

  // Guards of all movable vertices, and away from which point of the input supported ones lie.
  void look_at_input() {
    guard_.assign(patch_.movable, 0.0);
    away_.assign(patch_.movable, Point3{});
    for (std::uint32_t i = 0; i < patch_.movable; ++i) {
      const bool supported = patch_.depth[i] > 0;
      // A distance beyond the clearance makes no difference to the guard.
      const double limit = supported ? kInfinity : clearance_ + 1;
      const NearestPoint found = nearest(start_[i], limit);
      guard_[i] = std::min(kGuardOfClearance * clearance_, kGuardOfDistance * found.distance);
      if (!supported || !found.found() || !(found.distance > 0)) continue;
      away_[i] = (1 / found.distance) * (start_[i] - scale_.to_steps(found.point));
    }
  }

  double measure_bending() {
    set_cotangent_weights(rows_, patch_, points_);
    return bending_energy(rows_, points_, row_normals(patch_, points_));
  }

  // By a membrane over that many steps, from where the vertices are. False where it has no
  // solution.
  bool smooth_facets(double length) {
    std::vector<std::uint8_t> is_free(patch_.movable);
    for (std::uint32_t i = 0; i < patch_.movable; ++i) is_free[i] = patch_.depth[i] == 0 ? 1 : 0;
    // On a hexagonal lattice with edges of length 1 the sum over edges is 3/2 of the Laplacian.
    const double anchor = 1.5 / (length * length);
    if (!relax_membrane(rows_, is_free, anchor, points_)) return false;
    stop_short_of_input(nullptr);
    return true;
  }

  // Spreads the free vertices evenly within the surface: moves along normals stretch it here and
  // squeeze it there.
  void spread_vertices() {
    for (int sweep = 0; sweep < kSpreadingSweeps; ++sweep) {
      const std::vector<Point3> normals = row_normals(patch_, points_);
      std::vector<Point3> spread = points_;
      for (std::uint32_t i = 0; i < patch_.movable; ++i) {
        if (is_held(i)) continue;
        Point3 mean{};
        for (std::uint32_t k = rows_.first[i]; k < rows_.first[i + 1]; ++k) {
          mean = mean + points_[rows_.column[k]];
        }
        const Point3 way = (1.0 / (rows_.first[i + 1] - rows_.first[i])) * mean - points_[i];
        const Point3 move = 0.5 * (way - dot(way, normals[i]) * normals[i]);
        if (may_move(points_[i], move, guard_[i])) spread[i] = points_[i] + move;
      }
      std::swap(points_, spread);
    }
  }

  // Where something holds the surface, and some rings around, each vertex keeps a move of its own;
  // the basis for the others is made anew only where pins have come to be among them. Returns
  // whether it was.
  bool update_basis(const std::vector<DataTerm>& data, const std::vector<Point3>& normals) {
    std::vector<std::uint8_t> holds(patch_.movable);
    bool is_up_to_date = !is_fine_.empty();
    for (std::uint32_t i = 0; i < patch_.movable; ++i) {
      holds[i] = patch_.depth[i] > 0 || data[i].weight > 0 ? 1 : 0;
      if (is_up_to_date && holds[i] != 0 && is_fine_[i] == 0) is_up_to_date = false;
    }
    if (is_up_to_date) return false;
    for (int ring = 0; ring < kFineRings; ++ring) grow(holds);
    is_fine_ = std::move(holds);
    basis_ = make_displacement_basis(rows_, points_, normals, is_fine_, kNodeSpacing);
    return true;
  }

  void grow(std::vector<std::uint8_t>& marked) const {
    std::vector<std::uint8_t> grown = marked;
    for (std::uint32_t i = 0; i < patch_.movable; ++i) {
      for (std::uint32_t k = rows_.first[i]; k < rows_.first[i + 1]; ++k) {
        const std::uint32_t j = rows_.column[k];
        if (j < patch_.movable && marked[j] != 0) grown[i] = 1;
      }
    }
    std::swap(marked, grown);
  }

  // The input bounds the moves. Bounds are kept by an active set that only grows: who would go well
  // beyond is pinned where it has to stop, and the rest is solved again. (Bounds of Ceres itself
  // clamp each step and then shorten all of it, so that one vertex at its bound would stop the
  // whole patch.)
  // Returns the longest.
  double move_along_normals() {
    set_cotangent_weights(rows_, patch_, points_);
    const std::vector<Point3> normals = row_normals(patch_, points_);
    std::vector<double> curvature(patch_.rows);
    for (std::uint32_t i = 0; i < patch_.rows; ++i) {
      curvature[i] = dot(rows_.apply(points_, i), normals[i]);
    }
    NormalProblem problem{.data = std::vector<DataTerm>(patch_.movable),
                          .threshold = options_.outlier_steps,
                          .max_iterations = options_.max_iterations};
    for (std::uint32_t i = 0; i < patch_.movable; ++i) {
      if (!is_held(i)) continue;
      const Point3& away = away_[i] == Point3{} ? normals[i] : away_[i];
      problem.data[i] = {.weight = std::sqrt(options_.data_weight),
                         .offset = dot(points_[i] - start_[i], away),
                         .slope = dot(normals[i], away)};
    }
    is_fine_.clear();
    std::vector<double> moves(patch_.movable, 0.0);
    std::vector<double> bounded(patch_.movable, 0.0);
    NormalBending bending(rows_, curvature, patch_.movable);
    bool settled = false;
    for (int pass = 0; pass < kMostPinningPasses && !settled; ++pass) {
      observer_.check();
      if (update_basis(problem.data, normals) || pass == 0) bending.use_basis(basis_);
      bending.minimise(problem, moves);
      settled = true;
      for (std::uint32_t i = 0; i < patch_.movable; ++i) {
        const double length = std::fabs(moves[i]);
        const double free = std::min(
            length,
            free_length(points_[i], std::copysign(1.0, moves[i]) * normals[i], length, guard_[i]));
        const double bound = std::copysign(free, moves[i]);
        if (length > free + kToleratedExcess && problem.data[i].weight != kPinStiffness) {
          problem.data[i] = {.weight = kPinStiffness, .offset = -bound, .slope = 1};
          settled = false;
        }
        bounded[i] = bound;
      }
    }
    double longest = 0;
    for (std::uint32_t i = 0; i < patch_.movable; ++i) {
      points_[i] = points_[i] + bounded[i] * normals[i];
      longest = std::max(longest, std::fabs(bounded[i]));
    }
    return longest;
  }

  // How far one can go from p in a direction of length 1 and keep 3/4 of `guard` from the input; at
  // most `length`. Each step is no longer than the distance to the input, so that none is passed.
  [[nodiscard]] double free_length(const Point3& p, const Point3& direction, double length,
                                   double guard) const {
    double gone = 0;
    double last = 0;
    for (int i = 0; i < kMostTraceSteps; ++i) {
      const NearestPoint found = nearest(p + gone * direction, length - gone + guard);
      if (!found.found()) return length;
      if (found.distance < guard) return last;
      last = gone;
      gone += std::max(found.distance - guard, 0.25 * guard);
      if (gone >= length) return length;
    }
    return last;
  }

  [[nodiscard]] bool may_move(const Point3& p, const Point3& move, double guard) const {
    const double length = norm(move);
    return length > 0 && !(free_length(p, (1 / length) * move, length, guard) < length);
  }

  void stop_short_of_input(std::int64_t* count) {
    for (std::uint32_t i = 0; i < patch_.movable; ++i) {
      const Point3 way = points_[i] - start_[i];
      const double length = norm(way);
      if (!(length > 0)) continue;
      const double free = free_length(start_[i], (1 / length) * way, length, guard_[i]);
      if (!(free < length)) continue;
      points_[i] = start_[i] + (free / length) * way;
      if (count != nullptr) ++*count;
    }
  }

  const FairingPatch& patch_;
  const NearestTriangle& input_;
  const FairingOptions& options_;
  const Observer& observer_;
  Scale scale_;
  double clearance_;
  std::vector<Point3> start_;   // of every vertex of the patch
  std::vector<Point3> points_;  // where they are now
  std::vector<double> guard_;   // of every movable vertex
  std::vector<Point3> away_;    // unit; zero for completed vertices and for those on the input
  LaplaceRows rows_;
  std::vector<std::uint8_t> is_fine_;  // empty where there is no basis for the present surface
  RowMatrix basis_;                    // of the moves
  std::int64_t stopped_ = 0;
  double bending_before_ = 0;
  double bending_after_ = 0;
};

}  // namespace

void FairingOptions::validate() const {
  require(margin_rings >= 1 && margin_rings <= 100, "margin_rings must be between 1 and 100");
  require(rim_rings >= 0 && rim_rings <= margin_rings,
          "rim_rings must be between 0 and margin_rings");
  require(data_weight > 0 && std::isfinite(data_weight), "data_weight must be above 0");
  require(outlier_steps > 0 && std::isfinite(outlier_steps), "outlier_steps must be above 0");
  require(smoothing_steps > 0 && std::isfinite(smoothing_steps), "smoothing_steps must be above 0");
  require(rounds >= 0 && rounds <= 100, "rounds must be between 0 and 100");
  require(max_iterations >= 1 && max_iterations <= 1000,
          "max_iterations must be between 1 and 1000");
}

FairingResult fair_completed(const TriangleSoup& surface,
                             const std::vector<std::uint8_t>& supported,
                             const NearestTriangle& input, double step, double clearance,
                             const FairingOptions& options, Observer& observer) {
  options.validate();
  require(supported.size() == surface.points.size(), "fairing needs a flag for each vertex");
  require(step > 0 && std::isfinite(step), "the grid step must be above 0");
  require(clearance >= 0 && std::isfinite(clearance), "the clearance must not be below 0");
  FairingResult result;
  result.points = surface.points;
  const std::vector<FairingPatch> patches =
      find_patches(surface, supported, options.margin_rings, observer);
  result.patches = static_cast<std::int64_t>(patches.size());

  struct Outcome {
    bool moved = false;
    std::int64_t stopped = 0;
    double before = 0;
    double after = 0;
    double largest_move = 0;
  };
  std::vector<Outcome> outcomes(patches.size());
  // Large ones first, so that the last to end are small.
  std::vector<std::size_t> order(patches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&patches](std::size_t a, std::size_t b) {
    return patches[a].movable > patches[b].movable;
  });
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  const auto fair = [&](std::size_t p) {
    const FairingPatch& patch = patches[p];
    PatchFairing fairing(patch, surface, input, step, clearance, options, observer);
    Outcome& outcome = outcomes[p];
    outcome.moved = fairing.run();
    outcome.before = fairing.bending_before();
    outcome.after = fairing.bending_after();
    if (outcome.moved) {
      outcome.stopped = fairing.stopped();
      for (std::uint32_t i = 0; i < patch.movable; ++i) {
        const double move = fairing.move(i);
        if (!(move > 0)) continue;
        result.points[patch.vertices[i]] = fairing.target(i);
        outcome.largest_move = std::max(outcome.largest_move, move);
      }
    }
    observer.progress(static_cast<double>(++done) / static_cast<double>(patches.size()));
  };
  tbb::parallel_for(std::size_t{0}, patches.size(),
                    [&](std::size_t) { fair(order[next.fetch_add(1)]); });

  for (const Outcome& outcome : outcomes) {
    result.patches_left += outcome.moved ? 0 : 1;
    result.vertices_stopped += outcome.stopped;
    result.largest_move = std::max(result.largest_move, outcome.largest_move);
    result.bending_before += outcome.before;
    result.bending_after += outcome.after;
  }
  for (std::size_t v = 0; v < result.points.size(); ++v) {
    result.vertices_moved += result.points[v] != surface.points[v] ? 1 : 0;
  }
  return result;
}

}  // namespace cellocut
