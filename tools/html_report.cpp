#include "tools/html_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/html_parts.h"
#include "web/viewer.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::ordered_json;

// A path that is not UTF-8 shows a sign in place of each wrong byte, here as in browsers.
std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// As the content of a script element, which nothing but "</script" and "<!--" can end.
std::string script_json(const Json& json) {
  std::string text;
  for (const char c : dump(json)) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : dump(value);
}

std::string file_name(const Json& instance) {
  return std::filesystem::path(instance["input"].get<std::string>()).filename().string();
}

std::string title_of(const Json& instance) {
  const std::string backend = instance["backend"];
  return file_name(instance) + (backend.empty() ? "" : " on " + backend);
}

bool is_solved(const Json& run) { return run["status"] != "refused"; }

double median_of(const Json& run, const char* key) { return run[key]["median"].get<double>(); }

std::string seconds_text(double seconds) {
  return seconds < 1 ? fmt::format("{:.2f} ms", 1000 * seconds) : fmt::format("{:.3f} s", seconds);
}

// A cell with its number exactly.
std::string cell(const char* key, const Json& exact, const std::string& text) {
  return fmt::format("<td data-key=\"{}\" data-value=\"{}\">{}</td>", key,
                     escape_html(text_of(exact)), escape_html(text));
}

std::string seconds_cell(const char* key, const Json& exact) {
  return cell(key, exact, fmt::format("{:.5f}", exact.get<double>()));
}

std::string status_cell(const Json& run) {
  const std::string status = run["status"];
  std::string shown = status;
  if (is_solved(run) && !run["stop"].get<std::string>().empty()) {
    shown += " (" + run["stop"].get<std::string>() + ")";
  }
  return fmt::format(
      "<td class=\"text {}\" data-key=\"status\" data-value=\"{}\">{}</td>",
      status == "optimal" || status == "gap" || status == "refused" ? status : "invalid",
      escape_html(status), escape_html(shown));
}

std::string run_row(const Json& run, bool energy, double fastest) {
  const std::string name = run["solver"];
  std::string text = fmt::format("<tr data-solver=\"{0}\"><td>{0}</td>", escape_html(name));
  text += status_cell(run);
  if (!is_solved(run)) {
    return text + fmt::format("<td class=\"wide\" colspan=\"{}\">{}</td></tr>\n", energy ? 10 : 9,
                              escape_html(run["message"].get<std::string>()));
  }
  for (const char* key : {"value", "lower_bound", "gap"}) {
    text += cell(key, run[key], group_digits(run[key].get<std::int64_t>()));
  }
  if (energy) {
    text += cell("energy", run["energy"], fmt::format("{:.8g}", run["energy"].get<double>()));
  }
  const Json& solve = run["solve_seconds"];
  text += seconds_cell("build_seconds", run["build_seconds"]["median"]);
  text += seconds_cell("solve_seconds", solve["median"]);
  text += seconds_cell("solve_minimum", solve["minimum"]);
  text += seconds_cell("solve_maximum", solve["maximum"]);
  const double times = fastest > 0 ? median_of(run, "solve_seconds") / fastest : 1;
  text += fmt::format("<td>{:.2f}</td>", times);
  const std::int64_t bytes = run["bytes"];
  constexpr double kMegabyte = 1e6;
  return text +
         cell("bytes", run["bytes"],
              bytes > 0 ? fmt::format("{:.1f}", static_cast<double>(bytes) / kMegabyte)
                        : std::string("not told")) +
         "</tr>\n";
}

std::string run_table(const Json& instance) {
  const Json& runs = instance["runs"];
  const bool energy = instance["energy_unit"].get<double>() > 0;
  double fastest = std::numeric_limits<double>::infinity();
  for (const Json& run : runs) {
    if (is_solved(run)) fastest = std::min(fastest, median_of(run, "solve_seconds"));
  }
  std::string text =
      "<div class=\"scroll\"><table><thead><tr><th>solver</th><th class=\"text\">status</th>"
      "<th>value</th><th>lower bound</th><th>gap</th>";
  if (energy) text += "<th>energy</th>";
  text +=
      "<th>build s</th><th>solve s</th><th>min</th><th>max</th><th>&times; best</th><th>MB</th>"
      "</tr></thead><tbody>\n";
  for (const Json& run : runs) text += run_row(run, energy, fastest);
  return text + "</tbody></table></div>\n";
}

std::string time_chart(const Json& runs) {
  std::vector<Bar> bars;
  bars.reserve(runs.size());
  for (const Json& run : runs) {
    Bar bar{run["solver"], {}, "refused"};
    if (is_solved(run)) {
      const double build = median_of(run, "build_seconds");
      const double solve = median_of(run, "solve_seconds");
      const double verify = median_of(run, "verify_seconds");
      bar.parts = {
          {"build", "build", build}, {"solve", "solve", solve}, {"verify", "verify", verify}};
      bar.text = seconds_text(build + solve + verify);
    }
    bars.push_back(std::move(bar));
  }
  return bar_chart("Time of each solver", "Medians over the repeats; the number is the whole bar.",
                   bars, true);
}

