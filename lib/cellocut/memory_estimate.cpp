#include "cellocut/memory_estimate.h"

#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <vector>

#include "cellocut/base/errors.h"
#include "cellocut/base/raster_points.h"
#include "cellocut/pipeline.h"

namespace cellocut {

namespace {

constexpr double kCell = 8;  // edge of the cells that are counted, in grid steps; at least
constexpr double kStep = 4;  // between the points that find them

// Bytes, fitted to runs (docs/performance.md).
constexpr double kProgram = 90e6;
constexpr double kPerCell = 38e3;
constexpr double kPerCellUndecimated = 240e3;  // times the share of the proxy's faces that stays
constexpr double kPerInputFace = 400;

// The cells of `kCell` grid steps that the input meets; where phi = 0 lies further from it than
// that, larger ones, each for as many of them as its face holds: a needle becomes a pipe.
double count_cells(const TriangleSoup& input, int resolution, double epsilon_steps) {
  const double cell = epsilon_steps > kCell ? 2 * epsilon_steps : kCell;
  const Box3 box = bounding_box(input);
  const double per_unit = resolution / box.longest_edge();
  const auto place = [&](std::uint32_t point) {
    return per_unit * (input.points[point] - box.low);
  };
  constexpr std::size_t kChunks = 64;
  std::array<std::vector<std::uint64_t>, kChunks> found;
  const auto sort_out = [](std::vector<std::uint64_t>& keys) {
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  };
  tbb::parallel_for(std::size_t{0}, kChunks, [&](std::size_t chunk) {
    std::vector<std::uint64_t>& keys = found[chunk];
    std::size_t limit = std::size_t{1} << 16;  // of keys that are kept unsorted
    const auto add = [&](const Point3& p) {
      std::uint64_t key = 0;
      for (const double x : p) key = (key << 20) | static_cast<std::uint64_t>(x / cell);
      if (!keys.empty() && keys.back() == key) return;
      keys.push_back(key);
      if (keys.size() < limit) return;
      sort_out(keys);
      limit = std::max(limit, 2 * keys.size());
    };
    const std::size_t count = input.triangles.size();
    for (std::size_t f = chunk * count / kChunks; f < (chunk + 1) * count / kChunks; ++f) {
      const Triangle& t = input.triangles[f];
      const std::array<Point3, 3> p{place(t[0]), place(t[1]), place(t[2])};
      const double longest = std::max(
          {squared_norm(p[1] - p[0]), squared_norm(p[2] - p[1]), squared_norm(p[0] - p[2])});
      if (longest <= kStep * kStep) {
        add(p[0]);
      } else {
        for_each_raster_point(p, kStep, add);
      }
    }
    sort_out(keys);
  });
  std::vector<std::uint64_t> all;
  for (const auto& keys : found) all.insert(all.end(), keys.begin(), keys.end());
  sort_out(all);
  return static_cast<double>(all.size()) * (cell / kCell) * (cell / kCell);
}

// With the offset of the options, also where another resolution would not take it.
std::int64_t estimate(const TriangleSoup& input, const RemeshOptions& options, int resolution) {
  const double epsilon_steps = derive_parameters(input, options).epsilon * resolution;
  const double per_cell = kPerCell + kPerCellUndecimated * (1 - options.decimation.removed_share);
  const double bytes = kProgram + per_cell * count_cells(input, resolution, epsilon_steps) +
                       kPerInputFace * static_cast<double>(input.triangles.size());
  return static_cast<std::int64_t>(bytes);
}

std::string gigabytes(std::int64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g GB", static_cast<double>(bytes) * 1e-9);
  return text;
}

}  // namespace

std::int64_t estimate_memory(const TriangleSoup& input, const RemeshOptions& options) {
  return estimate(input, options, options.resolution);
}

std::int64_t check_memory(const TriangleSoup& input, const RemeshOptions& options) {
  const std::int64_t needed = estimate_memory(input, options);
  if (options.memory_limit == 0 || needed <= options.memory_limit) return needed;
  // The largest resolution that fits, to an eighth of it.
  int smaller = options.resolution;
  bool fits = false;
  while (smaller > 8 && !fits) {
    smaller -= std::max(1, smaller / 8);
    fits = estimate(input, options, smaller) <= options.memory_limit;
  }
  std::string what = "needs about " + gigabytes(needed) + " of memory at --resolution " +
                     std::to_string(options.resolution) + ", and " +
                     gigabytes(options.memory_limit) + " are there to be used (--memory)";
  what += fits ? "; --resolution " + std::to_string(smaller) + " would fit"
               : "; no resolution would fit";
  throw LimitError(what);
}

std::int64_t available_memory() {
  std::int64_t bytes = std::int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGESIZE);
  for (const char* file :
       {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::int64_t limit = 0;
    if (std::ifstream(file) >> limit && limit > 0) bytes = std::min(bytes, limit);  // or "max"
  }
  return bytes;
}

}  // namespace cellocut
