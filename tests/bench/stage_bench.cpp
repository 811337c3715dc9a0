// Each stage of a remesh by itself, on fixed inputs, with its throughput (Google Benchmark).
//
//   stage_bench [--benchmark_filter=pull/512] [--benchmark_repetitions=5]
//
// The number in a name is the resolution R. Inputs: a sphere with a hole cut in, which the cut
// completes, and a Moebius strip, a single-layer sheet. Whole programs are compared by
// tests/bench/ratios.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "backends/backends.h"
#include "cellocut/field/distance_field.h"
#include "cellocut/measure/nearest_triangle.h"
#include "cellocut/mesh/mesh_file.h"
#include "cellocut/pipeline.h"
#include "cellocut/surface/iso_surface.h"
#include "cellocut/surface/pull.h"
#include "cellocut/surface/union_field.h"
#include "cellocut/validity/surface_report.h"
#include "solvers/solvers.h"
#include "support/defective_meshes.h"

namespace {

using namespace cellocut;

// What the stages are given, made once.
struct Given {
  TriangleSoup input;
  RemeshOptions options;
  RemeshResult result;  // surface not yet pulled
  TriangleSoup thick;   // phi = 0
  std::unique_ptr<NearestTriangle> nearest;
};

TriangleSoup input_named(const std::string& name) {
  return name == "sphere" ? test::sphere_with_hole() : test::moebius_strip();
}

const Given& given(const std::string& name, int resolution) {
  static std::map<std::pair<std::string, int>, Given> cache;
  const auto [entry, fresh] = cache.try_emplace({name, resolution});
  Given& g = entry->second;
  if (fresh) {
    g.input = input_named(name);
    g.options.resolution = resolution;
    g.options.pull = false;
    g.result = remesh(g.input, g.options, *backends::make("cgal"), *solvers::make("bk"));
    g.thick = extract_iso_surface(g.result.phi);
    g.nearest = std::make_unique<NearestTriangle>(g.input);
  }
  return g;
}

// A stage: does its work once and returns how many of its units that was.
using Stage = std::function<std::int64_t(benchmark::State&, const Given&)>;

// A copy that a stage may change, made while the clock stands.
template <class T>
T copy_of(benchmark::State& state, const T& original) {
  state.PauseTiming();
  T copy = original;
  state.ResumeTiming();
  return copy;
}

template <class T>
std::int64_t count(const T& items) {
  return static_cast<std::int64_t>(items.size());
}

std::int64_t field(benchmark::State& /*state*/, const Given& g) {
  const SparseField phi = compute_distance_field(g.input, g.result.frame,
                                                 g.result.derived.epsilon_steps, silent_observer());
  return static_cast<std::int64_t>(phi.stored_values());
}

std::int64_t iso_surface(benchmark::State& /*state*/, const Given& g) {
  return count(extract_iso_surface(g.result.phi).triangles);
}

std::int64_t decimation(benchmark::State& state, const Given& g) {
  const Proxy proxy = make_proxy(copy_of(state, g.thick), g.result.phi, g.result.frame,
                                 g.options.decimation, silent_observer());
  return proxy.faces_before;
}

std::int64_t graph(benchmark::State& /*state*/, const Given& g) {
  const FacetList facets = list_facets(g.result.complex);
  FacetAreas areas =
      quantise_areas(g.result.complex, facets, g.result.frame.unit, g.options.area_bits);
  areas.supported = support_by_labels(facets, areas, g.result.initial_label);
  benchmark::DoNotOptimize(build_cell_graph(g.result.complex, facets, areas, g.result.anchors,
                                            g.result.derived.lambda_fill));
  return count(facets);
}

std::int64_t certificate(benchmark::State& state, const Given& g) {
  RemeshResult result = copy_of(state, g.result);
  adopt_cut(result, g.options, result.cut);
  return count(result.facets);
}

std::int64_t surface(benchmark::State& /*state*/, const Given& g) {
  const UnionField field =
      compute_union_field(g.result.phi, g.result.complex, g.result.initial_label, g.result.label,
                          g.result.frame, silent_observer());
  return count(extract_iso_surface(field.field).triangles);
}

std::int64_t pull(benchmark::State& state, const Given& g) {
  TriangleSoup surface = copy_of(state, g.result.surface);
  const double unit = g.result.frame.unit;
  pull_to_input(surface, g.result.supported, *g.nearest, g.result.derived.epsilon * unit,
                g.result.derived.pull_distance * unit, silent_observer());
  return count(surface.points);
}

std::int64_t validity(benchmark::State& /*state*/, const Given& g) {
  benchmark::DoNotOptimize(inspect_surface(g.result.surface));
  return count(g.result.surface.triangles);
}

std::int64_t encoding(benchmark::State& /*state*/, const Given& g) {
  benchmark::DoNotOptimize(encode_mesh(g.result.surface, MeshFormat::obj));
  return count(g.result.surface.triangles);
}

Stage tetrahedralization(const std::string& backend) {
  return [backend](benchmark::State& /*state*/, const Given& g) {
    return count(backends::make(backend)->tetrahedralize(g.result.proxy.mesh.points).points);
  };
}

Stage minimum_cut(const std::string& solver) {
  return [solver](benchmark::State& /*state*/, const Given& g) {
    benchmark::DoNotOptimize(solvers::make(solver)->solve(g.result.graph.problem));
    return count(g.result.graph.problem.edges);
  };
}

const std::vector<std::int64_t> kResolutions{64, 256, 512};

void add(const std::string& name, const char* units, const Stage& stage,
         const std::vector<std::int64_t>& resolutions = kResolutions) {
  for (const char* input : {"sphere", "moebius"}) {
    const auto run = [input, units, stage](benchmark::State& state) {
      const Given& g = given(input, static_cast<int>(state.range(0)));
      std::int64_t done = 0;
      for ([[maybe_unused]] const auto _ : state) done += stage(state, g);
      state.counters[units] =
          benchmark::Counter(static_cast<double>(done), benchmark::Counter::kIsRate);
    };
    benchmark::RegisterBenchmark((name + "/" + input).c_str(), run)
        ->ArgsProduct({resolutions})
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
}

}  // namespace

int main(int count, char** arguments) {
  add("field", "voxels", field);
  add("iso_surface", "triangles", iso_surface);
  add("decimation", "triangles", decimation);
  for (const auto& entry : backends::registered()) {
    if (entry.make == nullptr) continue;
    add("tetrahedralization/" + entry.name, "points", tetrahedralization(entry.name));
  }
  add("graph", "facets", graph);
  for (const auto& entry : solvers::registered()) {
    if (entry.make == nullptr || !entry.make()->info().exact) continue;
    // References that are far slower than the rest.
    const bool slow = entry.name == "clp" || entry.name == "lemon_preflow";
    add("minimum_cut/" + entry.name, "edges", minimum_cut(entry.name),
        slow ? std::vector<std::int64_t>{64} : kResolutions);
  }
  add("certificate", "facets", certificate);
  add("surface", "triangles", surface);
  add("pull", "vertices", pull);
  add("validity", "triangles", validity);
  add("encoding", "triangles", encoding);
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
