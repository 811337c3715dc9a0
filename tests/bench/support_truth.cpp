// Which rule of support finds known solids, at fixed weights.
//
//   support_truth RESOLUTION TRUTH DAMAGED [TRUTH DAMAGED ...]
//
// One line of CSV for each model, rule and lambda_fill: supported and unsupported area of the
// largest minimum (squared relative units) and the volume IoU of its cells with the truth, a cell
// counting as inside where its centroid is.
#include <fmt/core.h>

#include "cellocut/energy/facet_support.h"
#include "cellocut/mesh/mesh_file.h"
#include "cellocut/pipeline.h"
#include "solvers/solvers.h"
#include "truth_pairs.h"

namespace {

using namespace cellocut;

void compare(TruthPair pair) {
  auto& [name, truth, damaged, result] = pair;
  std::vector<double> volume(result.complex.cells.size());
  std::vector<bool> inside(volume.size());
  double in_truth = 0;
  for (std::uint32_t c = 0; c < volume.size(); ++c) {
    volume[c] = cell_volume(result.complex, c);
    inside[c] = truth(cell_centroid(result.complex, c)).inside;
    if (inside[c]) in_truth += volume[c];
  }
  const std::vector<std::int64_t> by_labels = result.areas.supported;
  const std::vector<std::int64_t> by_facets =
      support_by_facets(result.complex, result.facets, result.areas, result.phi, result.frame);
  using Rule = std::pair<const char*, const std::vector<std::int64_t>*>;
  for (const auto& [rule, supported] : {Rule{"labels", &by_labels}, Rule{"facets", &by_facets}}) {
    result.areas.supported = *supported;
    for (const std::int64_t lambda : {3, 5, 10, 20, 50, 100}) {
      result.graph = build_cell_graph(result.complex, result.facets, result.areas, result.anchors,
                                      {lambda, 1});
      const CutResult cut = solvers::make("push_relabel")->solve(result.graph.problem);
      const CellLabels labels = expand_labels(result.graph, cut.largest_source_side);
      double all = 0;
      double common = 0;
      for (std::uint32_t c = 0; c < labels.size(); ++c) {
        if (labels[c] != kInterior) continue;
        all += volume[c];
        if (inside[c]) common += volume[c];
      }
      double areas[2] = {0, 0};
      for (std::size_t f = 0; f < result.facets.size(); ++f) {
        const Facet& facet = result.facets[f];
        const std::uint8_t other = facet.other == kOutside ? kExterior : labels[facet.other];
        if (labels[facet.cell] == other) continue;
        areas[0] += static_cast<double>((*supported)[f]);
        areas[1] += static_cast<double>(result.areas.quantised[f] - (*supported)[f]);
      }
      fmt::print("{},{},{},{:.6g},{:.6g},{:.4f}\n", name, rule, lambda,
                 areas[0] / result.areas.scale, areas[1] / result.areas.scale,
                 common / (all + in_truth - common));
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  return cellocut::run_truth_pairs(count, arguments, "support_truth",
                                   "mesh,rule,lambda,supported,unsupported,iou", compare);
}
