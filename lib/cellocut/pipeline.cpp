#include "cellocut/pipeline.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cellocut/base/errors.h"
#include "cellocut/base/memory.h"
#include "cellocut/base/stopwatch.h"
#include "cellocut/energy/facet_support.h"
#include "cellocut/field/distance_field.h"
#include "cellocut/field/flood_sign.h"
#include "cellocut/memory_estimate.h"
#include "cellocut/path/one_sided.h"
#include "cellocut/surface/components.h"
#include "cellocut/surface/interface.h"
#include "cellocut/surface/iso_surface.h"
#include "cellocut/surface/signed_distance.h"
#include "cellocut/surface/support.h"
#include "cellocut/surface/union_field.h"

namespace cellocut {

namespace {

// Names the stages to the observer and measures them.
class StageClock {
 public:
  StageClock(std::vector<StageTime>& stages, Observer& observer)
      : stages_(stages), observer_(observer) {}

  template <class Work>
  auto operator()(const char* name, const Work& work) {
    observer_.check();
    observer_.stage(name);
    const Stopwatch stopwatch;
    auto product = work();
    stages_.push_back({name, stopwatch.seconds(), peak_memory_bytes()});
    return product;
  }

 private:
  std::vector<StageTime>& stages_;
  Observer& observer_;
};

SparseField compute_phi(const TriangleSoup& input, const RemeshOptions& options,
                        const RemeshResult& result, Observer& observer) {
  return options.thickening
             ? compute_distance_field(input, result.frame, result.derived.epsilon_steps, observer)
             : compute_flood_signed_distance(input, result.frame, observer);
}

std::vector<float> sample_centroids(const SparseField& phi, const TetComplex& complex,
                                    const Frame& frame) {
  std::vector<Point3> centroids(complex.cells.size());
  for (std::uint32_t c = 0; c < centroids.size(); ++c) {
    centroids[c] = frame.to_index(cell_centroid(complex, c));
  }
  return phi.sample(centroids);
}

// L*: interior iff phi(centroid) < 0.
CellLabels label_by_sign(const std::vector<float>& phi) {
  CellLabels labels(phi.size());
  std::transform(phi.begin(), phi.end(), labels.begin(),
                 [](float value) { return value < 0 ? kInterior : kExterior; });
  return labels;
}

std::vector<std::int64_t> measure_support(const RemeshResult& result,
                                          const RemeshOptions& options) {
  return options.support == SupportRule::labels
             ? support_by_labels(result.facets, result.areas, result.initial_label)
             : support_by_facets(result.complex, result.facets, result.areas, result.phi,
                                 result.frame);
}

// What a certificate takes as given: support that does not follow from the labels.
const std::vector<std::int64_t>* claimed_support(const RemeshResult& result,
                                                 const RemeshOptions& options) {
  return options.support == SupportRule::labels ? nullptr : &result.areas.supported;
}

CertificateReport certify(const RemeshResult& result, const RemeshOptions& options) {
  return check_certificate({.complex = result.complex,
                            .initial = result.initial_label,
                            .mode = options.exterior,
                            .lambda = result.derived.lambda_fill,
                            .unit = result.frame.unit,
                            .area_bits = options.area_bits,
                            .facet_flow = result.facet_flow,
                            .value = result.cut.value,
                            .smallest_interior = result.smallest_interior,
                            .largest_interior = result.largest_interior,
                            .unary = options.unary,
                            .guided = result.guided,
                            .supported = claimed_support(result, options)});
}

// The surface in index coordinates of the grid.
TriangleSoup extract_iso_surface(RemeshResult& result, SurfaceMode mode, Observer& observer) {
  if (mode == SurfaceMode::sdf) {
    const TriangleSoup interface =
        interface_triangles(result.complex, list_interface(result.complex, result.label));
    return extract_iso_surface(compute_signed_distance(interface, result.frame, observer));
  }
  const UnionField combined = compute_union_field(result.phi, result.complex, result.initial_label,
                                                  result.label, result.frame, observer);
  result.departures = combined.departures;
  return extract_iso_surface(combined.field);
}

TriangleSoup extract_surface(RemeshResult& result, const RemeshOptions& options,
                             Observer& observer) {
  if (options.surface == SurfaceMode::cells) {
    TriangleSoup surface = extract_interface_cells(result.complex, result.label);
    result.dropped_components = drop_small_components(surface, options.min_component);
    TriangleSoup on_grid = surface;
    to_index_coordinates(on_grid, result.frame);
    result.supported = find_supported(on_grid, result.phi);
    return surface;
  }
  TriangleSoup surface = extract_iso_surface(result, options.surface, observer);
  result.dropped_components = drop_small_components(surface, options.min_component);
  result.supported = find_supported(surface, result.phi);
  to_input_units(surface, result.frame);
  return surface;
}

// Per-vertex values follow the vertices that are left.
void adopt_simplified(RemeshResult& result) {
  Simplification& simplified = result.simplification;
  std::vector<std::uint8_t> supported;
  supported.reserve(simplified.source.size());
  for (const std::uint32_t v : simplified.source) supported.push_back(result.supported[v]);
  result.supported = std::move(supported);
  result.surface = std::move(simplified.surface);
  simplified.surface = {};
  simplified.source = {};
}

// The surface as a reader of the file will see it, and `supported` with it: a vertex that stands
// for several is supported if all of them are.
void adopt_read_back(RemeshResult& result, MeshFormat format) {
  TriangleSoup seen = as_read_back(result.surface, format);
  if (seen.points.size() != result.surface.points.size() ||
      seen.triangles != result.surface.triangles) {
    std::vector<std::uint8_t> supported(seen.points.size(), 1);
    for (std::size_t f = 0; f < seen.triangles.size(); ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (result.supported[result.surface.triangles[f][k]] == 0) {
          supported[seen.triangles[f][k]] = 0;
        }
      }
    }
    result.supported = std::move(supported);
  }
  result.surface = std::move(seen);
}

// The nearest points of the input, built by the first stage that uses them.
class LazyNearest {
 public:
  explicit LazyNearest(const TriangleSoup& input) : input_(input) {}
  const NearestTriangle& operator()() {
    if (!nearest_) nearest_.emplace(input_);
    return *nearest_;
  }

