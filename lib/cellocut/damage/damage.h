// Holes as scanners leave them, cut into a watertight model: what a completion is tested on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/mesh/triangle_soup.h"

namespace cellocut {

// The three kinds of the paper's completion benchmark:
// - grazing: a round patch where the surface is seen edge-on by a scanner that looks along a random
//   direction (the quarter of the area where the angle to it is worst);
// - gap: an elongated region along the surface, five to eight times as long as wide, as motion
//   leaves it;
// - stripe: a thin band between two planes, eight to fifteen times as long as wide, as lost scan
//   lines leave it. All stripes of a model are parallel.
enum class HoleKind { grazing, gap, stripe };
std::string to_string(HoleKind kind);

struct DamageOptions {
  std::uint64_t seed = 1;
  // How many holes; the number itself is random. 1 to 1000.
  std::size_t fewest = 6;
  std::size_t most = 12;
  double size = 1;  // factor on the lengths of all holes, 0.01 to 3

  // Errors: UsageError.
  void validate() const;
};

// In input units.
struct Hole {
  HoleKind kind{};
  Point3 centre{};  // of the area that is gone
  double area = 0;
  double share = 0;                     // of the surface
  double length = 0;                    // the largest distance of two vertices of the boundary
  double width = 0;                     // area / length
  std::vector<std::uint32_t> faces;     // of the model, ascending
  std::vector<std::uint32_t> boundary;  // vertices of the model along the loop, each once
};

struct Damage {
  TriangleSoup mesh;
  std::vector<Hole> holes;
};

// Takes whole faces out: the others stay, in their order and with their corners' coordinates and
// order; points that no face uses any more are left out, so that they tell nothing of what was
// there. Every hole is a disc (disc_patch.h) that shares no vertex and no face around a vertex with
// another, so each leaves one simple loop of boundary edges, no pinched vertex, and no more
// components than there were. Kinds take turns. Aimed sizes, by the area A of the surface: grazing
// 0.8 to 2.5 % of A; gap 0.22 to 0.4 sqrt(A) long; stripe 0.15 to 0.3 sqrt(A) long; all times
// `size`.
//
// Errors: UsageError by options.validate(); InputError where the model is not closed, oriented and
// manifold by index, or so coarse that `fewest` holes of such sizes find no room; Cancelled.
// The same for the same seed. O(n) for each place that is tried.
Damage damage_mesh(const TriangleSoup& model, const DamageOptions& options,
                   Observer& observer = silent_observer());

}  // namespace cellocut
