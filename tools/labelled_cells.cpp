#include "tools/labelled_cells.h"

#include "cellocut_version.h"
#include "tools/report_json.h"

namespace cellocut::tools {

namespace {

// Number of the connected component of equal label, through facets, in order of the lowest cell.
std::vector<std::int32_t> label_components(const TetComplex& complex, const CellLabels& labels) {
  std::vector<std::int32_t> component(labels.size(), -1);
  std::int32_t count = 0;
  std::vector<std::uint32_t> stack;
  for (std::uint32_t seed = 0; seed < labels.size(); ++seed) {
    if (component[seed] >= 0) continue;
    component[seed] = count;
    stack.push_back(seed);
    while (!stack.empty()) {
      const std::uint32_t c = stack.back();
      stack.pop_back();
      for (const std::int32_t other : complex.neighbours[c]) {
        if (other == kOutside || component[other] >= 0 || labels[other] != labels[c]) continue;
        component[other] = count;
        stack.push_back(static_cast<std::uint32_t>(other));
      }
    }
    ++count;
  }
  return component;
}

}  // namespace

std::vector<float> expand_relaxed(const CellGraph& graph, const std::vector<float>& relaxed) {
  std::vector<float> values(graph.decided.size());
  for (std::size_t c = 0; c < values.size(); ++c) {
    const std::int32_t node = graph.node_of_cell[c];
    if (node >= 0) {
      values[c] = 1.0F - relaxed[static_cast<std::size_t>(node)];
    } else {
      values[c] = graph.decided[c] == kInterior ? 0.0F : 1.0F;
    }
  }
  return values;
}

viz::LabelledCells labelled_cells(const RemeshResult& result, const RemeshOptions& options,
                                  const std::string& solver) {
  const std::size_t n = result.complex.cells.size();
  viz::LabelledCells cells;
  cells.points = result.complex.points;
  cells.cells = result.complex.cells;
  if (!result.label.empty()) cells.arrays.push_back({"label", result.label});
  cells.arrays.push_back({"label_initial", result.initial_label});
  std::vector<std::uint8_t> anchored(n);
  for (std::size_t c = 0; c < n; ++c) anchored[c] = static_cast<std::uint8_t>(result.anchors[c]);
  cells.arrays.push_back({"anchored", anchored});
  if (!result.label.empty()) {
    std::vector<std::uint8_t> ambiguous(n);
    for (std::size_t c = 0; c < n; ++c) {
      ambiguous[c] = result.smallest_interior[c] != result.largest_interior[c] ? 1 : 0;
    }
    cells.arrays.push_back({"ambiguous", ambiguous});
    cells.arrays.push_back({"component", label_components(result.complex, result.label)});
  }
  if (!result.cut.relaxed.empty()) {
    cells.arrays.push_back({"lp_value", expand_relaxed(result.graph, result.cut.relaxed)});
  }
  std::vector<float> phi(n);
  std::vector<double> volume(n);
  for (std::uint32_t c = 0; c < n; ++c) {
    phi[c] = static_cast<float>(result.centroid_phi[c] * result.frame.spacing);
    volume[c] = cell_volume(result.complex, c);
  }
  cells.arrays.push_back({"phi", phi});
  cells.arrays.push_back({"volume", volume});

  const double energy_unit =
      result.frame.unit * result.frame.unit /
      (result.areas.scale * static_cast<double>(result.derived.lambda_fill.denominator));
  cells.fields = {
      {"cellocut_version", std::string(kCellocutVersion)},
      {"legend_label", std::string("0 interior, 1 exterior")},
      {"legend_anchored", std::string("0 free, 1 fixed interior, 2 fixed exterior")},
      {"backend", result.backend},
      {"lambda_fill", to_string(result.derived.lambda_fill)},
      {"resolution", static_cast<std::int64_t>(options.resolution)},
      {"epsilon", result.derived.epsilon},
      {"unit", result.frame.unit},
      {"area_bits", static_cast<std::int64_t>(options.area_bits)},
      {"area_quantum", 1 / result.areas.scale},
      {"support", std::string(name_of(options.support))},
      {"exterior", std::string(name_of(options.exterior))},
      {"decimate", options.decimation.removed_share},
      {"decimation", std::string(name_of(options.decimation.method))},
      {"thickening", std::int64_t{options.thickening}},
      {"unary", std::int64_t{options.unary}},
  };
  if (!solver.empty()) cells.fields.push_back({"solver", solver});
  if (!result.label.empty() || !result.cut.relaxed.empty()) {
    const double energy = static_cast<double>(result.cut.value) * energy_unit;
    cells.fields.push_back({"cut", std::string(name_of(options.cut))});
    cells.fields.push_back({"cut_value", result.cut.value});
    cells.fields.push_back({"cut_lower_bound", result.cut.lower_bound});
    cells.fields.push_back({"energy", energy});
  }
  if (!result.cut.relaxed.empty()) {
    cells.fields.push_back(
        {"legend_lp_value", std::string("0 interior to 1 exterior, before rounding")});
  }
  return cells;
}

}  // namespace cellocut::tools
