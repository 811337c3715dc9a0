// cellocut list: what is built and why the rest is not.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "backends/backends.h"
#include "solvers/solvers.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/session.h"
#include "web/viewer.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

template <class Interface, class Describe>
Json describe(const std::vector<Variant<Interface>>& table, const Describe& add_details) {
  Json rows = Json::array();
  for (const Variant<Interface>& variant : table) {
    Json row{{"name", variant.name}, {"built", variant.make != nullptr}};
    if (variant.make == nullptr) {
      row["reason"] = variant.not_built;
    } else {
      const auto made = variant.make();
      row["summary"] = made->info().summary;
      row["licence"] = made->info().licence;
      row["reference"] = made->info().reference;
      add_details(row, made->info());
    }
    rows.push_back(row);
  }
  return rows;
}

void print_rows(const char* title, const Json& rows) {
  fmt::print("{}\n", title);
  for (const Json& row : rows) {
    const std::string name = row["name"];
    if (!row["built"].get<bool>()) {
      fmt::print("  {:<16} not built: {}\n", name, row["reason"].get<std::string>());
      continue;
    }
    std::string kind;
    if (row.contains("exact")) {
      kind = row["exact"].get<bool>() ? "exact" : "relaxation";
      if (row["outside"].get<bool>()) kind += ", reference";
      kind = " [" + kind + "]";
    }
    fmt::print("  {:<16} {}{}\n  {:<16} licence {}; {}\n", name, row["summary"].get<std::string>(),
               kind, "", row["licence"].get<std::string>(), row["reference"].get<std::string>());
  }
}

// What of the page of `compare --html` is built.
Json describe_report() {
  const web::Viewer& viewer = web::viewer();
  Json row{{"name", "3D view"}, {"built", viewer.built()}};
  if (viewer.built()) {
    row["summary"] = viewer.library;
    row["licence"] = viewer.licence;
  } else {
    row["reason"] = viewer.not_built;
  }
  return Json::array({row});
}

void print_report(const Json& rows) {
  fmt::print("report\n");
  for (const Json& row : rows) {
    const std::string what =
        row["built"].get<bool>()
            ? row["summary"].get<std::string>() + ", " + row["licence"].get<std::string>()
            : "not built in: " + row["reason"].get<std::string>() +
                  "; compare --html leaves it out";
    fmt::print("  {:<16} {}\n", row["name"].get<std::string>(), what);
  }
}

}  // namespace

Command add_list(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "list", "Backends and solvers: built or why not, exact or not, licence, reference");
  auto common = std::make_shared<CommonOptions>();
  common->add_to(*app);
  const auto run = [common] {
    const Json report{
        {"backends", describe(backends::registered(), [](Json&, const TetrahedralizerInfo&) {})},
        {"solvers", describe(solvers::registered(),
                             [](Json& row, const SolverInfo& info) {
                               row["exact"] = info.exact;
                               row["outside"] = info.outside;
                               row["capacity_limit"] = info.capacity_limit;
                             })},
        {"report", describe_report()}};
    if (!common->json.empty()) write_text(common->json, report.dump(2) + "\n");
    if (common->json != "-") {
      print_rows("tetrahedralization backends", report["backends"]);
      print_rows("minimum-cut solvers", report["solvers"]);
      print_report(report["report"]);
    }
    return static_cast<int>(kDone);
  };
  return {app, run, {}};
}

}  // namespace cellocut::tools
