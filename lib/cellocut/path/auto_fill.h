// Which labelling of a fill path is the solid that the input is the surface of.
//
// The rule: the one with the most one-sided input (one_sided.h). Of a solid's surface each part has
// the solid on one side and nothing on the other. Where a body is left hollow, both sides of its
// sheets are in the open; where a cavity or a handle is filled that should not be, sheets are
// swallowed; both cost one-sided area, whatever the size of the holes that the body has. Of equals
// the one of the largest lambda. docs/benchmarks.md has the measurements.
#pragma once

#include <optional>
#include <vector>

#include "cellocut/energy/energy.h"
#include "cellocut/path/cell_path.h"
#include "cellocut/path/one_sided.h"

namespace cellocut {

// The range in which a labelling is looked for. Below, an opening would be closed that has less
// than twice its own area of sheet behind it (an open hemisphere is a bowl). Above, less would be
// closed than the default closes: where walls enclose each other, as in machines, parts are then
// left hollow for the sake of inner walls with their two sides in the open.
inline constexpr Lambda kAutoFirst{2, 1};
inline constexpr Lambda kAutoLast{20, 1};

struct FillCandidate {
  Lambda from;  // its interval
  Lambda to;
  SheetSides sides;   // squared relative units
  double volume = 0;  // of its cells, cubed input units
};

struct FillChoice {
  Rational lambda;  // a fraction with small terms within the chosen interval
  FillCandidate chosen;
  // The best of those whose volume differs by more than 5 % of the chosen one's.
  std::optional<FillCandidate> runner_up;
  std::size_t labellings = 0;

  // The share of one-sided area that the runner-up has less; 0 where there is none of either.
  [[nodiscard]] double margin() const;
};

// Labellings whose interval holds no fraction with terms up to `largest_term` are passed over.
// O(labellings). Preconditions: one entry per labelling each, at least one. Errors: LimitError
// where all are passed over.
FillChoice choose_fill(const CellPath& path, const std::vector<SheetSides>& sides,
                       const std::vector<PathSolid>& solids, std::int64_t largest_term);

}  // namespace cellocut
