// cellocut render: six canonical views of a mesh as PNG files.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cellocut/base/errors.h"
#include "cellocut/image/map_pixels.h"
#include "cellocut/image/png_file.h"
#include "cellocut_version.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/session.h"
#include "tools/view_arguments.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

struct RenderArguments {
  CommonOptions common;
  ViewArguments view;
  std::string mesh;
  std::string format;
  std::string reference;
  std::string folder;
  bool depth = false;
  bool normals = false;
};

struct Picture {
  std::string path;
  std::string bytes;
};

// The pictures' paths, in the order of the views.
struct ViewPaths {
  std::string view;
  std::string clay;
  std::string depth;    // empty: not asked for
  std::string normals;  // empty: not asked for
};

std::vector<ViewPaths> paths_of(const RenderArguments& a, const RenderOptions& options) {
  std::vector<ViewPaths> paths;
  const std::filesystem::path folder(a.folder);
  for (const Camera& camera : canonical_views(options.up, options.perspective)) {
    ViewPaths view{.view = camera.name,
                   .clay = (folder / (camera.name + ".png")).string(),
                   .depth = {},
                   .normals = {}};
    if (a.depth) view.depth = (folder / (camera.name + "_depth.png")).string();
    if (a.normals) view.normals = (folder / (camera.name + "_normal.png")).string();
    paths.push_back(std::move(view));
  }
  return paths;
}

ViewFrame frame_of_file(const std::string& path, const TriangleSoup& mesh) {
  try {
    return view_frame(mesh);
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  }
}

void encode(const View& view, const ViewPaths& paths, std::vector<Picture>& pictures) {
  const int n = view.resolution;
  pictures.push_back({paths.clay, encode_png(view.clay, n, n)});
  if (!paths.depth.empty()) {
    pictures.push_back({paths.depth, encode_png(depth_pixels(view), n, n)});
  }
  if (!paths.normals.empty()) {
    pictures.push_back({paths.normals, encode_png(normal_pixels(view), n, n)});
  }
}

Json path_or_null(const std::string& path) { return path.empty() ? Json() : Json(path); }

Json report_json(const RenderArguments& a, const RenderOptions& options, const ViewFrame& frame,
                 const std::vector<ViewPaths>& paths) {
  Json report{{"version", kCellocutVersion},
              {"input", {{"path", a.mesh}}},
              {"reference", path_or_null(a.reference)},
              {"frame", {{"centre", frame.centre}, {"unit", frame.unit}}},
              {"parameters",
               {{"resolution", options.resolution},
                {"perspective", options.perspective},
                {"up", a.view.up},
                {"antialiasing", options.antialiasing}}}};
  const auto cameras = canonical_views(options.up, options.perspective);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    report["views"].push_back({{"name", paths[k].view},
                               {"right", cameras[k].right},
                               {"up", cameras[k].up},
                               {"towards_viewer", cameras[k].back},
                               {"clay", paths[k].clay},
                               {"depth", path_or_null(paths[k].depth)},
                               {"normals", path_or_null(paths[k].normals)}});
  }
  return report;
}

int run_render(const RenderArguments& a) {
  const RenderOptions options = a.view.parsed();
  if (a.folder.empty()) throw UsageError("--output must name a folder");
  std::error_code error;
  std::filesystem::create_directories(a.folder, error);
  if (error) throw UsageError(a.folder + ": cannot make the folder: " + error.message());
  const std::vector<ViewPaths> paths = paths_of(a, options);
  std::vector<std::string> outputs{a.common.json};
  for (const ViewPaths& view : paths) {
    for (const auto& path : {view.clay, view.depth, view.normals}) outputs.push_back(path);
  }
  require_writable(outputs, {a.mesh, a.reference});
  const ThreadLimit limit(a.common.threads);
  TerminalObserver observer(a.common);

  observer.stage("read");
  const TriangleSoup mesh = read_input(a.mesh, a.format);
  const ViewFrame frame = a.reference.empty() ? frame_of_file(a.mesh, mesh)
                                              : frame_of_file(a.reference, read_input(a.reference));
  const RayScene scene(mesh, frame);
  std::vector<Picture> pictures;
  pictures.reserve(3 * paths.size());
  const auto cameras = canonical_views(options.up, options.perspective);
  for (std::size_t k = 0; k < paths.size(); ++k) {
    observer.stage(cameras[k].name);
    encode(render_view(scene, cameras[k], options, observer), paths[k], pictures);
  }
  observer.clear();
  for (const Picture& picture : pictures) write_text(picture.path, picture.bytes);
  if (!a.common.json.empty()) {
    write_text(a.common.json, report_json(a, options, frame, paths).dump(2) + "\n");
  }
  if (!a.common.quiet && a.common.json != "-") {
    for (const Picture& picture : pictures) fmt::print("{}\n", picture.path);
  }
  return kDone;
}

}  // namespace

Command add_render(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "render",
      "Six canonical clay views of a mesh as PNG files, by ray casting: from +x, -x, +y, -y, +z, "
      "-z (posx.png, negx.png, ...). The camera looks at the centre of the mesh's bounding box, "
      "whose "
      "longest edge fills the picture but for a margin of 5 % on either side; lights and material "
      "are the same for every mesh. The back of a face is red, so that holes, sheets and flipped "
      "faces show");
  auto arguments = std::make_shared<RenderArguments>();
  RenderArguments& a = *arguments;
  app->add_option("mesh", a.mesh, "Mesh: .obj .off .ply .stl, or '-'")->required();
  app->add_option("--format", a.format, "Format of the mesh: obj, off, ply, stl");
  app->add_option("-o,--output", a.folder, "Folder for the pictures; made where it is not there")
      ->required();
  app->add_option("--reference", a.reference,
                  "A mesh whose bounding box places the camera instead: two meshes drawn with the "
                  "same reference are seen by the same camera");
  a.view.add_to(*app, "");
  app->add_flag(
      "--depth", a.depth,
      "Also posx_depth.png and so on, 16-bit grey: 0 where nothing is seen, 32768 at the "
      "depth of the box's centre, larger further away, a step 1/32767 of the longest edge");
  app->add_flag("--normals", a.normals,
                "Also posx_normal.png and so on, 8-bit: black where nothing is seen; red, green, "
                "blue are 255 (n + 1) / 2 of the normal to the right, up and towards the viewer, "
                "turned to the side that is seen");
  a.common.add_to(*app);
  return {app, [arguments] { return run_render(*arguments); },
          [arguments] { return arguments->mesh; }};
}

}  // namespace cellocut::tools
