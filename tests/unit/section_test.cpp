// Sections: against polygons and areas known in closed form, in numbers and in pixels.
#include "viz/section.h"

#include <cairo.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <numbers>

#include "cellocut/base/errors.h"
#include "viz/plane_section.h"
#include "viz/section_colours.h"

namespace cellocut::viz {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr Plane across_x(double offset) { return {{1, 0, 0}, offset}; }
constexpr Plane across_y(double offset) { return {{0, 1, 0}, offset}; }
constexpr Plane across_z(double offset) { return {{0, 0, 1}, offset}; }

// ---- Shapes ----

// The unit cube in n^3 boxes of six tetrahedra each; label 0 where the box's middle has x <
// `solid`.
LabelledCells cube_cells(std::uint32_t n, double solid = 0.5) {
  LabelledCells cells;
  const auto id = [n](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return (i * (n + 1) + j) * (n + 1) + k;
  };
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      for (std::uint32_t k = 0; k <= n; ++k) {
        cells.points.push_back({double(i) / n, double(j) / n, double(k) / n});
      }
    }
  }
  std::vector<std::uint8_t> label;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      for (std::uint32_t k = 0; k < n; ++k) {
        std::array<int, 3> axes{0, 1, 2};
        do {  // along the main diagonal, one axis after the other
          std::array<std::uint32_t, 3> at{i, j, k};
          std::array<std::uint32_t, 4> cell{id(i, j, k), 0, 0, 0};
          for (int step = 0; step < 3; ++step) {
            ++at[axes[step]];
            cell[step + 1] = id(at[0], at[1], at[2]);
          }
          cells.cells.push_back(cell);
          label.push_back((i + 0.5) / n < solid ? 0 : 1);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
    }
  }
  cells.arrays = {{"label", label}, {"phi", std::vector<float>(cells.cells.size(), 0.5F)}};
  return cells;
}

// A sphere of latitudes and longitudes around the origin, appended to `soup`.
void add_sphere(TriangleSoup& soup, double radius, std::uint32_t n = 48) {
  const auto base = static_cast<std::uint32_t>(soup.points.size());
  soup.points.push_back({0, 0, -radius});
  for (std::uint32_t i = 1; i < n; ++i) {
    const double polar = std::numbers::pi * (double(i) / n - 0.5);
    for (std::uint32_t j = 0; j < 2 * n; ++j) {
      const double around = std::numbers::pi * j / n;
      soup.points.push_back({radius * std::cos(polar) * std::cos(around),
                             radius * std::cos(polar) * std::sin(around),
                             radius * std::sin(polar)});
    }
  }
  const auto top = static_cast<std::uint32_t>(soup.points.size());
  soup.points.push_back({0, 0, radius});
  const auto id = [&](std::uint32_t i, std::uint32_t j) {
    return base + 1 + (i - 1) * 2 * n + j % (2 * n);
  };
  for (std::uint32_t j = 0; j < 2 * n; ++j) {
    soup.triangles.push_back({base, id(1, j + 1), id(1, j)});
    for (std::uint32_t i = 1; i + 1 < n; ++i) {
      soup.triangles.push_back({id(i, j), id(i, j + 1), id(i + 1, j)});
      soup.triangles.push_back({id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)});
    }
    soup.triangles.push_back({id(n - 1, j), id(n - 1, j + 1), top});
  }
}

// ---- Measuring ----

double polygon_area(const std::vector<Point2>& nodes, const std::vector<std::uint32_t>& loop) {
  double doubled = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Point2& a = nodes[loop[i]];
    const Point2& b = nodes[loop[(i + 1) % loop.size()]];
    doubled += a[0] * b[1] - a[1] * b[0];
  }
  return std::abs(doubled) / 2;
}

double total_area(const CellSection& section) {
  double area = 0;
  for (const auto& polygon : section.polygons) {
    std::vector<std::uint32_t> loop(polygon.begin(), polygon.end());
    if (loop.back() == kNoNode) loop.pop_back();
    area += polygon_area(section.nodes, loop);
  }
  return area;
}

struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> pixels;  // 0x00rrggbb
  [[nodiscard]] std::uint32_t at(int x, int y) const { return pixels[y * width + x]; }
  [[nodiscard]] double count(const Colour& colour) const { return count(colour, 0); }
  // As cairo rounds channels in its own way.
  [[nodiscard]] double count_about(const Colour& colour) const { return count(colour, 1); }

 private:
  [[nodiscard]] double count(const Colour& colour, int tolerance) const {
    const auto same = [tolerance](std::uint32_t pixel, double channel) {
      const auto byte = static_cast<int>(pixel & 0xFFU);
      return std::abs(byte - static_cast<int>(std::lround(255 * channel))) <= tolerance;
    };
    return static_cast<double>(std::count_if(pixels.begin(), pixels.end(), [&](std::uint32_t p) {
      return same(p >> 16U, colour.red) && same(p >> 8U, colour.green) && same(p, colour.blue);
    }));
  }
};

Image decode(const std::string& png) {
  struct Source {
    const std::string& bytes;
    std::size_t at = 0;
  } source{png};
  const auto read = [](void* closure, unsigned char* data, unsigned int length) {
    auto& from = *static_cast<Source*>(closure);
    if (from.at + length > from.bytes.size()) return CAIRO_STATUS_READ_ERROR;
    std::memcpy(data, from.bytes.data() + from.at, length);
    from.at += length;
    return CAIRO_STATUS_SUCCESS;
  };
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create_from_png_stream(read, &source), &cairo_surface_destroy);
  EXPECT_EQ(cairo_surface_status(surface.get()), CAIRO_STATUS_SUCCESS);
  Image image;
  image.width = cairo_image_surface_get_width(surface.get());
  image.height = cairo_image_surface_get_height(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  for (int y = 0; y < image.height; ++y) {
    const unsigned char* row = cairo_image_surface_get_data(surface.get()) + y * stride;
    for (int x = 0; x < image.width; ++x) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, row + 4 * x, 4);
      image.pixels.push_back(pixel & 0xffffffU);
    }
  }
  return image;
}

constexpr SectionStyle kPlain{400, false};
constexpr double kArea = 400.0 * 400.0;

Image draw(const SectionLayers& layers, const Plane& plane, const SectionStyle& style = kPlain) {
  return decode(draw_section(layers, plane, style, PictureFormat::png));
}

Colour label_colour(std::int32_t value) { return categories_of("label", {})[value].colour; }

template <class Exception>
std::string error_of(const SectionLayers& layers, const Plane& plane,
                     const SectionStyle& style = kPlain) {
  try {
    draw_section(layers, plane, style, PictureFormat::png);
  } catch (const Exception& error) {
    return error.what();
  }
  return "no error";
}

// ---- Planes ----

TEST(ParsePlane, AcceptsAxesPerCentAndEquations) {
  const Box3 box{{-1, 0, 10}, {1, 4, 30}};
  EXPECT_EQ(parse_plane("x=0.5", box).normal, (Point3{1, 0, 0}));
  EXPECT_EQ(parse_plane("x=0.5", box).offset, 0.5);
  EXPECT_EQ(parse_plane("y=25%", box).normal, (Point3{0, 1, 0}));
  EXPECT_EQ(parse_plane("y=25%", box).offset, 1);
  EXPECT_EQ(parse_plane("z=50%", box).offset, 20);
  EXPECT_EQ(parse_plane("x=0%", box).offset, -1);
  EXPECT_EQ(parse_plane(" z = -1e3 ", box).offset, -1000);
  const Plane general = parse_plane("1, -2,0.5,-3", box);
  EXPECT_EQ(general.normal, (Point3{1, -2, 0.5}));
  EXPECT_EQ(general.offset, -3);
}

TEST(ParsePlane, RefusesTheRest) {
  for (const char* text : {"", "x", "x=", "w=1", "x=1x", "x=%", "x=nan", "x=inf", "0,0,0,1",
                           "1,0,0", "1,0,0,0,0", "1,,0,0", "xy=1", "x=1,2", "1,0,0,nan"}) {
    EXPECT_THROW(parse_plane(text, Box3{}), UsageError) << text;
  }
}

