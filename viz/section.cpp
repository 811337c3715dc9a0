// draw_section: lays out the page and paints it once with cairo for either format.
#include "viz/section.h"

#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "cellocut/base/errors.h"
#include "viz/plane_section.h"
#include "viz/section_colours.h"
#include "viz/section_scene.h"

namespace cellocut::viz {

namespace {

// ---- The page. All lengths in pixels. ----

struct LegendEntry {
  std::string text;
  Colour fill;
  Colour line;
  bool filled = true;
};

struct Layout {
  double unit = 1;  // thickness and text follow the size of the picture
  double font = 16;
  double margin = 0;
  double scale = 1;  // pixels per unit of length
  Point2 origin{};   // pixel of the plane's (0, 0) relative to which points are mapped
  double drawing_width = 0;
  double drawing_height = 0;
  double page_width = 0;
  double page_height = 0;
  double title_height = 0;
  double footer_top = 0;
  double bar_length = 0;
  std::string bar_text;
  std::string title;
  std::string caption;
  bool caption_below_bar = false;
  std::vector<LegendEntry> legend;
  std::vector<Point2> legend_places;  // baseline starts
};

struct CairoDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};
using CairoSurface = std::unique_ptr<cairo_surface_t, CairoDeleter>;
using CairoContext = std::unique_ptr<cairo_t, CairoDeleter>;

void set_font(cairo_t* cr, double size) {
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, size);
}

double text_width(const std::string& text, double font) {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1));
  const CairoContext cr(cairo_create(surface.get()));
  set_font(cr.get(), font);
  cairo_text_extents_t extents{};
  cairo_text_extents(cr.get(), text.c_str(), &extents);
  return extents.x_advance;
}

// The largest of 1, 2, 5 times a power of ten that is at most `limit`.
double nice_length(double limit) {
  const double power = std::pow(10, std::floor(std::log10(limit)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= limit) return digit * power;
  }
  return power;
}

std::vector<LegendEntry> legend_of(const Scene& scene) {
  constexpr std::size_t kMostCategories = 12;
  std::vector<LegendEntry> legend;
  const std::vector<Category>& categories = scene.cells.categories;
  for (std::size_t i = 0; i < std::min(categories.size(), kMostCategories); ++i) {
    legend.push_back({categories[i].name, categories[i].colour, {0.4, 0.4, 0.4}, true});
  }
  if (categories.size() > kMostCategories) {
    const std::size_t more = categories.size() - kMostCategories;
    legend.push_back({fmt::format("and {} more", more), {1, 1, 1}, {0.4, 0.4, 0.4}, true});
  }
  for (const SurfaceLayer& layer : scene.surfaces) {
    legend.push_back({layer.name + (layer.section.closed ? "" : " (open here)"),
                      surface_fill_colour(layer.index), surface_line_colour(layer.index),
                      layer.section.closed});
  }
  return legend;
}

// `extent`: what is shown, of this scene and those of planes along it; `longest`: the longest edge
// of all scenes, which sets the scale.
Layout lay_out(const Scene& scene, const Extent& extent, double longest, const SectionPanel& panel,
               const SectionStyle& style) {
  Layout page;
  const double width = style.width;
  page.unit = width / 1200;
  page.font = std::max(9.0, 20 * page.unit);
  page.margin = std::max(4.0, 0.025 * width);
  // A straight line has no height: give it some room.
  const double least = 0.05 * longest;
  page.scale = width / longest;
  page.drawing_width = page.scale * std::max(extent.edge(0), least);
  page.drawing_height = page.scale * std::max(extent.edge(1), least);
  page.bar_length = nice_length(0.25 * longest);
  page.bar_text = fmt::format("{:.4g}", page.bar_length);
  page.title = panel.title;
  page.title_height = page.title.empty() ? 0 : 1.6 * page.font;
  page.caption = plane_equation(panel.plane);
  page.legend = legend_of(scene);

  const double inner = std::max(page.drawing_width, 0.5 * width);
  page.page_width = std::ceil(inner + 2 * page.margin);
  const double centre_x = 0.5 * (extent.low[0] + extent.high[0]);
  const double centre_y = 0.5 * (extent.low[1] + extent.high[1]);
  page.origin = {
      0.5 * page.page_width - page.scale * centre_x,
      page.margin + page.title_height + 0.5 * page.drawing_height + page.scale * centre_y};

  page.footer_top = page.margin + page.title_height + page.drawing_height + page.margin;
  const double row = 1.6 * page.font;
  const double bar =
      page.scale * page.bar_length + text_width(page.bar_text, page.font) + page.font;
  page.caption_below_bar = bar + page.font + text_width(page.caption, page.font) > inner;
  double y = page.footer_top + (page.caption_below_bar ? 2 : 1) * row;
  double x = page.margin;
  for (const LegendEntry& entry : page.legend) {
    const double entry_width = 2.6 * page.font + text_width(entry.text, page.font);
    if (x > page.margin && x + entry_width > page.margin + inner) {
      x = page.margin;
      y += row;
    }
    page.legend_places.push_back({x, y + page.font});
    x += entry_width;
  }
  page.page_height = std::ceil(y + (page.legend.empty() ? 0 : row) + 0.5 * page.margin);
  return page;
}

