#include "tools/evaluation_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cellocut_version.h"
#include "tools/image_report.h"
#include "tools/report_json.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

// ---- tables -------------------------------------------------------------------------------------

std::string agreement_table(const EvaluationReport& report, const char* title,
                            Agreement Evaluation::*kind) {
  std::vector<std::string> heads{title, "CD", "HD", "ANC"};
  for (const double t : report.options.thresholds) heads.push_back(fmt::format("F1@{}", t));
  Table table(std::move(heads));
  for (const EvaluatedMesh& mesh : report.meshes) {
    const Agreement& found = mesh.evaluation.*kind;
    std::vector<std::string> row{mesh.path, figure(found.chamfer), figure(found.hausdorff),
                                 figure(found.normal_consistency)};
    for (std::size_t k = 0; k < report.options.thresholds.size(); ++k) {
      row.push_back(found.f1.empty() ? "-" : fmt::format("{:.2f}", found.f1[k]));
    }
    table.add(std::move(row));
  }
  return table.text();
}

std::string distance_table(const EvaluationReport& report, const char* title,
                           std::optional<DistanceSummary> Agreement::*way,
                           Agreement Evaluation::*kind) {
  Table table({title, "median", "p95", "mean", "max", "median*", "p95*", "mean*", "max*"});
  for (const EvaluatedMesh& mesh : report.meshes) {
    const std::optional<DistanceSummary>& found = mesh.evaluation.*kind.*way;
    std::vector<std::string> row{mesh.path};
    for (const double unit : {1.0, report.reference.unit}) {
      for (const auto value : {&DistanceSummary::median, &DistanceSummary::p95,
                               &DistanceSummary::mean, &DistanceSummary::largest}) {
        row.push_back(found ? figure(unit * (*found).*value) : "-");
      }
    }
    table.add(std::move(row));
  }
  return table.text();
}

std::string volume_table(const EvaluationReport& report) {
  Table table({"volumes", "IoU", "+-", "mesh only", "reference only", "enclosed again"});
  std::string notes;
  for (const EvaluatedMesh& mesh : report.meshes) {
    if (!mesh.volume) {
      table.add({mesh.path, "-", "-", "-", "-", "-"});
      notes += fmt::format("{}: no volume IoU: {}\n", mesh.path, mesh.volume_undefined);
      continue;
    }
    const VolumeOverlap& found = *mesh.volume;
    const auto volume = [&found](std::int64_t count) {
      return fmt::format("{:.4g}", found.box_volume * (static_cast<double>(count) /
                                                       static_cast<double>(found.points)));
    };
    table.add({mesh.path, figure(found.iou()), figure(found.standard_error()),
               volume(found.in_mesh - found.in_both), volume(found.in_reference - found.in_both),
               volume(found.enclosed_again_by_mesh)});
  }
  return table.text() + notes;
}

std::string shape_table(const EvaluationReport& report) {
  Table table({"mesh", "triangles", "components", "volume", "area"});
  for (const EvaluatedMesh& mesh : report.meshes) {
    table.add({mesh.path, fmt::format("{}", mesh.surface.triangles),
               fmt::format("{} / {}", mesh.surface.components.size(), mesh.components_by_position),
               fmt::format("{:.6g}", mesh.surface.volume),
               fmt::format("{:.6g}", mesh.surface.area)});
  }
  return table.text();
}

std::string count_table(const EvaluationReport& report) {
  Table table({"mesh", "boundary edges", "nm edges", "nm vertices", "misoriented", "duplicates",
               "degenerate", "intersecting", "valid"});
  for (const EvaluatedMesh& mesh : report.meshes) {
    const auto both = [&](std::int64_t IncidenceCounts::*count) {
      return fmt::format("{} / {}", mesh.surface.by_index.*count, mesh.surface.by_position.*count);
    };
    table.add(
        {mesh.path, both(&IncidenceCounts::boundary_edges),
         both(&IncidenceCounts::nonmanifold_edges), both(&IncidenceCounts::nonmanifold_vertices),
         both(&IncidenceCounts::misoriented_edges), both(&IncidenceCounts::duplicate_faces),
         fmt::format("{}", mesh.surface.degenerate_faces),
         fmt::format("{}", mesh.surface.intersecting_pairs), mesh.surface.valid() ? "yes" : "no"});
  }
  return table.text();
}

std::string reference_line(const EvaluatedReference& reference) {
  if (!reference.surface) {
    return fmt::format("reference {}: {} points, {} normals; longest edge of its box {:.6g}\n",
                       reference.path, reference.points, reference.normals ? "with" : "without",
                       reference.unit);
  }
  const SurfaceReport& surface = *reference.surface;
  return fmt::format(
      "reference {}: {} triangles, {} components, volume {:.6g}, area {:.6g}; longest edge of "
      "its box {:.6g}\n",
      reference.path, surface.triangles, surface.components.size(), surface.volume, surface.area,
      reference.unit);
}

// ---- JSON ---------------------------------------------------------------------------------------

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

// `normals`: the mean cosine of the same samples.
Json one_way_json(const std::optional<DistanceSummary>& found, const std::optional<double>& normals,
                  double unit) {
  if (!found) return nullptr;
  const auto in = [&](double length) {
    return Json{{"median", length * found->median},
                {"p95", length * found->p95},
                {"mean", length * found->mean},
                {"max", length * found->largest},
                {"mean_square", length * length * found->mean_square}};
  };
  return {{"relative", in(1)}, {"input_units", in(unit)}, {"normals", or_null(normals)}};
}