std::string stage_chart(const Json& stages) {
  std::vector<Bar> bars;
  bars.reserve(stages.size());
  for (const Json& stage : stages) {
    const double seconds = stage["seconds"];
    bars.push_back({stage["name"], {{"stage", "seconds", seconds}}, seconds_text(seconds)});
  }
  return bar_chart("Time of each stage",
                   "What comes before the solvers, once; the certificates of all of them.", bars,
                   true);
}

// Value and bound from zero, never a section of the scale: what is equal looks equal.
std::string bound_chart(const Json& runs) {
  std::vector<Bar> bars;
  bars.reserve(runs.size());
  bool equal = true;
  const Json* first = nullptr;
  for (const Json& run : runs) {
    Bar bar{run["solver"], {}, "refused"};
    if (is_solved(run)) {
      if (first == nullptr) first = &run;
      equal = equal && run["value"] == (*first)["value"] && run["gap"] == 0;
      const double value = run["value"];
      const double gap = run["gap"];
      bar.parts = {{"value", "energy", value}, {"bound", "lower bound", run["lower_bound"]}};
      bar.text = run["gap"] == 0 ? "gap 0"
                 : value > 0     ? fmt::format("gap {:.2g} %", 100 * gap / value)
                                 : fmt::format("gap {:.3g}", gap);
    }
    bars.push_back(std::move(bar));
  }
  std::string note = "In integer units, drawn from zero.";
  if (equal && first != nullptr) {
    note += fmt::format(" All bars are equal: every result is {}, and its bound proves it.",
                        group_digits((*first)["value"].get<std::int64_t>()));
  }
  return bar_chart("Energy and lower bound", note, bars, false);
}

std::string picture_html(const PagePicture& picture) {
  return fmt::format(
      "<figure class=\"picture\"><figcaption><strong>{0}</strong></figcaption><img alt=\"{0}\" "
      "src=\"data:{1};base64,{2}\"></figure>\n",
      escape_html(picture.caption), picture.media_type, base64(picture.bytes));
}

std::string instance_card(const Json& instance, std::size_t number,
                          const std::vector<PagePicture>& pictures) {
  const Json& statistics = instance["statistics"];
  std::string text = fmt::format(
      "<section class=\"card\" data-instance=\"{}\"><h2>{}</h2>\n<p class=\"facts\">{} nodes, {} "
      "edges; {}</p>\n",
      number, escape_html(title_of(instance)),
      group_digits(statistics["nodes"].get<std::int64_t>()),
      group_digits(statistics["edges"].get<std::int64_t>()),
      escape_html(instance["input"].get<std::string>()));
  const std::string defect = instance["defect"];
  if (!defect.empty()) text += "<p class=\"invalid\">" + escape_html(defect) + "</p>\n";
  text += run_table(instance);
  if (instance["energy_unit"].get<double>() > 0) {
    text +=
        "<p class=\"note\">value, bound and gap in integer units; energy in squared units of the "
        "input</p>\n";
  }
  text += "<div class=\"charts\">" + time_chart(instance["runs"]) + bound_chart(instance["runs"]);
  if (!instance["stages"].empty()) text += stage_chart(instance["stages"]);
  for (const PagePicture& picture : pictures) {
    if (picture.instance == number) text += picture_html(picture);
  }
  return text + "</div></section>\n";
}

std::string backend_card(const Json& pairs) {
  if (pairs.empty()) return "";
  std::string text =
      "<section class=\"card\"><h2>Backends</h2><div "
      "class=\"scroll\"><table><thead><tr><th>mesh</th>"
      "<th class=\"text\">first</th><th class=\"text\">second</th><th>energy differs by</th>"
      "<th>cells that differ</th></tr></thead><tbody>\n";
  for (const Json& pair : pairs) {
    text += fmt::format("<tr><td>{}</td><td class=\"text\">{}</td><td class=\"text\">{}</td>",
                        escape_html(file_name(Json{{"input", pair["input"]}})),
                        escape_html(pair["first"].get<std::string>()),
                        escape_html(pair["second"].get<std::string>()));
    const Json& energy = pair["energy_difference"];
    text += cell("energy_difference", energy,
                 energy.is_null() ? "none" : fmt::format("{:.2e}", energy.get<double>()));
    text += cell("differing_cells", pair["differing_cells"],
                 fmt::format("{:.4f} %", 100 * pair["differing_cells"].get<double>())) +
            "</tr>\n";
  }
  return text + "</tbody></table></div></section>\n";
}

std::string parameter_card(const Json& parameters) {
  std::string text = "<section class=\"card\"><h2>Parameters</h2><div class=\"columns\">\n";
  for (const auto& [name, value] : parameters.items()) {
    std::string label = name;
    std::replace(label.begin(), label.end(), '_', ' ');
    text += fmt::format("<div data-parameter=\"{}\"><span>{}</span><span>{}</span></div>\n",
                        escape_html(name), escape_html(label), escape_html(text_of(value)));
  }
  return text + "</div></section>\n";
}

