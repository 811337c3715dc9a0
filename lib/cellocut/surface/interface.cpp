#include "cellocut/surface/interface.h"

#include <algorithm>
#include <array>

#include "cellocut/base/disjoint_sets.h"
#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

bool is_interior(const CellLabels& labels, std::int32_t cell) {
  return cell != kOutside && labels[cell] == kInterior;
}

// The facets of the interface with the corners of each, and the pairing of their edges.
// A half-edge is 3 * facet + k: the edge from corner k to corner k + 1 of the facet.
class Pairing {
 public:
  Pairing(const TetComplex& complex, const CellLabels& labels)
      : complex_(complex), labels_(labels), interface_(list_interface(complex, labels)) {
    for (const InterfaceFacet& f : interface_) {
      corners_.push_back(facet_outward(complex, f.cell, f.corner));
    }
    mate_.resize(3 * corners_.size());
    for (std::uint32_t h = 0; h < mate_.size(); ++h) mate_[h] = across_interior(h);
    list_crowded_edges();
  }

  // Splits vertices by the current pairing; joins edges that still coincide and tries again.
  TriangleSoup split() {
    for (int round = 0; round < 1000; ++round) {
      assign_copies();
      if (!rejoin_coinciding_edges()) return build();
    }
    throw Error("the interface cannot be split into a manifold");
  }

 private:
  [[nodiscard]] std::uint32_t from(std::uint32_t h) const { return corners_[h / 3][h % 3]; }
  [[nodiscard]] std::uint32_t to(std::uint32_t h) const { return from(next(h)); }
  // The half-edge that follows in the same facet.
  static std::uint32_t next(std::uint32_t h) { return h - h % 3 + (h % 3 + 1) % 3; }

  // The half-edge of the facet that bounds the same run of interior cells around the edge: from the
  // facet's interior cell, turn around the edge through interior cells until the exterior comes.
  [[nodiscard]] std::uint32_t across_interior(std::uint32_t h) const {
    const std::uint32_t u = from(h);
    const std::uint32_t v = to(h);
    std::uint32_t cell = interface_[h / 3].cell;
    int entered_opposite = interface_[h / 3].corner;  // the facet that we stand at
    while (true) {
      // The other facet of the cell at the edge (u, v) is opposite to the third corner of this
      // facet.
      int leave = 0;
      for (int k = 0; k < 4; ++k) {
        if (k != entered_opposite && complex_.cells[cell][k] != u && complex_.cells[cell][k] != v) {
          leave = k;
        }
      }
      const std::int32_t next = complex_.neighbours[cell][leave];
      if (!is_interior(labels_, next)) return half_edge_at(cell, leave, v, u);
      // In the next cell we stand at the same facet, opposite to the corner that is not shared.
      const std::array<std::uint32_t, 3> shared = facet_corners(complex_, cell, leave);
      for (int k = 0; k < 4; ++k) {
        if (std::find(shared.begin(), shared.end(), complex_.cells[next][k]) == shared.end()) {
          entered_opposite = k;
        }
      }
      cell = static_cast<std::uint32_t>(next);
    }
  }