Json distances_json(const Evaluation& found, double unit) {
  const auto to = [unit](const Agreement& kind) {
    return one_way_json(kind.to_reference, kind.normals_to_reference, unit);
  };
  const auto from = [unit](const Agreement& kind) {
    return one_way_json(kind.from_reference, kind.normals_from_reference, unit);
  };
  return {{"to_reference", to(found.sampled)},
          {"from_reference", from(found.sampled)},
          {"to_reference_p2s", to(found.to_surface)},
          {"from_reference_p2s", from(found.to_surface)}};
}

Json f1_json(const Evaluation& found, const std::vector<double>& thresholds) {
  Json list = Json::array();
  for (std::size_t k = 0; k < thresholds.size(); ++k) {
    const auto at = [k](const std::vector<double>& f1) {
      return f1.empty() ? Json(nullptr) : Json(f1[k]);
    };
    list.push_back({{"threshold", thresholds[k]},
                    {"f1", at(found.sampled.f1)},
                    {"f1_p2s", at(found.to_surface.f1)}});
  }
  return list;
}

// What is told of volumes: null without a value, and then why.
Json volume_json(const EvaluatedMesh& mesh) {
  if (!mesh.volume) return {{"value", nullptr}, {"undefined", mesh.volume_undefined}};
  const VolumeOverlap& found = *mesh.volume;
  return {{"value", or_null(found.iou())},
          {"undefined", found.iou() ? Json(nullptr) : Json("no point is in either solid")},
          {"standard_error", or_null(found.standard_error())},
          {"points", found.points},
          {"in_mesh", found.in_mesh},
          {"in_reference", found.in_reference},
          {"in_both", found.in_both},
          {"in_either", found.in_either},
          {"enclosed_again_by_mesh", found.enclosed_again_by_mesh},
          {"enclosed_again_by_reference", found.enclosed_again_by_reference},
          {"box_volume", found.box_volume}};
}

Json mesh_json(const EvaluatedMesh& mesh, const EvaluationReport& report) {
  const Agreement& sampled = mesh.evaluation.sampled;
  const Agreement& p2s = mesh.evaluation.to_surface;
  Json json{{"path", mesh.path},
            {"points", mesh.surface.points},
            {"triangles", mesh.surface.triangles},
            {"components", mesh.surface.components.size()},
            {"components_by_position", mesh.components_by_position},
            {"volume", mesh.surface.volume},
            {"area", mesh.surface.area},
            {"cd", or_null(sampled.chamfer)},
            {"hd", or_null(sampled.hausdorff)},
            {"anc", or_null(sampled.normal_consistency)},
            {"cd_p2s", or_null(p2s.chamfer)},
            {"hd_p2s", or_null(p2s.hausdorff)},
            {"anc_p2s", or_null(p2s.normal_consistency)},
            {"f1", f1_json(mesh.evaluation, report.options.thresholds)},
            {"distances", distances_json(mesh.evaluation, report.reference.unit)}};
  if (report.images) json["images"] = images_json(mesh.images);
  if (report.volume_points > 0) json["volume_iou"] = volume_json(mesh);
  if (report.counts) json["output"] = output_json(mesh.surface, mesh.path);
  return json;
}

Json reference_json(const EvaluatedReference& reference) {
  Json json{{"path", reference.path},
            {"kind", reference.surface ? "mesh" : "points"},
            {"unit", reference.unit},
            {"points", reference.points},
            {"normals", reference.normals}};
  if (reference.surface) {
    json["triangles"] = reference.surface->triangles;
    json["components"] = reference.surface->components.size();
    json["volume"] = reference.surface->volume;
    json["area"] = reference.surface->area;
  }
  return json;
}

}  // namespace

std::string Table::text() const {
  std::vector<std::size_t> widths(rows_[0].size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line = fmt::format("{:<{}}", row[0], widths[0]);
    for (std::size_t k = 1; k < row.size(); ++k) line += fmt::format("  {:>{}}", row[k], widths[k]);
    text += line + "\n";
  }
  return text;
}

std::string figure(const std::optional<double>& value) {
  return value ? fmt::format("{:.4g}", *value) : "-";
}

std::string evaluation_tables(const EvaluationReport& report) {
  std::string text = reference_line(report.reference);
  text += fmt::format("{} samples, seed {}; lengths relative to that edge, * in input units\n",
                      report.options.samples, report.options.seed);
  const auto add = [&text](const std::string& table) { text += fmt::format("\n{}", table); };
  add(agreement_table(report, "between samples", &Evaluation::sampled));
  if (report.reference.surface) {
    add(agreement_table(report, "to surface (p2s)", &Evaluation::to_surface));
    add(distance_table(report, "to reference (p2s)", &Agreement::to_reference,
                       &Evaluation::to_surface));
  } else {
    // Points have no surface to measure to.
    add(distance_table(report, "to reference (points)", &Agreement::to_reference,
                       &Evaluation::sampled));
  }
  add(distance_table(report, "from reference (p2s)", &Agreement::from_reference,
                     &Evaluation::to_surface));
  if (report.volume_points > 0) add(volume_table(report));
  if (report.images) add(image_table(report));
  text += "\ncounts by index / after points of equal coordinates are merged\n";
  text += shape_table(report);
  if (report.counts) add(count_table(report));
  return text;
}

nlohmann::ordered_json evaluation_json(const EvaluationReport& report) {
  Json meshes = Json::array();
  for (const EvaluatedMesh& mesh : report.meshes) meshes.push_back(mesh_json(mesh, report));
  return {{"version", kCellocutVersion},
          {"parameters",
           {{"samples", report.options.samples},
            {"seed", report.options.seed},
            {"thresholds", report.options.thresholds},
            {"volume_points", report.volume_points},
            {"images", image_work_json(report.images.get())}}},
          {"reference", reference_json(report.reference)},
          {"meshes", meshes}};
}

}  // namespace cellocut::tools
