// The energy of the paper (section "Global Optimization of Partitioning Energy") in integers.
//
//   E(L) = sum over facets f between cells of different label of  w_f * area(f),
//   w_f  = 1 where the initial labels L* differ, lambda_fill where they agree
//          (the paper's rule; facet_support.h has one that weights parts of a facet),
//
// over labellings with L(c) = 0 (interior) wherever L*(c) = 0. The unbounded region beyond the hull
// is one more cell with L* = 1 that is fixed exterior; hull facets are facets to it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cellocut/complex/tet_complex.h"

namespace cellocut {

// Cell labels as the paper has them.
inline constexpr std::uint8_t kInterior = 0;
inline constexpr std::uint8_t kExterior = 1;
using CellLabels = std::vector<std::uint8_t>;

// lambda_fill = numerator / denominator, both in [1, 2^20], in lowest terms.
inline constexpr std::int64_t kLargestLambdaTerm = std::int64_t{1} << 20;
struct Rational {
  std::int64_t numerator = 20;
  std::int64_t denominator = 1;
};
// "20", "2.5", "1/3". Errors: UsageError where it is not positive or needs more than 2^20.
Rational parse_rational(std::string_view text);
std::string to_string(const Rational& value);

enum class ExteriorMode {
  unbounded,  // only the unbounded region is fixed exterior
  hull_cells  // and so is every cell with L* = 1 that has a hull facet (the authors' program)
};

// A facet of the complex, named once: by its cell of lower index.
struct Facet {
  std::uint32_t cell = 0;
  std::uint8_t corner = 0;        // opposite to this corner of `cell`
  std::int32_t other = kOutside;  // the cell beyond, > cell, or kOutside
};
using FacetList = std::vector<Facet>;

// All facets, ascending by (cell, corner): each pair of neighbours once, each hull facet once.
// O(cells).
FacetList list_facets(const TetComplex& complex);

// What of a facet is supported, and has weight 1.
enum class SupportRule {
  labels,  // all of it where L* differs across it, else nothing (the paper's)
  facets   // the part of its area that is in the slab or next to it (facet_support.h)
};

// Facet areas as integers: quantised[f] = max(1, llround(scale * area_f / unit^2)), with scale the
// largest power of two for which the sum stays <= 2^area_bits.
struct FacetAreas {
  std::vector<std::int64_t> quantised;
  // What of it has weight 1, the rest having lambda_fill; in [0, quantised]. Not set by
  // quantise_areas.
  std::vector<std::int64_t> supported;
  double unit = 1;   // length of one relative unit, in input units
  double scale = 1;  // quanta per squared relative unit, a power of two
  std::int64_t sum = 0;
  double largest_error = 0;  // max |quantised / scale - area|, in squared relative units
  double total_error = 0;    // |sum / scale - total area|, in squared relative units
};
// `unit`: the longest edge of the input's bounding box. area_bits in [8, 50].
// Errors: UsageError for area_bits out of range; LimitError where even one quantum a facet exceeds
// it.
FacetAreas quantise_areas(const TetComplex& complex, const FacetList& facets, double unit,
                          int area_bits);

// Which cells are fixed: interior where L* is interior; exterior by `mode`. One entry per cell.
enum class Anchor : std::uint8_t { free = 0, interior = 1, exterior = 2 };
std::vector<Anchor> anchor_cells(const TetComplex& complex, const CellLabels& initial,
                                 ExteriorMode mode);

// Whether L* differs across the facet; beyond the hull it is exterior.
bool is_supported(const Facet& facet, const CellLabels& initial);

// The paper's rule, for FacetAreas::supported: all of a facet's area where L* differs across it,
// else nothing. O(facets).
std::vector<std::int64_t> support_by_labels(const FacetList& facets, const FacetAreas& areas,
                                            const CellLabels& initial);

// Capacity of facet f in integer units: its supported area times the denominator of lambda, and the
// rest times the numerator. Precondition: the sum fits, as build_cell_graph has checked.
std::int64_t facet_capacity(const FacetAreas& areas, std::size_t f, const Rational& lambda);

// E(labels) in integer units (divide by denominator * scale for squared relative units).
// Errors: LimitError where that reaches 2^62.
std::int64_t labelling_energy(const FacetList& facets, const FacetAreas& areas,
                              const Rational& lambda, const CellLabels& labels);

}  // namespace cellocut