TEST(PlaneFrame, AxesOfThePictureDoNotDependOnTheSignOfTheNormal) {
  for (const double sign : {1.0, -3.0}) {
    const auto frame_across = [sign](const Point3& normal) {
      return plane_frame({sign * normal, 0.5});
    };
    EXPECT_EQ(frame_across({1, 0, 0}).right, (Point3{0, 1, 0}));
    EXPECT_EQ(frame_across({1, 0, 0}).up, (Point3{0, 0, 1}));
    EXPECT_EQ(frame_across({0, 1, 0}).right, (Point3{1, 0, 0}));
    EXPECT_EQ(frame_across({0, 1, 0}).up, (Point3{0, 0, 1}));
    EXPECT_EQ(frame_across({0, 0, 1}).right, (Point3{1, 0, 0}));
    EXPECT_EQ(frame_across({0, 0, 1}).up, (Point3{0, 1, 0}));
  }
  const PlaneFrame oblique = plane_frame({{1, -2, 0.5}, 0});
  EXPECT_NEAR(norm(oblique.right), 1, 1e-15);
  EXPECT_NEAR(norm(oblique.up), 1, 1e-15);
  EXPECT_NEAR(dot(oblique.right, oblique.up), 0, 1e-15);
  EXPECT_NEAR(dot(oblique.right, Point3{1, -2, 0.5}), 0, 1e-15);
  EXPECT_GT(oblique.up[2], 0);
  EXPECT_GT(oblique.right[0], 0);
}

// ---- Geometry ----

const std::vector<Point3> kCorner = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<std::array<std::uint32_t, 4>> kOneCell = {{0, 1, 2, 3}};

TEST(SectionOfCells, TriangleOfOneTetrahedron) {
  const CellSection section = section_of_cells(kCorner, kOneCell, across_z(0.5));
  EXPECT_THAT(section.cells, ElementsAre(0));
  EXPECT_THAT(section.nodes,
              ::testing::UnorderedElementsAre(Point2{0, 0}, Point2{0.5, 0}, Point2{0, 0.5}));
  EXPECT_EQ(section.polygons[0][3], kNoNode);
  EXPECT_DOUBLE_EQ(total_area(section), 0.125);
}

TEST(SectionOfCells, QuadrilateralOfOneTetrahedronIsSimple) {
  for (const double sign : {1.0, -1.0}) {
    const CellSection section = section_of_cells(kCorner, kOneCell, {{sign, sign, 0}, sign * 0.5});
    ASSERT_EQ(section.nodes.size(), 4U);
    // A rectangle of sides sqrt(1/2) and 1/2; a bow tie of the same nodes would have area zero.
    EXPECT_NEAR(total_area(section), std::sqrt(0.5) * 0.5, 1e-15);
  }
}

TEST(SectionOfCells, PointsOnThePlaneCountAsAbove) {
  EXPECT_TRUE(section_of_cells(kCorner, kOneCell, across_z(0)).cells.empty());
  const CellSection top = section_of_cells(kCorner, kOneCell, across_z(1));
  EXPECT_THAT(top.cells, ElementsAre(0));
  EXPECT_EQ(total_area(top), 0);
  // The facet x + y + z = 1 lies in the plane and the rest below it.
  EXPECT_NEAR(total_area(section_of_cells(kCorner, kOneCell, {{1, 1, 1}, 1})), std::sqrt(3.0) / 2,
              1e-15);
}

TEST(SectionOfCells, CoversTheCubeOnceWhereverThePlaneLies) {
  const LabelledCells cube = cube_cells(4);
  // Through vertices and facets as well as between them.
  for (const double offset : {0.1, 0.25, 0.3333, 0.5, 0.75, 1.0}) {
    for (const Plane& plane : {across_x(offset), across_y(offset), across_z(offset)}) {
      EXPECT_NEAR(total_area(section_of_cells(cube.points, cube.cells, plane)), 1, 1e-12) << offset;
    }
  }
  EXPECT_NEAR(total_area(section_of_cells(cube.points, cube.cells, {{1, 1, 1}, 1.5})),
              0.75 * std::sqrt(3.0), 1e-12);
}

TEST(Outline, OfAllCellsIsTheBorderOfTheCube) {
  const LabelledCells cube = cube_cells(4);
  for (const double offset : {0.3, 0.5}) {
    const CellSection section = section_of_cells(cube.points, cube.cells, across_z(offset));
    const std::vector<Segment> border = outline(sides_of(section.polygons));
    double length = 0;
    for (const Segment& s : border) {
      const Point2& a = section.nodes[s[0]];
      const Point2& b = section.nodes[s[1]];
      length += std::hypot(a[0] - b[0], a[1] - b[1]);
    }
    EXPECT_NEAR(length, 4, 1e-12);
    const std::vector<Chain> chains = chain_segments(section.nodes.size(), border);
    for (const Chain& chain : chains) EXPECT_TRUE(chain.closed);
  }
}