  [[nodiscard]] std::uint32_t half_edge_at(std::uint32_t cell, int corner, std::uint32_t u,
                                           std::uint32_t v) const {
    const auto found = std::lower_bound(
        interface_.begin(), interface_.end(), std::pair<std::uint32_t, int>(cell, corner),
        [](const InterfaceFacet& f, const std::pair<std::uint32_t, int>& key) {
          return std::pair<std::uint32_t, int>(f.cell, f.corner) < key;
        });
    const auto facet = static_cast<std::uint32_t>(found - interface_.begin());
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (corners_[facet][k] == u && corners_[facet][(k + 1) % 3] == v) return 3 * facet + k;
    }
    throw Error("the interface is not oriented");
  }

  // Half-edges u -> v (u < v) of every edge with four or more facets, grouped by edge.
  void list_crowded_edges() {
    std::vector<std::uint32_t> forward;
    for (std::uint32_t h = 0; h < mate_.size(); ++h) {
      if (from(h) < to(h)) forward.push_back(h);
    }
    const auto key = [this](std::uint32_t h) { return std::pair(from(h), to(h)); };
    std::sort(forward.begin(), forward.end(), [&](std::uint32_t a, std::uint32_t b) {
      return key(a) != key(b) ? key(a) < key(b) : a < b;
    });
    for (std::size_t i = 0; i < forward.size();) {
      std::size_t j = i;
      while (j < forward.size() && key(forward[j]) == key(forward[i])) ++j;
      if (j - i > 1) crowded_.emplace_back(forward.begin() + i, forward.begin() + j);
      i = j;
    }
  }

  // One copy of a vertex for each group of corners that paired edges connect (union-find over
  // corners).
  void assign_copies() {
    groups_ = DisjointSets(mate_.size());
    for (std::uint32_t h = 0; h < mate_.size(); ++h) {
      // The corner at from(h) and the corner of the mate at the same vertex, which is where it
      // ends.
      groups_.join(h, next(mate_[h]));
    }
  }

  // At each crowded edge, two pairs that lie between the same two copies swap their mates. A swap
  // makes the groups at its edge stale, so edges that touch one of them wait for the next round.
  // True if any pairs were swapped.
  bool rejoin_coinciding_edges() {
    std::vector<bool> stale(mate_.size(), false);
    bool swapped = false;
    for (const std::vector<std::uint32_t>& edge : crowded_) {
      for (std::size_t i = 0; i < edge.size(); ++i) {
        for (std::size_t j = i + 1; j < edge.size(); ++j) {
          const std::uint32_t a = edge[i];
          const std::uint32_t b = edge[j];
          const std::uint32_t low = groups_.root(a);
          const std::uint32_t high = groups_.root(next(a));
          if (low != groups_.root(b) || high != groups_.root(next(b)) || stale[low] || stale[high])
            continue;
          stale[low] = stale[high] = true;
          std::swap(mate_[a], mate_[b]);
          mate_[mate_[a]] = a;
          mate_[mate_[b]] = b;
          swapped = true;
        }
      }
    }
    return swapped;
  }

  TriangleSoup build() {
    TriangleSoup surface;
    std::vector<std::uint32_t> number(mate_.size(), 0);
    surface.triangles.resize(corners_.size());
    for (std::uint32_t c = 0; c < mate_.size(); ++c) {
      const std::uint32_t root = groups_.root(c);
      if (root == c) {
        number[c] = static_cast<std::uint32_t>(surface.points.size());
        surface.points.push_back(complex_.points[from(c)]);
      }
      surface.triangles[c / 3][c % 3] = number[root];
    }
    return surface;
  }

  const TetComplex& complex_;
  const CellLabels& labels_;
  std::vector<InterfaceFacet> interface_;
  std::vector<std::array<std::uint32_t, 3>> corners_;
  std::vector<std::uint32_t> mate_;
  std::vector<std::vector<std::uint32_t>> crowded_;
  DisjointSets groups_{0};
};

}  // namespace

std::vector<InterfaceFacet> list_interface(const TetComplex& complex, const CellLabels& labels) {
  std::vector<InterfaceFacet> interface;
  for (std::uint32_t c = 0; c < complex.cells.size(); ++c) {
    if (labels[c] != kInterior) continue;
    for (int k = 0; k < 4; ++k) {
      if (!is_interior(labels, complex.neighbours[c][k])) {
        interface.push_back({c, static_cast<std::uint8_t>(k)});
      }
    }
  }
  return interface;
}

TriangleSoup interface_triangles(const TetComplex& complex,
                                 const std::vector<InterfaceFacet>& interface) {
  TriangleSoup surface;
  surface.points = complex.points;
  surface.triangles.reserve(interface.size());
  for (const InterfaceFacet& f : interface) {
    surface.triangles.push_back(facet_outward(complex, f.cell, f.corner));
  }
  return surface;
}

TriangleSoup extract_interface_cells(const TetComplex& complex, const CellLabels& labels) {
  return Pairing(complex, labels).split();
}

}  // namespace cellocut