 private:
  const TriangleSoup& input_;
  std::optional<NearestTriangle> nearest_;
};

// Finds the fill path and poses the cut anew with the lambda that is chosen from it.
void choose_lambda(RemeshResult& result, CutSolver& solver, LazyNearest& nearest_point,
                   Observer& observer) {
  const CellPath path = find_path(result, kAutoFirst, kAutoLast, solver, observer);
  const std::vector<SheetSides> sides = measure_sheet_sides(
      sample_sheets(result.complex, result.facets, result.areas, result.initial_label,
                    nearest_point(), result.derived.epsilon * result.frame.unit, observer),
      path);
  // Terms with which the problem's capacities, both directions of every facet, stay in range.
  const std::int64_t largest_term =
      std::min(kLargestLambdaTerm, kCapacityLimit / 2 / (result.areas.sum + 1));
  result.fill_choice = choose_fill(path, sides, path_solids(result.complex, path), largest_term);
  result.derived.lambda_fill = result.fill_choice->lambda;
  result.graph = build_cell_graph(result.complex, result.facets, result.areas, result.anchors,
                                  result.derived.lambda_fill);
}

// Whether the surface is valid in such coordinates.
bool round_surface(TriangleSoup& surface, Coordinates coordinates, Observer& observer) {
  if (coordinates == Coordinates::doubles) return true;
  for (Point3& p : surface.points) p = kept(p, coordinates);
  return inspect_surface(surface, {.observer = &observer}).valid();
}

// What is done to the extracted surface, in the coordinates that its file keeps: the supported part
// goes to the input, the completed one where it bends least; then fewer triangles, and where each
// vertex comes from.
void treat_surface(const TriangleSoup& input, const RemeshOptions& options, RemeshResult& result,
                   LazyNearest& nearest_point, StageClock& stage, Observer& observer) {
  const double unit = result.frame.unit;
  const Coordinates coordinates =
      options.float_coordinates ? Coordinates::floats : coordinates_of(options.output_format);
  if (!round_surface(result.surface, coordinates, observer)) {
    adopt_read_back(result, options.output_format);  // to be refused
    return;
  }
  if (options.pulls()) {
    result.pull = stage("pull", [&] {
      return pull_to_input(result.surface, result.supported, nearest_point(),
                           result.derived.epsilon * unit, result.derived.pull_distance * unit,
                           observer, coordinates);
    });
  }
  if (options.fair) {
    result.fair = stage("fairing", [&] {
      return fair_surface(result.surface, result.supported, nearest_point(), result.frame.spacing,
                          result.derived.pull_distance * unit, observer, coordinates);
    });
  }
  if (options.simplifies()) {
    result.simplification = stage("simplification", [&] {
      return simplify_surface(result.surface,
                              {.faces = options.faces, .max_error = options.max_error * unit},
                              observer);
    });
    adopt_simplified(result);
  }
  adopt_read_back(result, options.output_format);
  if (options.provenance || options.transfer_colour) {
    result.provenance = stage("provenance", [&] {
      return trace_provenance(result.surface, result.supported, input, nearest_point(),
                              options.transfer_colour, observer);
    });
    result.surface.colours = result.provenance.colours;
    if (!options.provenance) result.provenance = {};
  }
}

}  // namespace

bool RemeshResult::empty_solid() const {
  return std::find(label.begin(), label.end(), kInterior) == label.end();
}

// The paper's Algorithm 1, line by line.

