#include "tools/report_json.h"

#include <nlohmann/json.hpp>

#include "cellocut/base/memory.h"
#include "cellocut_version.h"
#include "tools/session.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

Json incidence_json(const IncidenceCounts& counts) {
  return {{"boundary_edges", counts.boundary_edges},
          {"nonmanifold_edges", counts.nonmanifold_edges},
          {"nonmanifold_vertices", counts.nonmanifold_vertices},
          {"misoriented_edges", counts.misoriented_edges},
          {"duplicate_faces", counts.duplicate_faces}};
}

const char* surface_name(SurfaceMode mode) {
  switch (mode) {
    case SurfaceMode::union_:
      return "union";
    case SurfaceMode::sdf:
      return "sdf";
    case SurfaceMode::cells:
      return "cells";
  }
  return "";
}

// Lengths and volumes in input units.
Json surface_json(const RemeshResult& result, const RemeshOptions& options) {
  Json surface = Json::object();
  if (options.surface == SurfaceMode::union_) {
    const LabellingDepartures& departures = result.departures;
    surface["departures"] = {{"solid_beyond_labelling_volume", departures.beyond},
                             {"left_out_volume", departures.left_out},
                             {"closed_volume", departures.closed}};
  }
  if (options.pulls()) {
    const PullReport& pull = result.pull;
    surface["pull"] = {
        {"distance", pull.distance},     {"vertices", pull.vertices},
        {"supported", pull.supported},   {"stopped_early", pull.stopped_early},
        {"went_back", pull.went_back},   {"bad_faces_at_first", pull.bad_faces_at_first},
        {"rounds", pull.rounds},         {"offset_median", pull.offset.median},
        {"offset_p95", pull.offset.p95}, {"offset_largest", pull.offset.largest}};
  }
  if (options.fair) {
    const FairReport& fair = result.fair;
    surface["fairing"] = {{"patches", fair.patches},
                          {"patches_left", fair.patches_left},
                          {"vertices_moved", fair.vertices_moved},
                          {"vertices_stopped", fair.vertices_stopped},
                          {"bending_before", fair.bending_before},
                          {"bending_after", fair.bending_after},
                          {"bad_faces_at_first", fair.bad_faces_at_first},
                          {"stopped_early", fair.stopped_early},
                          {"went_back", fair.went_back}};
  }
  if (options.simplifies()) {
    const Simplification& simplified = result.simplification;
    const CollapseCounts& counts = simplified.counts;
    surface["simplification"] = {{"reached", simplified.reached},
                                 {"stop", simplified.stop},
                                 {"error", simplified.error},
                                 {"error_lower", simplified.error_lower},
                                 {"attempts", simplified.attempts},
                                 {"collapses", counts.collapses},
                                 {"refused_topology", counts.refused_topology},
                                 {"refused_folding", counts.refused_folding},
                                 {"refused_slivers", counts.refused_slivers},
                                 {"refused_degenerate", counts.refused_degenerate},
                                 {"refused_intersecting", counts.refused_intersecting},
                                 {"refused_distance", counts.refused_distance}};
  }
  return surface;
}

Json parameters_json(const RemeshResult& result, const RemeshOptions& options) {
  return {{"resolution", options.resolution},
          {"epsilon", result.derived.epsilon},
          {"epsilon_abs", result.derived.epsilon * result.frame.unit},
          {"epsilon_below_step", result.derived.epsilon_below_step},
          {"grid_step", result.frame.spacing},
          {"unit", result.frame.unit},
          {"decimate", options.decimation.removed_share},
          {"decimation", name_of(options.decimation.method)},
          {"lambda_fill", to_string(result.derived.lambda_fill)},
          {"support", name_of(options.support)},
          {"exterior", name_of(options.exterior)},
          {"guidance", guidance_json(options.guidance)},
          {"area_bits", options.area_bits},
          {"cut", name_of(options.cut)},
          {"surface", surface_name(options.surface)},
          {"pull", options.pulls()},
          {"pull_distance", result.derived.pull_distance},
          {"fair", options.fair},
          {"faces", options.faces},
          {"max_error", options.max_error},
          {"float_coordinates", options.float_coordinates},
          {"thickening", options.thickening},
          {"unary", options.unary},
          {"min_component", options.min_component},
          {"provenance", options.provenance},
          {"transfer_colour", options.transfer_colour}};
}

std::int64_t count_interior(const CellLabels& labels) {
  return std::count(labels.begin(), labels.end(), kInterior);
}

Json cut_json(const RemeshResult& result, const RemeshOptions& options, const RunFacts& facts) {
  const double quantum = 1 / result.areas.scale;  // squared relative units
  const double unit_energy =
      quantum * result.frame.unit * result.frame.unit /
      static_cast<double>(result.derived.lambda_fill.denominator);  // squared input units
  Json counters = Json::object();
  for (const auto& [name, value] : result.cut.counters) counters[name] = value;
  return {{"backend", facts.backend},
          {"solver", facts.solver},
          {"status", to_string(result.cut.status)},
          {"stop", result.cut.stop},
          {"message", result.cut.message},
          {"value", result.cut.value},
          {"constant", result.graph.problem.constant},
          {"energy", static_cast<double>(result.cut.value) * unit_energy},
          {"lower_bound", result.cut.lower_bound},
          {"gap", result.cut.value - result.cut.lower_bound},
          {"build_seconds", result.cut.build_seconds},
          {"solve_seconds", result.cut.solve_seconds},
          {"verify_seconds", result.cut.verify_seconds},
          {"solver_bytes", result.cut.bytes},
          {"counters", counters},
          {"area_bits", options.area_bits},
          {"area_quantum", quantum},
          {"area_largest_error", result.areas.largest_error},
          {"area_total_error", result.areas.total_error},
          {"lambda_num", result.derived.lambda_fill.numerator},
          {"lambda_den", result.derived.lambda_fill.denominator},
          {"interior_cells", count_interior(result.label)},
          {"interior_cells_smallest", count_interior(result.smallest_interior)},
          {"interior_cells_largest", count_interior(result.largest_interior)}};
}

