// How well each labelling of a fill path fits a known solid.
//
//   path_truth RESOLUTION TRUTH DAMAGED [TRUTH DAMAGED ...]
//
// One line of CSV for each labelling whose interval is at least 0.1 % of lambda long, and for
// the first and the last: interval, areas (squared relative units), volume and volume of the slab's
// cells (cubed relative units), components, one-sided and open area (squared relative units), and
// the volume IoU of its cells with the truth, a cell counting as inside where its centroid is.
#include <fmt/core.h>

#include "cellocut/mesh/mesh_file.h"
#include "cellocut/path/one_sided.h"
#include "cellocut/pipeline.h"
#include "solvers/solvers.h"
#include "truth_pairs.h"

namespace {

using namespace cellocut;

void compare(const TruthPair& pair) {
  const auto& [name, truth, damaged, result] = pair;
  const CellPath path = find_path(result, {1, 1}, {1000, 1}, *solvers::make("push_relabel"));
  const std::vector<PathSolid> solids = path_solids(result.complex, path);
  const std::vector<SheetSides> sides = measure_sheet_sides(
      sample_sheets(result.complex, result.facets, result.areas, result.initial_label,
                    NearestTriangle(damaged), result.derived.epsilon * result.frame.unit,
                    silent_observer()),
      path);

  // Volumes by level, and of them what is in the truth.
  std::vector<double> volume(path.count() + 2, 0.0);
  std::vector<double> common(path.count() + 2, 0.0);
  double in_truth = 0;
  double slab = 0;
  for (std::uint32_t c = 0; c < path.level.size(); ++c) {
    const double v = cell_volume(result.complex, c);
    volume[path.level[c]] += v;
    if (result.initial_label[c] == kInterior) slab += v;
    if (!truth(cell_centroid(result.complex, c)).inside) continue;
    in_truth += v;
    common[path.level[c]] += v;
  }
  for (std::size_t level = path.count(); level-- > 0;) {
    volume[level] += volume[level + 1];
    common[level] += common[level + 1];
  }
  const double unit = result.frame.unit;
  const double area = 1 / result.areas.scale;
  const double cube = unit * unit * unit;
  for (std::size_t k = 0; k < path.count(); ++k) {
    const LambdaInterval interval = interval_of(path.path, k);
    const double from = to_double(interval.from);
    const double to = to_double(interval.to);
    if (to < 1.001 * from && k > 0 && k + 1 < path.count()) continue;
    const double iou = common[k + 1] / (volume[k + 1] + in_truth - common[k + 1]);
    fmt::print("{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{:.6g},{:.6g},{:.4f}\n", name, from,
               to, static_cast<double>(path.path.areas[k].supported) * area,
               static_cast<double>(path.path.areas[k].unsupported) * area, solids[k].volume / cube,
               slab / cube, solids[k].components, sides[k].one_sided, sides[k].open, iou);
  }
}

}  // namespace

int main(int count, char** arguments) {
  return cellocut::run_truth_pairs(
      count, arguments, "path_truth",
      "mesh,from,to,supported,unsupported,volume,slab,components,one_sided,open,iou", compare);
}