RemeshResult pose_cut(const TriangleSoup& input, const RemeshOptions& options,
                      const Tetrahedralizer& tetrahedralizer, Observer& observer) {
  options.validate();
  RemeshResult result;
  StageClock stage(result.stages, observer);

  // Stage 1: discretization.
  result.derived = derive_parameters(input, options);
  result.memory_estimate = check_memory(input, options);
  result.backend = tetrahedralizer.info().name;
  result.frame =
      make_frame(bounding_box(input), options.resolution, result.derived.epsilon_steps + kBand + 1);
  result.phi = stage("field", [&] { return compute_phi(input, options, result, observer); });
  TriangleSoup thick = stage("iso-surface", [&] { return extract_iso_surface(result.phi); });
  result.proxy = stage("decimation", [&] {
    return make_proxy(std::move(thick), result.phi, result.frame, options.decimation, observer);
  });
  if (result.proxy.mesh.empty()) return result;
  result.complex = stage("tetrahedralization",
                         [&] { return tetrahedralizer.tetrahedralize(result.proxy.mesh.points); });
  result.initial_label = stage("initial labels", [&] {
    result.centroid_phi = sample_centroids(result.phi, result.complex, result.frame);
    return label_by_sign(result.centroid_phi);
  });

  // Stage 2: graph construction.
  result.graph = stage("graph", [&] {
    result.facets = list_facets(result.complex);
    result.areas =
        quantise_areas(result.complex, result.facets, result.frame.unit, options.area_bits);
    result.areas.supported = measure_support(result, options);
    result.anchors = options.unary
                         ? anchor_cells(result.complex, result.initial_label, options.exterior)
                         : std::vector<Anchor>(result.complex.cells.size(), Anchor::free);
    result.guided =
        guide_cells(result.complex, options.guidance, result.initial_label, result.anchors);
    return build_cell_graph(result.complex, result.facets, result.areas, result.anchors,
                            result.derived.lambda_fill);
  });
  return result;
}

PathChecker path_checker(const RemeshResult& result, const RemeshOptions& options) {
  return PathChecker({.complex = result.complex,
                      .initial = result.initial_label,
                      .mode = options.exterior,
                      .guided = result.guided,
                      .unit = result.frame.unit,
                      .area_bits = options.area_bits,
                      .supported = claimed_support(result, options)});
}

CellPath find_path(const RemeshResult& result, const Lambda& first, const Lambda& last,
                   CutSolver& solver, Observer& observer, PathChecker* checker) {
  FlowWitness witness;
  if (checker != nullptr) {
    witness = [checker](const Lambda& lambda, const std::vector<Wide>& facet_flow) {
      checker->add_flow(lambda, facet_flow);
    };
  }
  return find_cell_path(result.graph, result.facets, result.areas, first, last, solver, observer,
                        witness);
}

void adopt_cut(RemeshResult& result, const RemeshOptions& options, CutResult cut) {
  result.smallest_interior = expand_labels(result.graph, cut.smallest_source_side);
  result.largest_interior = expand_labels(result.graph, cut.largest_source_side);
  result.label =
      options.cut == CutChoice::largest ? result.largest_interior : result.smallest_interior;
  result.facet_flow = lift_flow(result.graph, result.facets, result.areas, result.anchors,
                                result.derived.lambda_fill, cut.edge_flow);
  result.cut = std::move(cut);
  result.certificate = certify(result, options);
}

void minimise_cut(RemeshResult& result, const RemeshOptions& options, CutSolver& solver,
                  Observer& observer) {
  StageClock stage(result.stages, observer);
  CutResult cut = stage("minimum cut", [&] {
    RelaxationOptions relaxation = options.relaxation;
    relaxation.crossover = true;
    return solver.solve(
        result.graph.problem,
        SolveOptions{.observer = &observer, .relaxation = relaxation, .reduce = options.reduce});
  });
  if (cut.status == CutStatus::invalid) {
    result.cut = std::move(cut);
    return;
  }
  stage("certificate", [&] {
    adopt_cut(result, options, std::move(cut));
    return result.certificate.valid;
  });
}

RemeshResult remesh(const TriangleSoup& input, const RemeshOptions& options,
                    const Tetrahedralizer& tetrahedralizer, CutSolver& solver, Observer& observer) {
  if (options.transfer_colour && input.colours.empty()) {
    throw InputError("the mesh has no colours at its vertices that could be transferred");
  }
  if (options.lambda_auto && options.support != SupportRule::labels) {
    throw UsageError(
        "--lambda-fill auto chooses from a nested fill path: it needs --support labels");
  }
  if (options.lambda_auto && !solver.info().exact) {
    throw UsageError("--lambda-fill auto needs an exact solver");
  }
  RemeshResult result = pose_cut(input, options, tetrahedralizer, observer);
  if (result.proxy.mesh.empty()) return result;

  LazyNearest nearest_point(input);
  if (options.lambda_auto) {
    StageClock stage(result.stages, observer);
    stage("fill path", [&] {
      choose_lambda(result, solver, nearest_point, observer);
      return result.fill_choice->labellings;
    });
  }

  // Stage 3: optimization and extraction.
  minimise_cut(result, options, solver, observer);
  if (result.cut.status == CutStatus::invalid || result.empty_solid()) return result;
  StageClock stage(result.stages, observer);
  result.surface = stage("surface", [&] { return extract_surface(result, options, observer); });
  treat_surface(input, options, result, nearest_point, stage, observer);
  result.surface_report = stage("validity", [&] {
    return inspect_surface(result.surface, SurfaceCheckOptions{.observer = &observer});
  });
  return result;
}

}  // namespace cellocut
