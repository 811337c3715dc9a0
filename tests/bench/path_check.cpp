// A fill path against cuts of their own at random lambdas.
//
//   path_check RESOLUTION MESH...
//
// For each mesh 20 lambdas with denominator 1000, uniform in log lambda over [1, 1000]: the least
// cost to the unit and the largest interior, cell for cell, by another solver than the path's.
// And what the path costs: medians of nine paths and nine cuts at lambda 20, by one solver, in
// turn. Exits with 1 at a difference, or where a path's certificate is not valid.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <random>
#include <stdexcept>
#include <string>

#include "backends/backends.h"
#include "cellocut/base/stopwatch.h"
#include "cellocut/mesh/mesh_file.h"
#include "cellocut/pipeline.h"
#include "solvers/solvers.h"

namespace {

using namespace cellocut;

struct Seconds {
  double path;
  double cut;
};

Seconds measure(const RemeshResult& result, const std::string& solver) {
  const CellGraph graph = build_cell_graph(result.complex, result.facets, result.areas,
                                           result.anchors, RemeshOptions{}.lambda_fill);
  std::array<double, 9> path{};
  std::array<double, 9> cut{};
  for (std::size_t n = 0; n < path.size(); ++n) {
    Stopwatch stopwatch;
    const CellPath all = find_path(result, {1, 1}, {1000, 1}, *solvers::make(solver));
    path[n] = stopwatch.seconds();
    if (all.count() == 0) throw std::logic_error("no labelling");
    stopwatch.restart();
    const CutResult one = solvers::make(solver)->solve(graph.problem);
    cut[n] = stopwatch.seconds();
    if (!one.canonical) throw std::logic_error("no exact solver");
  }
  const auto median = [](std::array<double, 9>& values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  };
  return {median(path), median(cut)};
}

bool agrees(const std::string& file, int resolution) {
  RemeshOptions options;
  options.resolution = resolution;
  options.lambda_fill = {1, 1};
  const RemeshResult result = pose_cut(read_mesh(file), options, *backends::make("cgal"));
  const CellPath path = find_path(result, {1, 1}, {1000, 1}, *solvers::make("push_relabel"));
  const bool valid = path_checker(result, options).check(path, {{1, 1}, {1000, 1}}).valid;
  std::mt19937_64 random(1);
  int agreed = 0;
  constexpr int kLambdas = 20;
  for (int n = 0; n < kLambdas; ++n) {
    const double exponent = static_cast<double>(random() >> 11) * 0x1p-53;
    const Lambda lambda{static_cast<std::int64_t>(1000 * std::pow(1000.0, exponent)), 1000};
    const CellGraph graph = build_cell_graph(result.complex, result.facets, result.areas,
                                             result.anchors, {lambda.p, lambda.q});
    const CutResult cut = solvers::make("ibfs")->solve(graph.problem);
    const std::size_t k = labelling_at(path.path, lambda);
    const bool same = cost_at(path.path.areas[k], lambda) == Wide{cut.value} &&
                      path.labels(k) == expand_labels(graph, cut.largest_source_side);
    agreed += same ? 1 : 0;
  }
  fmt::print("{}: {} labellings, certificate {}, {} of {} lambdas agree\n", file, path.count(),
             valid ? "valid" : "NOT VALID", agreed, kLambdas);
  for (const char* solver : {"push_relabel", "bk"}) {
    const Seconds seconds = measure(result, solver);
    fmt::print("  {}: path {:.2f} ms, one cut {:.2f} ms, ratio {:.1f}\n", solver,
               1e3 * seconds.path, 1e3 * seconds.cut, seconds.path / seconds.cut);
  }
  return valid && agreed == kLambdas;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    fmt::print(stderr, "path_check RESOLUTION MESH...\n");
    return 2;
  }
  bool all = true;
  try {
    for (int n = 2; n < count; ++n) {
      all = agrees(arguments[n], std::stoi(arguments[1])) && all;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return all ? 0 : 1;
}
