// What `cellocut evaluate` found, as tables and as JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cellocut/measure/evaluation.h"
#include "cellocut/validity/surface_report.h"

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
};

struct EvaluationReport {
  EvaluationOptions options;
  EvaluatedReference reference;
  std::vector<EvaluatedMesh> meshes;
  bool counts = true;  // whether the meshes were tested for intersections, and the counts are told
};

// Four tables with a row for each mesh: between samples, to the surface, distances, counts.
std::string evaluation_tables(const EvaluationReport& report);
// The keys are stable: added to, never renamed. What is absent is null.
nlohmann::ordered_json evaluation_json(const EvaluationReport& report);

}  // namespace cellocut::tools
