#include "cellocut/path/auto_fill.h"

#include <algorithm>
#include <cmath>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

constexpr double kOtherSolid = 0.05;

}  // namespace

double FillChoice::margin() const {
  if (!runner_up || !(chosen.sides.one_sided > 0)) return 0;
  return 1 - runner_up->sides.one_sided / chosen.sides.one_sided;
}

FillChoice choose_fill(const CellPath& path, const std::vector<SheetSides>& sides,
                       const std::vector<PathSolid>& solids, std::int64_t largest_term) {
  FillChoice choice;
  choice.labellings = path.count();
  const auto candidate = [&](std::size_t k) {
    const LambdaInterval interval = interval_of(path.path, k);
    return FillCandidate{interval.from, interval.to, sides[k], solids[k].volume};
  };
  // The best of those that `wanted` takes.
  const auto best_of = [&](const auto& wanted) {
    std::optional<std::size_t> best;
    for (std::size_t k = 0; k < path.count(); ++k) {
      if (best && sides[k].one_sided < sides[*best].one_sided) continue;
      if (wanted(k)) best = k;
    }
    return best;
  };
  const auto lambda_of = [&](std::size_t k) {
    const LambdaInterval interval = interval_of(path.path, k);
    return simplest_between(interval.from, interval.to);
  };
  const auto usable = [&](std::size_t k) {
    const Lambda lambda = lambda_of(k);
    return std::max(lambda.p, lambda.q) <= largest_term;
  };
  const std::optional<std::size_t> best = best_of(usable);
  if (!best) {
    throw LimitError(
        "no labelling has a lambda_fill with terms that are small enough; lower "
        "--area-bits");
  }
  const Lambda lambda = lambda_of(*best);
  choice.lambda = {lambda.p, lambda.q};
  choice.chosen = candidate(*best);
  const double volume = choice.chosen.volume;
  const std::optional<std::size_t> second = best_of([&](std::size_t k) {
    return std::fabs(solids[k].volume - volume) > kOtherSolid * volume && usable(k);
  });
  if (second) choice.runner_up = candidate(*second);
  return choice;
}

}  // namespace cellocut
