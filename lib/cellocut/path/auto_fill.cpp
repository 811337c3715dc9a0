#include "cellocut/path/auto_fill.h"

#include <cmath>

namespace cellocut {

namespace {

constexpr std::int64_t kLargestTerm = std::int64_t{1} << 20;
constexpr double kOtherSolid = 0.05;

}  // namespace

// The continued fraction of both, as far as they agree (Stern and Brocot's tree).
Lambda simplest_between(const Lambda& a, const Lambda& b) {
  const std::int64_t whole = a.p / a.q;
  if (Lambda{whole + 1, 1} < b) return {whole + 1, 1};
  // a < x < b, and b is at most the next integer: x = whole + 1 / y.
  const Lambda above{a.q, a.p - whole * a.q};  // 1 / (a - whole), where that is positive
  const Lambda below{b.q, b.p - whole * b.q};  // 1 / (b - whole)
  Lambda inverse;
  if (above.q == 0) {
    // a is an integer: y may be as large as it likes; the first integer above 1 / (b - whole).
    inverse = {below.p / below.q + 1, 1};
  } else {
    inverse = simplest_between(below, above);
  }
  return {whole * inverse.p + inverse.q, inverse.p};
}

FillChoice choose_fill(const CellPath& path, const std::vector<SheetSides>& sides,
                       const std::vector<PathSolid>& solids) {
  const FillPath& found = path.path;
  const auto candidate = [&](std::size_t k) {
    return FillCandidate{k == 0 ? found.first : found.breakpoints[k - 1],
                         k + 1 == path.count() ? found.last : found.breakpoints[k], sides[k],
                         solids[k].volume};
  };
  // Is `a` better than `b`, which has the smaller lambda?
  const auto better = [&sides](std::size_t a, std::size_t b) {
    return sides[a].one_sided >= sides[b].one_sided;
  };
  FillChoice choice;
  choice.labellings = path.count();
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < path.count(); ++k) {
    if (best && !better(k, *best)) continue;
    const FillCandidate at = candidate(k);
    const Lambda lambda = simplest_between(at.from, at.to);
    if (lambda.p > kLargestTerm || lambda.q > kLargestTerm) continue;
    best = k;
    choice.lambda = {lambda.p, lambda.q};
  }
  if (!best) return choice;  // the range itself holds integers, so some labelling has one
  choice.chosen = candidate(*best);
  std::optional<std::size_t> second;
  for (std::size_t k = 0; k < path.count(); ++k) {
    if (std::fabs(solids[k].volume - solids[*best].volume) <= kOtherSolid * solids[*best].volume) {
      continue;
    }
    if (!second || better(k, *second)) second = k;
  }
  if (second) choice.runner_up = candidate(*second);
  return choice;
}

}  // namespace cellocut