// ---- Painting. ----

class Painter {
 public:
  Painter(cairo_t* cr, const Layout& page) : cr_(cr), page_(page) {}

  void paint(const Scene& scene, const SectionStyle& style) {
    cairo_set_line_join(cr_, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cr_, CAIRO_LINE_CAP_ROUND);
    cairo_set_fill_rule(cr_, CAIRO_FILL_RULE_EVEN_ODD);
    if (!scene.cells.section.polygons.empty()) {
      paint_cells(scene.cells);
      if (style.cell_edges) paint_cell_edges(scene.cells.section);
    }
    bool covered = !scene.cells.section.polygons.empty();
    for (const SurfaceLayer& layer : scene.surfaces) {
      paint_surface(layer, covered);
      covered = true;
    }
    if (!page_.title.empty()) text(page_.margin, page_.margin + 0.6 * page_.font, page_.title);
    paint_scale_bar_and_caption();
    paint_legend();
  }

 private:
  void set(const Colour& c, double alpha = 1) {
    cairo_set_source_rgba(cr_, c.red, c.green, c.blue, alpha);
  }

  [[nodiscard]] Point2 pixel(const Point2& p) const {
    return {page_.origin[0] + page_.scale * p[0], page_.origin[1] - page_.scale * p[1]};
  }

  // Adds the walks to the current path. Points that lie within a fraction of a pixel of the one
  // before are left out: nobody sees them, and they would make up most of an SVG file.
  void add_path(const std::vector<Point2>& nodes, const std::vector<Chain>& chains) {
    constexpr double kLeastStep = 0.3;
    for (const Chain& chain : chains) {
      Point2 last = pixel(nodes[chain.nodes.front()]);
      cairo_move_to(cr_, last[0], last[1]);
      for (std::size_t i = 1; i < chain.nodes.size(); ++i) {
        const Point2 p = pixel(nodes[chain.nodes[i]]);
        const bool is_end = !chain.closed && i + 1 == chain.nodes.size();
        if (!is_end && std::hypot(p[0] - last[0], p[1] - last[1]) < kLeastStep) continue;
        cairo_line_to(cr_, p[0], p[1]);
        last = p;
      }
      if (chain.closed) cairo_close_path(cr_);
    }
  }

  // The most frequent value fills the outline of all cells and the others are painted upon it, each
  // as the outline of its cells. So no background shines through where two antialiased borders
  // meet, and the size of the picture follows the length of the borders.
  void paint_cells(const CellLayer& layer) {
    const std::vector<Category>& categories = layer.categories;
    std::vector<std::size_t> counts;
    counts.reserve(categories.size());
    for (const Category& category : categories) {
      counts.push_back(static_cast<std::size_t>(
          std::count(layer.values.begin(), layer.values.end(), category.value)));
    }
    const auto base =
        static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
    fill(layer.section.nodes, outline(sides_of(layer.section.polygons)), categories[base].colour);

    std::vector<std::vector<std::array<std::uint32_t, 4>>> polygons(categories.size());
    for (std::size_t i = 0; i < layer.values.size(); ++i) {
      const auto it = std::lower_bound(
          categories.begin(), categories.end(), layer.values[i],
          [](const Category& category, std::int32_t value) { return category.value < value; });
      polygons[static_cast<std::size_t>(it - categories.begin())].push_back(
          layer.section.polygons[i]);
    }
    for (std::size_t k = 0; k < categories.size(); ++k) {
      if (k == base || counts[k] == 0) continue;
      fill(layer.section.nodes, outline(sides_of(polygons[k])), categories[k].colour);
    }
  }