Json candidate_json(const FillCandidate& candidate) {
  return {{"lambda_from", to_double(candidate.from)},
          {"lambda_to", to_double(candidate.to)},
          {"one_sided_area", candidate.sides.one_sided},
          {"open_area", candidate.sides.open},
          {"volume", candidate.volume}};
}

// Areas in squared relative units.
Json fill_choice_json(const FillChoice& choice) {
  Json report{{"lambda_fill", to_string(choice.lambda)},
              {"labellings", choice.labellings},
              {"chosen", candidate_json(choice.chosen)},
              {"runner_up", nullptr},
              {"margin", nullptr}};
  if (choice.runner_up) {
    report["runner_up"] = candidate_json(*choice.runner_up);
    report["margin"] = choice.margin();
  }
  return report;
}

Json stages_json(const RunFacts& facts) {
  Json stages = Json::array();
  for (const StageTime& stage : facts.stages) {
    stages.push_back({{"name", stage.name},
                      {"seconds", stage.seconds},
                      {"threads", facts.threads},
                      {"peak_memory_bytes", stage.peak_memory}});
  }
  return stages;
}

}  // namespace

Json guidance_json(const Guidance& guidance) {
  return {{"inside", guidance.inside}, {"outside", guidance.outside}};
}

Json certificate_json(const CertificateReport& certificate) {
  Json checks = Json::array();
  for (const CertificateCheck& check : certificate.checks) {
    checks.push_back({{"name", check.name}, {"passed", check.passed}, {"detail", check.detail}});
  }
  return {{"valid", certificate.valid}, {"checks", checks}};
}

const char* name_of(DecimationMethod method) {
  return method == DecimationMethod::clusters ? "clusters" : "quadric";
}
const char* name_of(SupportRule rule) { return rule == SupportRule::labels ? "labels" : "facets"; }
const char* name_of(ExteriorMode mode) {
  return mode == ExteriorMode::unbounded ? "unbounded" : "hull-cells";
}
const char* name_of(CutChoice choice) {
  return choice == CutChoice::largest ? "largest" : "smallest";
}

Json output_json(const SurfaceReport& report, const std::string& path) {
  Json components = Json::array();
  for (const SurfaceComponent& component : report.components) {
    components.push_back({{"triangles", component.triangles}, {"volume", component.volume}});
  }
  Json pairs = Json::array();
  for (const auto& [a, b] : report.pairs) pairs.push_back({a, b});
  return {{"path", path},
          {"valid", report.valid()},
          {"points", report.points},
          {"triangles", report.triangles},
          {"boundary_edges", report.by_index.boundary_edges},
          {"nonmanifold_edges", report.by_index.nonmanifold_edges},
          {"nonmanifold_vertices", report.by_index.nonmanifold_vertices},
          {"misoriented_edges", report.by_index.misoriented_edges},
          {"duplicate_faces", report.by_index.duplicate_faces},
          {"degenerate_faces", report.degenerate_faces},
          {"nonfinite_points", report.nonfinite_points},
          {"intersecting_pairs", report.intersecting_pairs},
          {"touching_edges", report.touching_edges},
          {"touching_vertices", report.touching_vertices},
          {"by_position", incidence_json(report.by_position)},
          {"components", components},
          {"volume", report.volume},
          {"area", report.area},
          {"euler", report.euler},
          {"first_intersecting_pairs", pairs}};
}

Json remesh_json(const RemeshResult& result, const RemeshOptions& options,
                 const TriangleSoup& input, const RunFacts& facts) {
  Json report;
  report["version"] = kCellocutVersion;
  report["input"] = {{"path", facts.input},
                     {"points", input.points.size()},
                     {"triangles", input.triangles.size()},
                     {"skipped_polygons", input.skipped_polygons}};
  report["parameters"] = parameters_json(result, options);
  report["stages"] = stages_json(facts);
  report["memory_estimate_bytes"] = result.memory_estimate;
  report["peak_memory_bytes"] = peak_memory_bytes();
  report["proxy"] = {{"faces_before", result.proxy.faces_before},
                     {"faces", result.proxy.mesh.triangles.size()},
                     {"removed_share", result.proxy.removed_share},
                     {"largest_distance_steps", result.proxy.largest_distance},
                     {"faces_restored", result.proxy.faces_restored}};
  report["field"] = {{"stored_values", result.phi.stored_values()}, {"bytes", result.phi.bytes()}};
  report["counts"] = {{"vertices", result.complex.points.size()},
                      {"cells", result.complex.cells.size()},
                      {"facets", result.facets.size()},
                      {"nodes", result.graph.problem.node_count()},
                      {"edges", result.graph.problem.edges.size()},
                      {"nodes_removed", result.graph.anchored_cells + result.graph.enclosed_cells},
                      {"cells_anchored", result.graph.anchored_cells},
                      {"cells_enclosed", result.graph.enclosed_cells},
                      {"cells_guided_inside", result.guided.inside.size()},
                      {"cells_guided_outside", result.guided.outside.size()}};
  if (result.fill_choice) report["fill_choice"] = fill_choice_json(*result.fill_choice);
  report["cut"] = cut_json(result, options, facts);
  report["certificate"] = certificate_json(result.certificate);
  report["surface"] = surface_json(result, options);
  report["output"] = output_json(result.surface_report, facts.output);
  report["output"]["dropped_components"] = result.dropped_components;
  return report;
}

}  // namespace cellocut::tools
