// Whether one fill weight for each region fits known solids better than one for the model.
//
//   region_truth RESOLUTION TRUTH DAMAGED [TRUTH DAMAGED ...]
//
// A region is a connected set of cells that some labelling of the path over auto's range fills and
// another does not; regions share no facet, so each may take its own labelling and the solid is
// still a minimum of its own weight there. One line of CSV for each pair: how many regions, and the
// volume IoU of the cells with the truth (a cell counts where its centroid is) for
//   model      the labelling that auto chooses, one for the model
//   region     auto's rule for each region on its own
//   best_model, best_region   the best that a rule of either kind could do, told by the truth
#include <fmt/core.h>

#include <algorithm>

#include "cellocut/mesh/mesh_file.h"
#include "cellocut/path/auto_fill.h"
#include "cellocut/path/one_sided.h"
#include "cellocut/pipeline.h"
#include "solvers/solvers.h"
#include "truth_pairs.h"

namespace {

using namespace cellocut;

constexpr std::uint32_t kNoRegion = 0xffffffffU;

struct Regions {
  std::vector<std::uint32_t> of_cell;
  std::size_t count = 0;
};

Regions find_regions(const TetComplex& complex, const CellPath& path) {
  const auto open = [&path](std::size_t c) {
    return path.level[c] > 0 && path.level[c] < path.count();
  };
  Regions regions{std::vector<std::uint32_t>(path.level.size(), kNoRegion), 0};
  std::vector<std::size_t> stack;
  for (std::size_t first = 0; first < path.level.size(); ++first) {
    if (!open(first) || regions.of_cell[first] != kNoRegion) continue;
    const auto region = static_cast<std::uint32_t>(regions.count++);
    regions.of_cell[first] = region;
    stack.push_back(first);
    while (!stack.empty()) {
      const std::size_t cell = stack.back();
      stack.pop_back();
      for (const std::int32_t neighbour : complex.neighbours[cell]) {
        if (neighbour == kOutside) continue;
        const auto next = static_cast<std::size_t>(neighbour);
        if (!open(next) || regions.of_cell[next] != kNoRegion) continue;
        regions.of_cell[next] = region;
        stack.push_back(next);
      }
    }
  }
  return regions;
}

// Per region the labelling of the largest gain, where gain[region][k] is that of labelling k.
std::vector<std::size_t> best_of_each(const std::vector<std::vector<double>>& gain) {
  std::vector<std::size_t> best(gain.size());
  for (std::size_t r = 0; r < gain.size(); ++r) {
    for (std::size_t k = 1; k < gain[r].size(); ++k) {
      if (gain[r][k] >= gain[r][best[r]]) best[r] = k;
    }
  }
  return best;
}

void compare(const TruthPair& pair) {
  const auto& [name, truth, damaged, result] = pair;
  const CellPath path = find_path(result, kAutoFirst, kAutoLast, *solvers::make("push_relabel"));
  const std::size_t count = path.count();
  const std::vector<SheetSample> samples = sample_sheets(
      result.complex, result.facets, result.areas, result.initial_label, NearestTriangle(damaged),
      result.derived.epsilon * result.frame.unit, silent_observer());
  const Regions regions = find_regions(result.complex, path);

  std::vector<double> volume(path.level.size());
  std::vector<char> in_truth(path.level.size());
  double truth_volume = 0;
  for (std::uint32_t c = 0; c < path.level.size(); ++c) {
    volume[c] = cell_volume(result.complex, c);
    in_truth[c] = truth(cell_centroid(result.complex, c)).inside ? 1 : 0;
    if (in_truth[c] != 0) truth_volume += volume[c];
  }
  // `holds(c)`: whether a labelling has the cell inside.
  const auto overlap = [&](const auto& holds) {
    double all = 0;
    double common = 0;
    for (std::size_t c = 0; c < volume.size(); ++c) {
      if (!holds(c)) continue;
      all += volume[c];
      if (in_truth[c] != 0) common += volume[c];
    }
    return common / (all + truth_volume - common);
  };
  const std::vector<SheetSides> model_sides = measure_sheet_sides(samples, path);
  std::size_t model = 0;
  double best_model = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (model_sides[k].one_sided >= model_sides[model].one_sided) model = k;
    best_model = std::max(best_model, overlap([&](std::size_t c) { return path.holds(k, c); }));
  }

  // The gains of a region's labellings, the rest being as in the model's.
  std::vector<std::vector<double>> sides(regions.count, std::vector<double>(count));
  std::vector<std::vector<double>> volumes(regions.count, std::vector<double>(count));
  for (const SheetSample& s : samples) {
    const auto region = [&](std::int32_t cell) {
      return cell == kOutside ? kNoRegion : regions.of_cell[static_cast<std::size_t>(cell)];
    };
    const auto holds = [&](std::int32_t cell, std::size_t k) {
      return cell != kOutside && path.holds(k, static_cast<std::size_t>(cell));
    };
    const std::uint32_t front = region(s.front);
    const std::uint32_t behind = region(s.behind);
    for (std::size_t k = 0; k < count; ++k) {
      if (behind != kNoRegion && holds(s.behind, k) &&
          !holds(s.front, front == behind ? k : model)) {
        sides[behind][k] += s.area;
      }
      if (front != kNoRegion && front != behind && holds(s.behind, model) && !holds(s.front, k)) {
        sides[front][k] += s.area;
      }
    }
  }
  for (std::size_t c = 0; c < volume.size(); ++c) {
    if (regions.of_cell[c] == kNoRegion) continue;
    for (std::size_t k = 0; k < path.level[c]; ++k) {
      volumes[regions.of_cell[c]][k] += in_truth[c] != 0 ? volume[c] : -volume[c];
    }
  }
  const std::vector<std::size_t> by_sides = best_of_each(sides);
  const std::vector<std::size_t> by_volume = best_of_each(volumes);
  const auto chosen = [&](const std::vector<std::size_t>& choice) {
    return [&](std::size_t c) {
      const std::uint32_t region = regions.of_cell[c];
      return path.holds(region == kNoRegion ? model : choice[region], c);
    };
  };
  fmt::print("{},{},{},{:.4f},{:.4f},{:.4f},{:.4f}\n", name, count, regions.count,
             overlap([&](std::size_t c) { return path.holds(model, c); }),
             overlap(chosen(by_sides)), best_model, overlap(chosen(by_volume)));
}

}  // namespace

int main(int count, char** arguments) {
  return cellocut::run_truth_pairs(count, arguments, "region_truth",
                                   "mesh,labellings,regions,model,region,best_model,best_region",
                                   compare);
}
