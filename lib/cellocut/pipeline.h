// The pipeline: a defective triangle mesh in, a closed manifold solid out, with every intermediate
// product.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cellocut/base/observer.h"
#include "cellocut/complex/tetrahedralizer.h"
#include "cellocut/cut/cut_solver.h"
#include "cellocut/energy/cell_graph.h"
#include "cellocut/energy/certificate.h"
#include "cellocut/energy/energy.h"
#include "cellocut/field/frame.h"
#include "cellocut/field/sparse_field.h"
#include "cellocut/mesh/mesh_file.h"
#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/path/auto_fill.h"
#include "cellocut/path/path_certificate.h"
#include "cellocut/proxy/proxy.h"
#include "cellocut/surface/fair_report.h"
#include "cellocut/surface/provenance.h"
#include "cellocut/surface/pull.h"
#include "cellocut/surface/simplification.h"
#include "cellocut/surface/union_field.h"
#include "cellocut/validity/surface_report.h"

namespace cellocut {

enum class SurfaceMode {
  union_,  // phi where the surface is supported, the absorbed cells where it was completed
  sdf,     // signed distance of the interface, marching cubes (the paper's)
  cells    // the facets of the interface, made manifold by splitting
};

// Minimum cuts are not unique; see cut/cut_solver.h.
enum class CutChoice { smallest, largest };

struct RemeshOptions {
  int resolution = 512;  // R, grid steps along the longest edge of the box; 8 to 16384
  // Thickening offset, relative to the longest edge. Default max(1/512, 1/R); at least 1/(2R), at
  // most 1.
  std::optional<double> epsilon;
  // The same in input units; at most one of the two may be given.
  std::optional<double> epsilon_absolute;
  Decimation decimation{};      // of the proxy
  Rational lambda_fill{20, 1};  // weight of an unsupported interface; terms up to 2^20
  // Whether lambda_fill is chosen from the fill path (path/auto_fill.h); by remesh() alone, with an
  // exact solver.
  bool lambda_auto = false;
  SupportRule support = SupportRule::labels;
  ExteriorMode exterior = ExteriorMode::unbounded;
  Guidance guidance;   // points that are to be inside or outside
  int area_bits = 40;  // facet areas sum to at most 2^area_bits quanta; 8 to 50
  CutChoice cut = CutChoice::largest;
  SurfaceMode surface = SurfaceMode::union_;
  // The distance from the input that pulled vertices keep, relative to the longest edge; above 0,
  // at most epsilon. Default min(1/R, epsilon) / 40.
  std::optional<double> pull_distance;
  // Fewer triangles: a target, and a bound on the Hausdorff distance to the full surface relative
  // to the longest edge. 0: none.
  std::int64_t faces = 0;
  double max_error = 0;
  // Surface components of less than this share of the total volume are dropped; 0 to 1.
  double min_component = 0;
  // When a relaxation stops; it is always completed to a flow, without which there is no
  // certificate.
  RelaxationOptions relaxation{};
  // The format that the surface will be written in: it is judged as a reader will see it.
  MeshFormat output_format = MeshFormat::obj;
  bool float_coordinates = false;  // only such as floats hold, also where the format has doubles
  // Whether supported vertices are pulled to the input; by default with `union_` alone, never with
  // `cells`.
  std::optional<bool> pull;
  bool fair = false;       // completed patches follow a bending energy; not with `cells`
  bool thickening = true;  // false: phi is the flood-signed distance, no offset (ablation)
  bool unary = true;       // false: L* only sets weights, nothing is anchored interior (ablation)
  bool reduce = false;     // the problem, exactly, before it is solved (SolveOptions::reduce)
  // Bytes that the run may take, by estimate (memory_estimate.h); 0: any number.
  std::int64_t memory_limit = 0;
  bool provenance = false;  // whether result.provenance is made
  // Whether the surface gets the colours of the input's vertices; with provenance or without.
  bool transfer_colour = false;

  [[nodiscard]] bool simplifies() const { return faces > 0 || max_error > 0; }
  [[nodiscard]] bool pulls() const { return pull.value_or(surface == SurfaceMode::union_); }

