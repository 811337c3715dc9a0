#include "tools/image_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

struct Column {
  const char* key;
  const char* head;
  std::optional<double> ImageMeasures::*measure;
};
constexpr std::array<Column, 6> kColumns{
    {{"silhouette_iou", "silh. IoU", &ImageMeasures::silhouette_iou},
     {"depth_error", "depth", &ImageMeasures::depth_error},
     {"normal_error", "normal", &ImageMeasures::normal_error},
     {"ms_ssim", "MS-SSIM", &ImageMeasures::ms_ssim},
     {"lpips", "LPIPS", &ImageMeasures::lpips},
     {"clip", "CLIP", &ImageMeasures::clip}}};

Json value_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json measures_json(const ImageMeasures& measures) {
  Json json = Json::object();
  for (const Column& column : kColumns) json[column.key] = value_or_null(measures.*column.measure);
  return json;
}

}  // namespace

void FidPool::add(const ImageAgreement& pair) {
  for (const auto& feature : pair.features) meshes_.add(feature);
  for (const auto& feature : pair.reference_features) references_.add(feature);
}

std::optional<Fid> FidPool::distance() const {
  if (meshes_.size() < 2 || references_.size() < 2) return std::nullopt;
  return Fid{.value = frechet_distance(meshes_, references_),
             .samples = meshes_.size(),
             .dimensions = meshes_.dimensions()};
}

std::optional<Fid> fid_of(const ImageAgreement& pair) {
  FidPool pool;
  pool.add(pair);
  return pool.distance();
}

std::string fid_warning(const Fid& fid) {
  if (fid.samples >= fid.dimensions) return {};
  return fmt::format(
      "{} samples are fewer than {} dimensions: it compares only with FID of as many samples",
      fid.samples, fid.dimensions);
}

std::string image_lines(const ImageWork& work, const std::optional<Fid>& fid) {
  std::string lines;
  for (const EmptyColumn& column : work.empty) {
    std::string name = column.measure;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    lines += fmt::format("{} is left empty: {}\n", name, column.reason);
  }
  if (fid) {
    lines += fmt::format("FID {:.4g} over {} pictures each\n", fid->value, fid->samples);
    const std::string warning = fid_warning(*fid);
    if (!warning.empty()) lines += "FID: " + warning + "\n";
  }
  return lines;
}

std::vector<std::string> image_heads() {
  std::vector<std::string> heads;
  heads.reserve(kColumns.size());
  for (const Column& column : kColumns) heads.emplace_back(column.head);
  return heads;
}

std::vector<std::string> image_cells(const std::optional<ImageAgreement>& images) {
  std::vector<std::string> cells;
  cells.reserve(kColumns.size());
  for (const Column& column : kColumns) {
    cells.push_back(figure(images ? images->mean.*column.measure : std::nullopt));
  }
  return cells;
}

std::string image_table(const EvaluationReport& report) {
  std::vector<std::string> heads = image_heads();
  heads.insert(heads.begin(), "pictures");
  heads.emplace_back("FID");
  Table table(std::move(heads));
  std::string warning;
  for (const EvaluatedMesh& mesh : report.meshes) {
    std::vector<std::string> row = image_cells(mesh.images);
    row.insert(row.begin(), mesh.path);
    const std::optional<Fid> fid = mesh.images ? fid_of(*mesh.images) : std::nullopt;
    row.push_back(figure(fid ? std::optional(fid->value) : std::nullopt));
    table.add(std::move(row));
    if (fid) warning = fid_warning(*fid);
  }
  std::string text = table.text() + image_lines(*report.images, std::nullopt);
  if (!warning.empty()) text += "FID: " + warning + "\n";
  if (!report.reference.surface) text += "the reference is a set of points: no pictures\n";
  return text;
}

Json fid_json(const std::optional<Fid>& fid) {
  if (!fid) return {};
  const std::string warning = fid_warning(*fid);
  return {{"value", fid->value},
          {"samples", fid->samples},
          {"dimensions", fid->dimensions},
          {"warning", warning.empty() ? Json() : Json(warning)}};
}

Json images_json(const std::optional<ImageAgreement>& images) {
  if (!images) return {};
  Json views = Json::array();
  for (std::size_t k = 0; k < images->views.size(); ++k) {
    Json view{{"name", images->names[k]}};
    view.update(measures_json(images->views[k]));
    views.push_back(std::move(view));
  }
  return {{"mean", measures_json(images->mean)},
          {"ms_ssim_scales", images->ms_ssim_scales},
          {"fid", fid_json(fid_of(*images))},
          {"views", views}};
}

Json image_work_json(const ImageWork* work) {
  if (work == nullptr) return {};
  Json networks = Json::array();
  for (const NamedNetwork& network : work->read) {
    networks.push_back({{"measure", network.measure},
                        {"path", network.path},
                        {"size", network.input.size},
                        {"mean", network.input.mean},
                        {"std", network.input.deviation},
                        {"order", network.input.bgr ? "bgr" : "rgb"},
                        {"outputs", network.input.outputs}});
  }
  Json empty = Json::object();
  for (const EmptyColumn& column : work->empty) empty[column.measure] = column.reason;
  return {{"resolution", work->options.resolution},
          {"perspective", work->options.perspective},
          {"up", work->up},
          {"antialiasing", work->options.antialiasing},
          {"networks", networks},
          {"empty", empty}};
}

}  // namespace cellocut::tools