TEST(ChainSegments, EverySegmentOnceAndLoopsClosed) {
  // Two triangles that share node 2 (a figure of eight), an open path 5-6-7, a loop of no length.
  const std::vector<Segment> segments = {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4},
                                         {4, 2}, {6, 5}, {6, 7}, {8, 8}};
  const std::vector<Chain> chains = chain_segments(9, segments);
  std::map<Segment, int> seen;
  std::size_t open = 0;
  for (const Chain& chain : chains) {
    if (!chain.closed) ++open;
    const std::size_t n = chain.nodes.size();
    for (std::size_t i = 0; i + (chain.closed ? 0 : 1) < n; ++i) {
      const std::uint32_t a = chain.nodes[i];
      const std::uint32_t b = chain.nodes[(i + 1) % n];
      ++seen[{std::min(a, b), std::max(a, b)}];
    }
  }
  EXPECT_EQ(open, 1U);
  EXPECT_EQ(seen.size(), 8U);
  for (const auto& [segment, times] : seen) EXPECT_EQ(times, 1);
}

TEST(SectionOfSurface, SphereIsOneCircle) {
  TriangleSoup sphere;
  add_sphere(sphere, 2);
  // Through the ring of vertices at the equator, through both poles, and between vertices.
  for (const Plane& plane : {across_z(0), across_x(0), across_y(0.01)}) {
    const SurfaceSection section = section_of_surface(sphere, plane);
    EXPECT_TRUE(section.closed);
    const std::vector<Chain> chains = chain_segments(section.nodes.size(), section.segments);
    ASSERT_EQ(chains.size(), 1U);
    EXPECT_TRUE(chains[0].closed);
    EXPECT_NEAR(polygon_area(section.nodes, chains[0].nodes), 4 * std::numbers::pi, 0.03);
  }
}

