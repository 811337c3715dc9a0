#include "tools/reference.h"

#include <fmt/core.h>

#include <filesystem>
#include <utility>

#include "cellocut/validity/position_merge.h"

namespace cellocut::tools {

namespace {

// Gives errors that know no file the one that the work is about.
template <class Work>
auto about(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(error.what(), error.file().empty() ? path : error.file());
  }
}

std::variant<TriangleSoup, PointCloud> read_reference(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) throw InputError("is a directory", path);
  if (path == "-") throw UsageError("--reference must be a file");
  return read_mesh_or_cloud(path);
}

// The pieces that are left when points with equal coordinates are one.
std::int64_t components_by_position(const TriangleSoup& mesh) {
  TriangleSoup merged = mesh;
  const std::vector<std::uint32_t> first = merge_equal_positions(mesh.points);
  for (Triangle& t : merged.triangles) {
    for (std::uint32_t& corner : t) corner = first[corner];
  }
  const SurfaceReport report = inspect_surface(merged, SurfaceCheckOptions{.intersections = false});
  return static_cast<std::int64_t>(report.components.size());
}

EvaluatedReference describe(std::string path,
                            const std::variant<TriangleSoup, PointCloud>& reference, double unit) {
  EvaluatedReference result{.path = std::move(path), .unit = unit, .surface = {}};
  if (const auto* cloud = std::get_if<PointCloud>(&reference)) {
    result.points = cloud->points.size();
    result.normals = !cloud->normals.empty();
  } else {
    const auto& soup = std::get<TriangleSoup>(reference);
    result.points = soup.points.size();
    result.surface = inspect_surface(soup, SurfaceCheckOptions{.intersections = false});
  }
  return result;
}

// Why a surface bounds no volume.
std::string open_edges(const char* which, const InsideTest& solid) {
  return fmt::format("the {} is not closed ({} edges with an odd number of faces)", which,
                     solid.odd_edges());
}

}  // namespace

void EvaluationWork::validate() const {
  options.validate();
  constexpr std::size_t kMostPoints = 1'000'000'000;
  if (volume_points > kMostPoints) {
    throw UsageError(fmt::format("volume points must be 0 to {}", kMostPoints));
  }
}

Reference::Reference(std::string path, const EvaluationWork& work, const Observer& observer)
    : work_(work) {
  const auto shape = read_reference(path);
  about(path, [&] {
    std::visit([&](const auto& s) { evaluator_.emplace(s, work.options); }, shape);
    if (work.volume_points > 0) {
      if (const auto* soup = std::get_if<TriangleSoup>(&shape)) inside_.emplace(*soup);
    }
    if (work.images) {
      if (const auto* soup = std::get_if<TriangleSoup>(&shape)) {
        images_.emplace(*soup, work.images->options, work.images->networks, observer);
      }
    }
  });
  description_ = describe(std::move(path), shape, evaluator_->unit());
}

EvaluationReport Reference::report() const {
  return {.options = work_.options,
          .volume_points = work_.volume_points,
          .reference = description_,
          .meshes = {},
          .images = work_.images,
          .counts = work_.counts};
}

void Reference::compare_volumes(const TriangleSoup& mesh, EvaluatedMesh& result,
                                const TerminalObserver& observer) const {
  if (work_.volume_points == 0) return;
  if (!inside_) {
    result.volume_undefined = "the reference is a set of points";
    return;
  }
  if (!inside_->closed()) {
    result.volume_undefined = open_edges("reference", *inside_);
    return;
  }
  const InsideTest inside(mesh);
  if (!inside.closed()) {
    result.volume_undefined = open_edges("mesh", inside);
    return;
  }
  result.volume =
      measure_volume_overlap(inside, *inside_, work_.volume_points, work_.options.seed, observer);
}

EvaluatedMesh Reference::evaluate(const std::string& path, const std::string& format,
                                  TerminalObserver& observer) const {
  observer.stage(path);
  return about(path, [&] {
    const TriangleSoup mesh = read_input(path, format);
    EvaluatedMesh result{
        .path = path, .evaluation = {}, .surface = {}, .volume = {}, .volume_undefined = {}};
    result.evaluation = (*evaluator_)(mesh, observer);
    result.surface = inspect_surface(
        mesh, SurfaceCheckOptions{.intersections = work_.counts, .observer = &observer});
    result.components_by_position = components_by_position(mesh);
    compare_volumes(mesh, result, observer);
    if (images_) result.images = (*images_)(mesh, observer);
    return result;
  });
}

}  // namespace cellocut::tools
