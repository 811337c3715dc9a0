// cellocut damage: a watertight model with the holes that scanners leave.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>

#include "cellocut/damage/damage.h"
#include "cellocut_version.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/session.h"

namespace cellocut::tools {

namespace {

struct DamageArguments {
  CommonOptions common;
  DamageOptions options;
  std::string mesh;
  std::string format;
  std::string output;
  std::string output_format;
  std::string holes = "6..12";
};

// "6..12", or "8" for exactly eight.
void set_holes(const std::string& text, DamageOptions& options) {
  const auto number = [&text](std::string_view word) {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      throw UsageError("--holes: '" + text + "' is neither a number nor MIN..MAX");
    }
    return value;
  };
  const std::string_view whole = text;
  const std::size_t dots = whole.find("..");
  options.fewest = number(whole.substr(0, dots));
  options.most = dots == std::string_view::npos ? options.fewest : number(whole.substr(dots + 2));
}

nlohmann::ordered_json damage_json(const DamageArguments& a, const TriangleSoup& model,
                                   const Damage& damage) {
  nlohmann::ordered_json holes = nlohmann::ordered_json::array();
  double area = 0;
  double share = 0;
  for (const Hole& hole : damage.holes) {
    area += hole.area;
    share += hole.share;
    holes.push_back({{"kind", to_string(hole.kind)},
                     {"centre", hole.centre},
                     {"area", hole.area},
                     {"share", hole.share},
                     {"length", hole.length},
                     {"width", hole.width},
                     {"faces", hole.faces.size()},
                     {"boundary_edges", hole.boundary.size()}});
  }
  return {
      {"version", kCellocutVersion},
      {"input",
       {{"path", a.mesh}, {"points", model.points.size()}, {"triangles", model.triangles.size()}}},
      {"parameters",
       {{"seed", a.options.seed},
        {"holes", {a.options.fewest, a.options.most}},
        {"size", a.options.size}}},
      {"holes", holes},
      {"area", area},
      {"share", share},
      {"output",
       {{"path", a.output},
        {"points", damage.mesh.points.size()},
        {"triangles", damage.mesh.triangles.size()}}}};
}

void print_holes(const Damage& damage) {
  fmt::print("{:<8}  {:>8}  {:>10}  {:>10}  {:>6}  {:>14}\n", "hole", "% area", "length", "width",
             "faces", "boundary edges");
  for (const Hole& hole : damage.holes) {
    fmt::print("{:<8}  {:>8.3f}  {:>10.4g}  {:>10.4g}  {:>6}  {:>14}\n", to_string(hole.kind),
               100 * hole.share, hole.length, hole.width, hole.faces.size(), hole.boundary.size());
  }
}

int run_damage(DamageArguments& a) {
  set_holes(a.holes, a.options);
  a.options.validate();
  const std::optional<MeshFormat> format =
      a.output_format.empty() ? format_of_path(a.output) : format_of_name(a.output_format);
  if (!format) throw UsageError(a.output + ": cannot tell the mesh format; give --output-format");
  require_writable({a.output, a.common.json}, {a.mesh});
  const ThreadLimit limit(a.common.threads);
  TerminalObserver observer(a.common);
  observer.stage("read");
  const TriangleSoup model = read_input(a.mesh, a.format);
  observer.stage("holes");
  const Damage damage = damage_mesh(model, a.options, observer);
  observer.clear();
  write_mesh(damage.mesh, a.output, *format);
  if (!a.common.json.empty()) {
    write_text(a.common.json, damage_json(a, model, damage).dump(2) + "\n");
  }
  if (!a.common.quiet && a.output != "-" && a.common.json != "-") print_holes(damage);
  return kDone;
}

}  // namespace

Command add_damage(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "damage",
      "Holes as scanners leave them, cut into a watertight model: patches at a grazing angle, "
      "elongated gaps, scan stripes. Whole faces go, the others stay as they are");
  auto arguments = std::make_shared<DamageArguments>();
  DamageArguments& a = *arguments;
  app->add_option("mesh", a.mesh, "Closed, manifold mesh: .obj .off .ply .stl, or '-'")->required();
  app->add_option("--format", a.format, "Format of the mesh: obj, off, ply, stl");
  app->add_option("-o,--output", a.output, "Damaged mesh: .obj .off .ply .stl, or '-'")->required();
  app->add_option("--output-format", a.output_format,
                  "Format of the output: obj, off, ply, ply-ascii, stl, stl-ascii");
  app->add_option("--seed", a.options.seed, "The same seed gives the same bytes")
      ->capture_default_str();
  app->add_option("--holes", a.holes, "How many: MIN..MAX, or a number")->capture_default_str();
  app->add_option("--size", a.options.size, "Factor on the lengths of the holes, 0.01 to 3")
      ->capture_default_str();
  a.common.add_to(*app);
  return {app, [arguments] { return run_damage(*arguments); },
          [arguments] { return arguments->mesh; }};
}

}  // namespace cellocut::tools
