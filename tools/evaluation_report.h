// What `cellocut evaluate` found, as tables and as JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cellocut/image/image_evaluation.h"
#include "cellocut/measure/evaluation.h"
#include "cellocut/measure/volume_overlap.h"
#include "cellocut/validity/surface_report.h"
#include "tools/image_arguments.h"

namespace cellocut::tools {

struct EvaluatedReference {
  std::string path;
  double unit = 1;                       // input units: the longest edge of its box
  std::size_t points = 0;                // of the file
  bool normals = true;                   // of a point cloud
  std::optional<SurfaceReport> surface;  // a mesh; absent for a point cloud
};

struct EvaluatedMesh {
  std::string path;
  Evaluation evaluation;
  SurfaceReport surface;
  std::int64_t components_by_position = 0;
  std::optional<VolumeOverlap> volume;     // with the reference
  std::string volume_undefined;            // why there is none; empty where nobody asked
  std::optional<ImageAgreement> images{};  // absent for a reference of points
};

struct EvaluationReport {
  EvaluationOptions options;
  std::size_t volume_points = 0;  // 0: volumes were not compared
  EvaluatedReference reference;
  std::vector<EvaluatedMesh> meshes;
  std::shared_ptr<const ImageWork> images{};  // null: pictures were not compared
  bool counts = true;  // whether the meshes were tested for intersections, and the counts are told
};

// Columns as wide as their widest entry: the first to the left, the others to the right.
class Table {
 public:
  explicit Table(std::vector<std::string> heads) : rows_{std::move(heads)} {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

// Four digits; "-" where there is nothing.
std::string figure(const std::optional<double>& value);

// Tables with a row for each mesh: between samples, to the surface, distances, volumes, counts.
std::string evaluation_tables(const EvaluationReport& report);
// The keys are stable: added to, never renamed. What is absent is null.
nlohmann::ordered_json evaluation_json(const EvaluationReport& report);

}  // namespace cellocut::tools
