// A reference and what meshes are compared with it by.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "cellocut/mesh/point_cloud.h"
#include "tools/evaluation_report.h"
#include "tools/session.h"

namespace cellocut::tools {

struct EvaluationWork {
  EvaluationOptions options;
  std::size_t volume_points = 1'000'000;      // 0: volumes are not compared
  bool counts = true;                         // test meshes for intersections
  std::shared_ptr<const ImageWork> images{};  // null: pictures are not compared

  // Errors: UsageError.
  void validate() const;
};

class Reference {
 public:
  // Errors: InputError about the file; UsageError where it is standard input; Cancelled.
  Reference(std::string path, const EvaluationWork& work, const Observer& observer);

  [[nodiscard]] const std::string& path() const { return description_.path; }

  // Errors: as read_input() and Evaluator, about the file; Cancelled.
  [[nodiscard]] EvaluatedMesh evaluate(const std::string& path, const std::string& format,
                                       TerminalObserver& observer) const;

  // A report with no meshes yet.
  [[nodiscard]] EvaluationReport report() const;

 private:
  void compare_volumes(const TriangleSoup& mesh, EvaluatedMesh& result,
                       const TerminalObserver& observer) const;

  EvaluationWork work_;
  EvaluatedReference description_;
  std::optional<Evaluator> evaluator_;
  std::optional<ImageEvaluator> images_;  // a mesh, where pictures are compared
  std::optional<InsideTest> inside_;      // a mesh, where volumes are compared
};

}  // namespace cellocut::tools