// Where nothing is wrong: what is proved. A relaxation may leave a gap, a solver may refuse.
std::string agreement(const Json& instances) {
  std::size_t results = 0;
  std::size_t proved = 0;
  std::size_t refused = 0;
  for (const Json& instance : instances) {
    for (const Json& run : instance["runs"]) {
      refused += is_solved(run) ? 0 : 1;
      results += is_solved(run) ? 1 : 0;
      proved += is_solved(run) && run["gap"] == 0 ? 1 : 0;
    }
  }
  std::string text =
      "All solvers agree, and every result is proved by its certificate or its bound.";
  if (proved < results) {
    text = fmt::format(
        "All solvers agree: {} of {} results are proved, the others leave a gap between value and "
        "bound.",
        proved, results);
  }
  if (refused > 0) text += fmt::format(" Refused: {}.", refused);
  return text;
}

std::string verdict_card(const Json& instances, const std::vector<std::string>& left_out) {
  std::string defects;
  for (const Json& instance : instances) {
    const std::string defect = instance["defect"];
    if (defect.empty()) continue;
    defects += "<li>" + escape_html(title_of(instance) + ": " + defect) + "</li>";
  }
  std::string text =
      defects.empty()
          ? "<section class=\"card verdict\"><strong>" + agreement(instances) + "</strong>"
          : "<section class=\"card verdict bad\"><strong>Something is wrong:</strong><ul>" +
                defects + "</ul>";
  for (const std::string& sentence : left_out) {
    text += "<p class=\"note\">" + escape_html(sentence) + "</p>";
  }
  return text + "</section>\n";
}

std::string viewer_card(const std::vector<PageScene>& scenes) {
  std::string text =
      "<section class=\"card\" id=\"viewer\"><div class=\"head\"><h2>Input and output "
      "<small>drag to turn, wheel to zoom</small></h2>";
  text += fmt::format("<select aria-label=\"mesh\"{}>", scenes.size() > 1 ? "" : " hidden");
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    text += fmt::format("<option value=\"{}\">{}</option>", i, escape_html(scenes[i].title));
  }
  return text + "</select></div><canvas></canvas><div class=\"captions\"></div></section>\n";
}

Json scenes_json(const std::vector<PageScene>& scenes) {
  Json list = Json::array();
  for (const PageScene& scene : scenes) {
    Json views = Json::array();
    for (const PackedMesh& view : scene.views) views.push_back(packed_json(view));
    list.push_back({{"title", scene.title}, {"views", std::move(views)}});
  }
  return list;
}

std::string page_of(const Json& report, const PageContent& content) {
  const web::Viewer& viewer = web::viewer();
  const Json& instances = report["instances"];
  const bool has_scenes = !content.scenes.empty();
  const bool turns = has_scenes && viewer.built();
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      // The page may fetch nothing, not even by mistake.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>CelloCut comparison</title>\n<style>";
  text += html_style();
  text += "</style></head><body><main>\n<h1>CelloCut comparison</h1>\n";
  text += fmt::format("<p class=\"lead\">version {}, {} instance{}, {} repeat{}</p>\n",
                      escape_html(text_of(report["version"])), instances.size(),
                      instances.size() == 1 ? "" : "s", dump(report["repeats"]),
                      report["repeats"] == 1 ? "" : "s");
  text += verdict_card(instances, content.left_out);
  if (turns) text += viewer_card(content.scenes);
  if (has_scenes && !turns) {
    text += fmt::format(
        "<p class=\"note\" id=\"no-viewer\">Without the 3D view: this program was built without it "
        "({}).</p>\n",
        escape_html(viewer.not_built));
  }
  for (std::size_t i = 0; i < instances.size(); ++i) {
    text += instance_card(instances[i], i, content.pictures);
  }
  text += backend_card(report["backends"]) + parameter_card(report["parameters"]);
  if (turns) {
    text += fmt::format(
        "<details><summary>The 3D view is made with {}</summary><pre>{}</pre></details>\n",
        viewer.library, escape_html(viewer.licence_text));
  }
  text += "</main>\n<script type=\"application/json\" id=\"report\">" + script_json(report) +
          "</script>\n";
  if (turns) {
    text += "<script type=\"application/json\" id=\"meshes\">" +
            script_json(scenes_json(content.scenes)) + "</script>\n<script>";
    text += viewer.script;
    text += "</script>\n";
  }
  return text + "</body></html>\n";
}

}  // namespace

std::string html_report(const Json& report, PageContent content, std::size_t bytes) {
  std::string page = page_of(report, content);
  const std::size_t told = content.left_out.size();
  while (page.size() >= bytes && !(content.scenes.empty() && content.pictures.empty())) {
    const bool meshes = !content.scenes.empty();
    if (meshes) {
      content.scenes.pop_back();
    } else {
      content.pictures.pop_back();
    }
    content.left_out.resize(told);
    content.left_out.push_back(fmt::format(
        "Without some of the {}: the page stays below {:.1f} MB.",
        meshes ? "meshes" : "sections, and without meshes", static_cast<double>(bytes) / 1e6));
    page = page_of(report, content);
  }
  return page;
}

}  // namespace cellocut::tools
