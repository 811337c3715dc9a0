#include "tools/evaluate_pairs.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cellocut/base/atomic_file.h"
#include "cellocut_version.h"
#include "tools/exit_code.h"
#include "tools/image_report.h"
#include "tools/pair_list.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

// Rows that are printed one at a time: the widths are known before.
class PairTable {
 public:
  PairTable(const std::vector<FilePair>& pairs, const EvaluationWork& work)
      : images_(work.images != nullptr), heads_{"CD",     "HD",      "ANC", "CD p2s",
                                                "HD p2s", "ANC p2s", "IoU"} {
    for (const double t : work.options.thresholds) heads_.push_back(fmt::format("F1@{}", t));
    if (images_) {
      for (std::string& head : image_heads()) heads_.push_back(std::move(head));
    }
    for (const FilePair& pair : pairs) {
      mesh_ = std::max(mesh_, pair.mesh.size());
      reference_ = std::max(reference_, pair.reference.size());
    }
  }

  void print_heads() const { print("mesh", "reference", heads_); }

  void print_row(const FilePair& pair, const EvaluatedMesh& mesh) const {
    const Agreement& sampled = mesh.evaluation.sampled;
    const Agreement& p2s = mesh.evaluation.to_surface;
    std::vector<std::string> row;
    for (const auto& value :
         {sampled.chamfer, sampled.hausdorff, sampled.normal_consistency, p2s.chamfer,
          p2s.hausdorff, p2s.normal_consistency, mesh.volume ? mesh.volume->iou() : std::nullopt}) {
      row.push_back(figure(value));
    }
    for (const double f1 : sampled.f1) row.push_back(fmt::format("{:.2f}", f1));
    if (images_) {
      for (std::string& cell : image_cells(mesh.images)) row.push_back(std::move(cell));
    }
    print(pair.mesh, pair.reference, row);
  }

  void print_failure(const FilePair& pair) const { print(pair.mesh, pair.reference, {"failed"}); }

 private:
  void print(const std::string& mesh, const std::string& reference,
             const std::vector<std::string>& cells) const {
    std::string line = fmt::format("{:<{}}  {:<{}}", mesh, mesh_, reference, reference_);
    for (const std::string& cell : cells) line += fmt::format("  {:>9}", cell);
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }

  bool images_;
  std::vector<std::string> heads_;
  std::size_t mesh_ = 4;
  std::size_t reference_ = 9;
};

// The report, written a pair at a time: a list of thousands takes no memory.
class PairsJson {
 public:
  explicit PairsJson(const std::string& path) {
    if (path.empty()) return;
    file_.emplace(path);
    file_->write(
        fmt::format("{{\n  \"version\": {},\n  \"pairs\": [", Json(kCellocutVersion).dump()));
  }

  void add(const FilePair& pair, const Json& evaluation, const ErrorLine* error) {
    if (!file_) return;
    const Json json{{"line", pair.line},
                    {"mesh", pair.mesh},
                    {"reference", pair.reference},
                    {"error", error != nullptr ? Json(error->text) : Json(nullptr)},
                    {"exit_code", error != nullptr ? static_cast<int>(error->code) : 0},
                    {"evaluation", evaluation}};
    std::string text = json.dump(2);
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
      text.insert(at + 1, "    ");
    }
    file_->write((first_ ? "\n    " : ",\n    ") + text);
    first_ = false;
  }

  void finish(std::size_t done, std::size_t failed, const ImageWork* images,
              const std::optional<Fid>& fid) {
    if (!file_) return;
    file_->write(
        fmt::format("\n  ],\n  \"counts\": {{\"pairs\": {}, \"done\": {}, \"failed\": {}}}",
                    done + failed, done, failed));
    if (images != nullptr) file_->write(",\n  \"fid\": " + fid_json(fid).dump());
    file_->write("\n}\n");
    file_->commit();
  }

 private:
  std::optional<AtomicFile> file_;
  bool first_ = true;
};

}  // namespace

int evaluate_pairs(const std::string& list, const EvaluationWork& work,
                   const CommonOptions& common) {
  const std::vector<FilePair> pairs = read_pairs(list);
  TerminalObserver observer(common);
  PairsJson json(common.json);
  const bool prints = !common.quiet && common.json != "-";
  const PairTable table(pairs, work);
  if (prints) table.print_heads();
  std::unique_ptr<Reference> reference;  // of the last pair: lists often go reference by reference
  std::optional<ErrorLine> first_error;
  std::size_t failed = 0;
  FidPool pool;
  for (const FilePair& pair : pairs) {
    try {
      observer.stage(pair.reference_path);
      if (!reference || reference->path() != pair.reference_path) {
        reference.reset();
        reference = std::make_unique<Reference>(pair.reference_path, work, observer);
      }
      EvaluationReport report = reference->report();
      report.meshes.push_back(reference->evaluate(pair.mesh_path, {}, observer));
      observer.clear();
      if (report.meshes.front().images) pool.add(*report.meshes.front().images);
      json.add(pair, evaluation_json(report), nullptr);
      if (prints) table.print_row(pair, report.meshes.front());
    } catch (const Cancelled&) {
      throw;
    } catch (const OutputError&) {
      throw;  // of the report itself: nothing else is written
    } catch (const std::exception& error) {
      ++failed;
      const ErrorLine line = describe_error(error, pair.mesh_path);
      observer.clear();
      print_error(fmt::format("{}: line {}: {}", list, pair.line, line.text));
      json.add(pair, nullptr, &line);
      if (prints) table.print_failure(pair);
      if (!first_error) first_error = line;
    }
  }
  const std::optional<Fid> fid = pool.distance();
  json.finish(pairs.size() - failed, failed, work.images.get(), fid);
  if (prints)
    fmt::print("{} pairs, {} done, {} failed\n", pairs.size(), pairs.size() - failed, failed);
  if (prints && work.images) fmt::print("{}", image_lines(*work.images, fid));
  return first_error ? first_error->code : kDone;
}

}  // namespace cellocut::tools