  // Errors: UsageError that names the option and what it may be.
  void validate() const;
};

struct StageTime {
  std::string name;
  double seconds = 0;
  std::int64_t peak_memory = 0;  // bytes: the process's largest resident set up to its end
};

// What the options come to on a given input.
struct DerivedParameters {
  double epsilon = 0;               // relative
  double epsilon_steps = 0;         // in grid steps
  bool epsilon_below_step = false;  // eps < h: thin parts may perforate
  double pull_distance = 0;         // relative
  Rational lambda_fill{1, 1};       // 1 until it is chosen, where that is asked for
};

// Errors: InputError for a mesh without faces or extent; UsageError where eps < h / 2 (a slab
// thinner than the grid perforates), naming the smallest usable resolution and epsilon, and where
// the pull would end beyond epsilon.
DerivedParameters derive_parameters(const TriangleSoup& input, const RemeshOptions& options);

struct RemeshResult {
  DerivedParameters derived;
  std::int64_t memory_estimate = 0;  // bytes
  std::string backend;               // the tetrahedralizer's name
  Frame frame;
  SparseField phi;  // the thickening field, in grid steps
  Proxy proxy;
  TetComplex complex;
  std::vector<float> centroid_phi;  // phi at every cell's centroid, in grid steps
  CellLabels initial_label;         // L*
  FacetList facets;
  FacetAreas areas;
  std::vector<Anchor> anchors;
  GuidedCells guided;  // of these, fixed by the guidance
  CellGraph graph;
  std::optional<FillChoice> fill_choice;  // where lambda_fill was chosen
  CutResult cut;
  CellLabels smallest_interior;  // the two canonical minima
  CellLabels largest_interior;
  CellLabels label;  // the one chosen
  std::vector<std::int64_t> facet_flow;
  CertificateReport certificate;
  // Where the solid of `union_` departs from the labelling; all 0 in other modes.
  LabellingDepartures departures;
  // Per vertex of the surface: it follows the input. Where the output's format merges vertices: all
  // of those did.
  std::vector<std::uint8_t> supported;
  PullReport pull;
  FairReport fair;
  Simplification simplification;  // its surface and source have moved to `surface`
  // In input units, as the reader of the file will see it; with colours where they were asked for,
  // whether or not the format holds them.
  TriangleSoup surface;
  Provenance provenance;  // of the surface; empty unless asked for
  SurfaceReport surface_report;
  std::int64_t dropped_components = 0;
  std::vector<StageTime> stages;

  [[nodiscard]] bool empty_solid() const;
};

// The stages up to the cut problem: result.graph and all that it was made from. Where phi is
// nowhere negative the proxy is empty and there is no problem. Errors: as remesh().
RemeshResult pose_cut(const TriangleSoup& input, const RemeshOptions& options,
                      const Tetrahedralizer& tetrahedralizer,
                      Observer& observer = silent_observer());

// The fill path of a result of pose_cut(), at whatever lambda it was posed, and what proves it: the
// checker, which keeps references to the result, is to see the flows where support is measured on
// facets. Errors: as find_cell_path().
PathChecker path_checker(const RemeshResult& result, const RemeshOptions& options);
CellPath find_path(const RemeshResult& result, const Lambda& first, const Lambda& last,
                   CutSolver& solver, Observer& observer = silent_observer(),
                   PathChecker* checker = nullptr);

// Labels the cells of a result of pose_cut() by a cut of its problem, lifts the flow to the facets
// and checks the certificate. May be called again, with another solver's cut.
// Precondition: cut.canonical.
void adopt_cut(RemeshResult& result, const RemeshOptions& options, CutResult cut);

// Solves the problem of a result of pose_cut() and adopts the cut. Errors: as CutSolver::solve();
// Cancelled.
void minimise_cut(RemeshResult& result, const RemeshOptions& options, CutSolver& solver,
                  Observer& observer = silent_observer());

// Runs all stages. Deterministic: the same bits for any number of threads.
// A cut that fails its certificate or a surface that fails its check is reported in the result, not
// thrown; later stages are skipped where an earlier one leaves nothing to work on (an empty solid).
// Errors: UsageError (options), InputError (a mesh without extent, or without the colours that are
// to be transferred), LimitError, Cancelled; with lambda_auto CertificateError, where the solver
// fails on the way to the weight.
RemeshResult remesh(const TriangleSoup& input, const RemeshOptions& options,
                    const Tetrahedralizer& tetrahedralizer, CutSolver& solver,
                    Observer& observer = silent_observer());

}  // namespace cellocut