TEST(SectionOfSurface, OpenSheetIsNotClosed) {
  const TriangleSoup sheet{{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  const SurfaceSection section = section_of_surface(sheet, across_z(0.25));
  EXPECT_EQ(section.segments.size(), 2U);
  EXPECT_FALSE(section.closed);
}

// ---- Pictures ----

TEST(DrawSection, CellsFillTheirShareOfThePicture) {
  const LabelledCells cube = cube_cells(8, 0.25);
  for (const double height : {0.5, 0.47}) {
    const Image image = draw({&cube, "label", {}, {}}, across_z(height));
    EXPECT_NEAR(image.count(label_colour(0)) / kArea, 0.25, 0.01);
    EXPECT_NEAR(image.count(label_colour(1)) / kArea, 0.75, 0.01);
  }
  // x runs to the right: the solid quarter is at the left.
  const Image image = draw({&cube, "label", {}, {}}, across_z(0.5));
  EXPECT_NE(image.at(30, 200), image.at(image.width - 31, 200));
  EXPECT_EQ(image.at(30, 40), image.at(30, 390));
}

TEST(DrawSection, CellEdgesAreDrawnOnDemand) {
  const LabelledCells cube = cube_cells(8, 0.25);
  const Image plain = draw({&cube, "label", {}, {}}, across_z(0.47));
  const Image lined = draw({&cube, "label", {}, {}}, across_z(0.47), {400, true});
  EXPECT_LT(lined.count(label_colour(1)), 0.95 * plain.count(label_colour(1)));
}

TEST(DrawSection, HollowSphereLeavesItsMiddleWhite) {
  TriangleSoup hollow;
  add_sphere(hollow, 1);
  const double solid =
      draw({nullptr, "", {&hollow}, {}}, across_z(0.001)).count(surface_fill_colour(0));
  EXPECT_NEAR(solid / kArea, std::numbers::pi / 4, 0.02);
  add_sphere(hollow, 0.5);
  for (const Plane& plane : {across_z(0), across_x(0.001), across_y(0)}) {
    const Image image = draw({nullptr, "", {&hollow}, {}}, plane);
    EXPECT_NEAR(image.count(surface_fill_colour(0)) / kArea, 0.75 * std::numbers::pi / 4, 0.02);
    EXPECT_EQ(image.at(image.width / 2, 10 + 200), 0xffffffU);
    EXPECT_NE(image.at(image.width / 2, 10 + 50), 0xffffffU);
  }
}

TEST(DrawSection, OpenSurfaceIsDrawnAsLinesOnly) {
  TriangleSoup bowl;
  add_sphere(bowl, 1);
  // Without the triangles on one side: a gap that the plane crosses.
  std::erase_if(bowl.triangles, [&](const Triangle& t) {
    return bowl.points[t[0]][0] > 0.5 && bowl.points[t[1]][0] > 0.5;
  });
  const Image image = draw({nullptr, "", {&bowl}, {}}, across_z(0.1), {1200, false});
  // But for a few pixels on the edges of lines and letters that happen to have that colour.
  EXPECT_LT(image.count(surface_fill_colour(0)), 30);
  EXPECT_GT(image.count(surface_line_colour(0)), 100);
}

TEST(DrawSection, PictureFollowsTheExtentOfTheSection) {
  LabelledCells cube = cube_cells(2);
  for (Point3& p : cube.points) p = {4 * p[0], 1000 + p[1], p[2]};
  const Image flat = draw({&cube, "label", {}, {}}, across_z(0.5));
  const Image square = draw({&cube, "label", {}, {}}, across_x(0.5));
  EXPECT_EQ(flat.width, square.width);
  EXPECT_NEAR(square.height - flat.height, 300, 1);
}

TEST(DrawSection, StraightLineStillGivesAPicture) {
  const TriangleSoup sheet{{{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  const Image image = draw({nullptr, "", {&sheet}, {"sheet"}}, across_z(0.25), {1200, false});
  // The middle column meets the line; its pixel is not white.
  int dark = 0;
  for (int y = 0; y < 100; ++y) {
    if ((image.at(image.width / 2, y) & 0xffU) < 200) ++dark;
  }
  EXPECT_GE(dark, 1);
  EXPECT_LE(dark, 4);
}

TEST(DrawSection, OtherArraysHaveDistinctColours) {
  LabelledCells cube = cube_cells(4);
  std::vector<std::int32_t> component;
  for (std::size_t c = 0; c < cube.cells.size(); ++c) {
    component.push_back(static_cast<std::int32_t>(cube.points[cube.cells[c][0]][0] * 4) - 1);
  }
  cube.arrays.push_back({"component", component});
  const Image image = draw({&cube, "component", {}, {}}, across_z(0.6));
  for (const Category& category : categories_of("component", {-1, 0, 1, 2})) {
    EXPECT_NEAR(image.count(category.colour) / kArea, 0.25, 0.02) << category.name;
  }
}

// A measure with eight values along x, -4 to 3: bands of as many cells, the last two values in one.
TEST(DrawSection, MeasuresAreDividedIntoBands) {
  LabelledCells cube = cube_cells(16);
  std::vector<double> height;
  height.reserve(cube.cells.size());
  for (const auto& cell : cube.cells) {
    double x = 0;
    for (const std::uint32_t v : cell) x += cube.points[v][0] / 4;
    height.push_back(std::floor(8 * x) - 4);
  }
  cube.arrays.push_back({"height", height});
  const Image image = draw({&cube, "height", {}, {}}, across_z(0.6));
  const std::vector<Category> bands = bands_of({-4, -3, -2, -1, 0, 1, 2, 3});
  for (const Category& band : bands) {
    EXPECT_NEAR(image.count_about(band.colour) / kArea, band.value == 6 ? 0.25 : 0.125, 0.02)
        << band.name;
  }
  EXPECT_GT(bands[0].colour.blue, bands[0].colour.red);  // below 0
  EXPECT_GT(bands[6].colour.red, bands[6].colour.blue);  // above
  // Nearly all of one value: still bands, of one width.
  std::fill(height.begin(), height.end(), 0.0);
  height[0] = 1;
  cube.arrays.back().values = height;
  EXPECT_GT(draw({&cube, "height", {}, {}}, across_z(0.6))
                    .count_about(
                        bands_of({0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1})[0].colour) /
                kArea,
            0.9);
}

TEST(DrawSections, ShareScaleAndPlace) {
  const LabelledCells cube = cube_cells(4);
  LabelledCells half = cube;
  for (Point3& p : half.points) p = {0.5 * p[0], 0.5 * p[1], p[2]};
  const SectionLayers whole_layers{&cube, "label", {}, {}};
  const SectionLayers half_layers{&half, "label", {}, {}};
  const auto sheet = [&](int columns, double z) {
    return decode(draw_sections({{whole_layers, across_z(z), "whole"},
                                 {half_layers, across_z(z), "half"},
                                 {whole_layers, across_z(2), "none"}},
                                columns, kPlain, PictureFormat::png));
  };
  const Image row = sheet(3, 0.5);
  const Image column = sheet(1, 0.5);
  const Image one = draw(whole_layers, across_z(0.5));
  EXPECT_EQ(row.width, 3 * column.width);
  EXPECT_EQ(column.height, 3 * row.height);
  EXPECT_GT(row.height, one.height);  // for the titles
  // The half one has a quarter of the area, the missed plane none.
  const auto interior = [](const Image& image) {
    return image.count(label_colour(0)) + image.count(label_colour(1));
  };
  EXPECT_NEAR(interior(row) / interior(one), 1.25, 0.02);
  EXPECT_THROW(sheet(3, 2), InputError);
}

TEST(DrawSection, SvgShowsOutlinesNotCells) {
  const LabelledCells coarse = cube_cells(4);
  const LabelledCells fine = cube_cells(24);
  const auto size = [](const LabelledCells& cells) {
    const std::string svg =
        draw_section({&cells, "label", {}, {}}, across_z(0.4), kPlain, PictureFormat::svg);
    EXPECT_THAT(svg, HasSubstr("<svg"));
    EXPECT_THAT(svg, HasSubstr("</svg>"));
    return static_cast<double>(svg.size());
  };
  // 36 times the cells, 6 times the outline, and the same text.
  EXPECT_LT(size(fine), 6 * size(coarse));
}

TEST(DrawSection, SamePictureEveryTime) {
  const LabelledCells cube = cube_cells(6);
  const auto once = [&] {
    return draw_section({&cube, "label", {}, {}}, across_z(0.4), {}, PictureFormat::png);
  };
  EXPECT_EQ(once(), once());
}

TEST(DrawSection, ErrorsSayWhatIsThere) {
  LabelledCells cube = cube_cells(2);
  cube.arrays.push_back({"ambiguous", std::vector<std::uint8_t>(cube.cells.size(), 0)});
  EXPECT_THAT(error_of<InputError>({&cube, "lable", {}, {}}, across_z(0.5)),
              HasSubstr("no cell array 'lable'; there are: label, phi, ambiguous"));
  EXPECT_THAT(error_of<InputError>({&cube, "label", {}, {}}, across_z(1.5)),
              HasSubstr("between 0 and 1"));
  EXPECT_THAT(error_of<InputError>({nullptr, "label", {}, {}}, across_z(0)),
              HasSubstr("nothing to cut"));
  EXPECT_THAT(error_of<UsageError>({&cube, "label", {}, {}}, across_z(0.5), {10, true}),
              HasSubstr("64 to 16384"));
  std::get<std::vector<std::uint8_t>>(cube.arrays[0].values).pop_back();
  EXPECT_THAT(error_of<InputError>({&cube, "label", {}, {}}, across_z(0.5)),
              HasSubstr("47 values for 48 cells"));
}

TEST(DrawSection, PlaneThroughASinglePointMisses) {
  LabelledCells corner;
  corner.points = kCorner;
  corner.cells = kOneCell;
  corner.arrays = {{"label", std::vector<std::uint8_t>{0}}};
  EXPECT_THAT(error_of<InputError>({&corner, "label", {}, {}}, across_z(1)), HasSubstr("misses"));
}

TEST(Categories, KnownArraysListBothValuesAscending) {
  const std::vector<Category> label = categories_of("label_bk", {-2, 7});
  ASSERT_EQ(label.size(), 4U);
  EXPECT_EQ(label[0].value, -2);
  EXPECT_EQ(label[1].name, "interior");
  EXPECT_EQ(label[2].name, "exterior");
  EXPECT_EQ(label[3].name, "label_bk 7");
  EXPECT_EQ(categories_of("ambiguous", {0})[1].name, "ambiguous");
}

}  // namespace
}  // namespace cellocut::viz
