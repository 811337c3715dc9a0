// What the comparison of pictures found, as cells of tables and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cellocut/image/frechet.h"
#include "cellocut/image/image_evaluation.h"
#include "tools/evaluation_report.h"
#include "tools/image_arguments.h"

namespace cellocut::tools {

// The Frechet distance between two sets of as many pictures.
struct Fid {
  double value = 0;
  std::size_t samples = 0;  // pictures in each set
  std::size_t dimensions = 0;
};

// The pictures of any number of pairs.
class FidPool {
 public:
  // Errors: as FeatureSamples.
  void add(const ImageAgreement& pair);
  // Nothing where there were no features. O(samples^2 dimensions), at most O(dimensions^3).
  [[nodiscard]] std::optional<Fid> distance() const;

 private:
  FeatureSamples meshes_;
  FeatureSamples references_;
};

// That of one pair alone: six pictures each.
std::optional<Fid> fid_of(const ImageAgreement& pair);

// Empty where there are as many samples as dimensions.
std::string fid_warning(const Fid& fid);
// What is left empty and why, and the FID of many pairs with its warning, a line each.
std::string image_lines(const ImageWork& work, const std::optional<Fid>& fid);

std::vector<std::string> image_heads();  // of the columns, without FID
std::vector<std::string> image_cells(const std::optional<ImageAgreement>& images);

// A row for each mesh, FID over its six pictures, and the lines of image_lines().
std::string image_table(const EvaluationReport& report);

// {"mean": {...}, "ms_ssim_scales", "fid", "views": [{"name", ...}]}; null for nothing.
nlohmann::ordered_json images_json(const std::optional<ImageAgreement>& images);
// {"value", "samples", "dimensions", "warning"}; null for nothing.
nlohmann::ordered_json fid_json(const std::optional<Fid>& fid);
// {"resolution", ..., "networks": [...], "empty": {measure: reason}}; null for nothing.
nlohmann::ordered_json image_work_json(const ImageWork* work);

}  // namespace cellocut::tools
