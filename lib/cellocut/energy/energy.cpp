#include "cellocut/energy/energy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "cellocut/base/errors.h"

namespace cellocut {

namespace {

__extension__ using Wide = __int128;

// So that the terms of a quotient of two decimals fit into 63 bits: with one digit more, 10 times
// as much, times 10 kLargestLambdaTerm.
constexpr std::int64_t kLargestDecimal = std::int64_t{1} << 36;

// A decimal or integer as numerator / denominator, both exact.
Rational parse_decimal(std::string_view text) {
  std::int64_t numerator = 0;
  std::int64_t denominator = 1;
  bool fraction = false;
  bool digits = false;
  for (const char c : text) {
    if (c == '.' && !fraction) {
      fraction = true;
      continue;
    }
    if (c < '0' || c > '9' || numerator > kLargestDecimal || denominator > kLargestLambdaTerm) {
      return {0, 1};
    }
    digits = true;
    numerator = 10 * numerator + (c - '0');
    if (fraction) denominator *= 10;
  }
  return digits ? Rational{numerator, denominator} : Rational{0, 1};
}

std::int64_t integer_area(double area, double scale) {
  return std::max<std::int64_t>(1, std::llround(scale * area));
}

}  // namespace

Rational parse_rational(std::string_view text) {
  const std::size_t slash = text.find('/');
  Rational value = parse_decimal(text.substr(0, slash));
  if (slash != std::string_view::npos) {
    const Rational below = parse_decimal(text.substr(slash + 1));
    value.numerator *= below.denominator;
    value.denominator *= below.numerator;
  }
  if (value.numerator > 0 && value.denominator > 0) {
    const std::int64_t common = std::gcd(value.numerator, value.denominator);
    value = {value.numerator / common, value.denominator / common};
    if (std::max(value.numerator, value.denominator) <= kLargestLambdaTerm) return value;
  }
  throw UsageError("'" + std::string(text) +
                   "' is not a positive number such as 20, 2.5 or 1/3, a fraction with terms up to "
                   "2^20 = 1048576");
}

std::string to_string(const Rational& value) {
  return value.denominator == 1
             ? std::to_string(value.numerator)
             : std::to_string(value.numerator) + "/" + std::to_string(value.denominator);
}

FacetList list_facets(const TetComplex& complex) {
  FacetList facets;
  facets.reserve(2 * complex.cells.size() + 2 * complex.cells.size() / 16);
  for (std::uint32_t c = 0; c < complex.cells.size(); ++c) {
    for (int k = 0; k < 4; ++k) {
      const std::int32_t other = complex.neighbours[c][k];
      if (other == kOutside || other > static_cast<std::int32_t>(c)) {
        facets.push_back({c, static_cast<std::uint8_t>(k), other});
      }
    }
  }
  return facets;
}

FacetAreas quantise_areas(const TetComplex& complex, const FacetList& facets, double unit,
                          int area_bits) {
  if (area_bits < 8 || area_bits > 50) throw UsageError("--area-bits must be between 8 and 50");
  const std::int64_t limit = std::int64_t{1} << area_bits;
  if (static_cast<std::int64_t>(facets.size()) > limit) {
    throw LimitError(std::to_string(facets.size()) + " facets do not fit in --area-bits " +
                     std::to_string(area_bits));
  }
  std::vector<double> area(facets.size());
  tbb::parallel_for(std::size_t{0}, facets.size(), [&](std::size_t f) {
    const auto corners = facet_corners(complex, facets[f].cell, facets[f].corner);
    area[f] = triangle_area(complex.points[corners[0]], complex.points[corners[1]],
                            complex.points[corners[2]]) /
              (unit * unit);
  });
  double total = 0;
  for (const double a : area) total += a;
  if (!std::isfinite(total)) throw LimitError("the facet areas exceed the range of a double");

  const auto sum_at = [&](double scale) {
    Wide sum = 0;
    for (const double a : area) sum += integer_area(a, scale);
    return sum;
  };
  // The largest power of two for which the integers fit; the sum grows with the scale.
  FacetAreas areas;
  areas.unit = unit;
  areas.scale = total > 0 ? std::exp2(std::floor(area_bits - std::log2(total))) : 1;
  while (total > 0 && sum_at(2 * areas.scale) <= limit) areas.scale *= 2;
  while (sum_at(areas.scale) > limit) areas.scale /= 2;

  areas.quantised.resize(facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    areas.quantised[f] = integer_area(area[f], areas.scale);
    areas.sum += areas.quantised[f];
    areas.largest_error =
        std::max(areas.largest_error,
                 std::fabs(static_cast<double>(areas.quantised[f]) / areas.scale - area[f]));
  }
  areas.total_error = std::fabs(static_cast<double>(areas.sum) / areas.scale - total);
  return areas;
}

std::vector<Anchor> anchor_cells(const TetComplex& complex, const CellLabels& initial,
                                 ExteriorMode mode) {
  std::vector<Anchor> anchors(complex.cells.size(), Anchor::free);
  for (std::size_t c = 0; c < anchors.size(); ++c) {
    if (initial[c] == kInterior) {
      anchors[c] = Anchor::interior;
    } else if (mode == ExteriorMode::hull_cells &&
               std::count(complex.neighbours[c].begin(), complex.neighbours[c].end(), kOutside) >
                   0) {
      anchors[c] = Anchor::exterior;
    }
  }
  return anchors;
}

bool is_supported(const Facet& facet, const CellLabels& initial) {
  return initial[facet.cell] != (facet.other == kOutside ? kExterior : initial[facet.other]);
}

std::vector<std::int64_t> support_by_labels(const FacetList& facets, const FacetAreas& areas,
                                            const CellLabels& initial) {
  std::vector<std::int64_t> supported(facets.size());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    supported[f] = is_supported(facets[f], initial) ? areas.quantised[f] : 0;
  }
  return supported;
}

std::int64_t facet_capacity(const FacetAreas& areas, std::size_t f, const Rational& lambda) {
  return lambda.denominator * areas.supported[f] +
         lambda.numerator * (areas.quantised[f] - areas.supported[f]);
}

std::int64_t labelling_energy(const FacetList& facets, const FacetAreas& areas,
                              const Rational& lambda, const CellLabels& labels) {
  Wide energy = 0;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    const std::uint8_t beyond = facets[f].other == kOutside ? kExterior : labels[facets[f].other];
    if (labels[facets[f].cell] == beyond) continue;
    energy += Wide{areas.supported[f]} * lambda.denominator +
              Wide{areas.quantised[f] - areas.supported[f]} * lambda.numerator;
  }
  if (energy >= Wide{1} << 62) throw LimitError("the energy reaches 2^62; lower --area-bits");
  return static_cast<std::int64_t>(energy);
}

}  // namespace cellocut