  void fill(const std::vector<Point2>& nodes, const std::vector<Segment>& segments,
            const Colour& colour, double alpha = 1) {
    add_path(nodes, chain_segments(nodes.size(), segments));
    set(colour, alpha);
    cairo_fill(cr_);
  }

  // Edges shorter than a line is wide would only blacken the smallest cells.
  void paint_cell_edges(const CellSection& section) {
    const double width = 0.6 * page_.unit;
    std::vector<Segment> visible;
    for (const Segment& side : unique_segments(sides_of(section.polygons))) {
      const Point2 a = pixel(section.nodes[side[0]]);
      const Point2 b = pixel(section.nodes[side[1]]);
      if (std::hypot(a[0] - b[0], a[1] - b[1]) > 2.5 * width) visible.push_back(side);
    }
    add_path(section.nodes, chain_segments(section.nodes.size(), visible));
    set(Colour{0.15, 0.15, 0.2}, 0.45);
    cairo_set_line_width(cr_, width);
    cairo_stroke(cr_);
  }

  void paint_surface(const SurfaceLayer& layer, bool covers_something) {
    const SurfaceSection& section = layer.section;
    if (section.closed) {
      fill(section.nodes, section.segments, surface_fill_colour(layer.index),
           covers_something ? 0.3 : 1.0);
    }
    add_path(section.nodes, chain_segments(section.nodes.size(), section.segments));
    set(surface_line_colour(layer.index));
    cairo_set_line_width(cr_, std::max(1.0, 1.8 * page_.unit));
    cairo_stroke(cr_);
  }

  void text(double x, double baseline, const std::string& words) {
    set_font(cr_, page_.font);
    set(Colour{0.1, 0.1, 0.1});
    cairo_move_to(cr_, x, baseline);
    cairo_show_text(cr_, words.c_str());
    cairo_new_path(cr_);
  }

  void paint_scale_bar_and_caption() {
    const double length = page_.scale * page_.bar_length;
    const double baseline = page_.footer_top + page_.font;
    const double y = baseline - 0.35 * page_.font;
    const double tick = 0.35 * page_.font;
    set(Colour{0.1, 0.1, 0.1});
    cairo_set_line_width(cr_, 2 * page_.unit);
    for (const double x : {page_.margin, page_.margin + length}) {
      cairo_move_to(cr_, x, y - tick);
      cairo_line_to(cr_, x, y + tick);
    }
    cairo_move_to(cr_, page_.margin, y);
    cairo_line_to(cr_, page_.margin + length, y);
    cairo_stroke(cr_);
    text(page_.margin + length + 0.6 * page_.font, baseline, page_.bar_text);
    if (page_.caption_below_bar) {
      text(page_.margin, baseline + 1.6 * page_.font, page_.caption);
    } else {
      const double width = text_width(page_.caption, page_.font);
      text(page_.page_width - page_.margin - width, baseline, page_.caption);
    }
  }

  void paint_legend() {
    const double side = 0.9 * page_.font;
    for (std::size_t i = 0; i < page_.legend.size(); ++i) {
      const LegendEntry& entry = page_.legend[i];
      const Point2& place = page_.legend_places[i];
      if (entry.filled) {
        cairo_rectangle(cr_, place[0], place[1] - 0.8 * page_.font, side, side);
        set(entry.fill);
        cairo_fill_preserve(cr_);
      } else {
        cairo_move_to(cr_, place[0], place[1] - 0.35 * page_.font);
        cairo_line_to(cr_, place[0] + side, place[1] - 0.35 * page_.font);
      }
      set(entry.line);
      cairo_set_line_width(cr_, (entry.filled ? 1 : 1.8) * page_.unit);
      cairo_stroke(cr_);
      text(place[0] + 1.4 * page_.font, place[1], entry.text);
    }
  }

  cairo_t* cr_;
  const Layout& page_;
};

cairo_status_t append_bytes(void* closure, const unsigned char* data, unsigned int length) {
  try {
    static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {  // no exception may cross cairo's frames
    return CAIRO_STATUS_NO_MEMORY;
  }
}

void check(cairo_status_t status) {
  if (status == CAIRO_STATUS_NO_MEMORY) throw LimitError("out of memory for the picture");
  if (status != CAIRO_STATUS_SUCCESS) {
    throw Error(std::string("cannot draw the section: ") + cairo_status_to_string(status));
  }
}

// Where panels go on a sheet: rows as high and columns as wide as their largest page.
struct Sheet {
  std::vector<Layout> pages;
  std::vector<Point2> places;
  double width = 0;
  double height = 0;
};

Sheet lay_out_sheet(const std::vector<SectionPanel>& panels, const std::vector<Scene>& scenes,
                    std::size_t columns, const SectionStyle& style) {
  // What scenes of parallel planes show, together.
  std::vector<Extent> extents(scenes.size());
  double longest = 0;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (std::size_t j = 0; j < scenes.size(); ++j) {
      if (scenes[j].extent.empty() || panels[i].plane.normal != panels[j].plane.normal) continue;
      extents[i].add({scenes[j].extent.low, scenes[j].extent.high});
    }
    if (!extents[i].empty()) longest = std::max(longest, extents[i].longest());
  }
  for (Extent& extent : extents) {
    if (extent.empty()) extent.add({{0, 0}, {longest, 0}});
  }
  Sheet sheet;
  std::vector<double> widths(std::min(columns, panels.size()), 0.0);
  std::vector<double> heights((panels.size() + columns - 1) / columns, 0.0);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    sheet.pages.push_back(lay_out(scenes[i], extents[i], longest, panels[i], style));
    double& width = widths[i % columns];
    double& height = heights[i / columns];
    width = std::max(width, sheet.pages.back().page_width);
    height = std::max(height, sheet.pages.back().page_height);
  }
  for (std::size_t row = 0, i = 0; row < heights.size(); ++row) {
    double x = 0;
    for (std::size_t column = 0; column < columns && i < panels.size(); ++column, ++i) {
      sheet.places.push_back({x, sheet.height});
      x += widths[column];
      sheet.width = std::max(sheet.width, x);
    }
    sheet.height += heights[row];
  }
  return sheet;
}

}  // namespace

std::string draw_section(const SectionLayers& layers, const Plane& plane, const SectionStyle& style,
                         PictureFormat format) {
  return draw_sections({{layers, plane, ""}}, 1, style, format);
}

std::string draw_sections(const std::vector<SectionPanel>& panels, int columns,
                          const SectionStyle& style, PictureFormat format) {
  constexpr int kLeastWidth = 64;
  constexpr int kMostWidth = 16384;
  constexpr double kMostPixels = 32767;  // where cairo's images end
  if (style.width < kLeastWidth || style.width > kMostWidth) {
    throw UsageError(fmt::format("a picture is {} to {} pixels wide, not {}", kLeastWidth,
                                 kMostWidth, style.width));
  }
  std::vector<Scene> scenes;
  scenes.reserve(panels.size());
  for (const SectionPanel& panel : panels) scenes.push_back(make_scene(panel.layers, panel.plane));
  if (std::all_of(scenes.begin(), scenes.end(),
                  [](const Scene& scene) { return scene.extent.empty(); })) {
    fail_missed(panels.front().layers, panels.front().plane);
  }
  const Sheet sheet = lay_out_sheet(panels, scenes, static_cast<std::size_t>(columns), style);
  if (std::max(sheet.width, sheet.height) > kMostPixels) {
    throw UsageError(
        fmt::format("a picture of {:.0f} x {:.0f} pixels is too large: ask for fewer "
                    "panels or a smaller width",
                    sheet.width, sheet.height));
  }
  std::string bytes;
  CairoSurface surface;
  if (format == PictureFormat::png) {
    surface.reset(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(sheet.width),
                                             static_cast<int>(sheet.height)));
  } else {
    surface.reset(
        cairo_svg_surface_create_for_stream(append_bytes, &bytes, sheet.width, sheet.height));
    cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_PX);
  }
  const CairoContext cr(cairo_create(surface.get()));
  cairo_set_source_rgb(cr.get(), 1, 1, 1);
  cairo_paint(cr.get());
  for (std::size_t i = 0; i < panels.size(); ++i) {
    cairo_save(cr.get());
    cairo_translate(cr.get(), sheet.places[i][0], sheet.places[i][1]);
    Painter(cr.get(), sheet.pages[i]).paint(scenes[i], style);
    cairo_restore(cr.get());
  }
  check(cairo_status(cr.get()));
  if (format == PictureFormat::png) {
    check(cairo_surface_write_to_png_stream(surface.get(), append_bytes, &bytes));
  }
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  return bytes;
}

}  // namespace cellocut::viz
