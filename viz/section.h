// A plane through labelled cells or surfaces as a picture: how a filled body is told from a hollow
// shell.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cellocut/base/point.h"
#include "cellocut/mesh/triangle_soup.h"
#include "viz/vtu_file.h"

namespace cellocut::viz {

// The points x with dot(normal, x) = offset. `normal` need not have unit length, but not be zero.
struct Plane {
  Point3 normal{0, 0, 1};
  double offset = 0;
};
// "x=0.5", "y=50%" (per cent of the box's edge along that axis), or "nx,ny,nz,offset".
// Errors: UsageError that says what is taken.
Plane parse_plane(const std::string& text, const Box3& box);

struct SectionLayers {
  const LabelledCells* cells = nullptr;  // filled, one colour per value of `colour_by`
  // A cell array: of integers each value has a colour; measures are divided into bands that hold
  // about as many cells each, with 0 as a border where there are both signs.
  std::string colour_by = "label";
  // Closed surfaces are filled by even-odd rule, all are drawn as lines.
  std::vector<const TriangleSoup*> surfaces;
  std::vector<std::string> surface_names;  // for the legend; "surface 1", ... where there are fewer
};
struct SectionStyle {
  int width = 1200;        // pixels of the longer edge of the drawing
  bool cell_edges = true;  // thin lines between cells
};

enum class PictureFormat { png, svg };

// A picture of several.
struct SectionPanel {
  SectionLayers layers;
  Plane plane;
  std::string title;  // above it; may be empty
};

// The bytes of the picture: up direction and handedness fixed by the plane, a scale bar, a legend
// of the values, the plane's equation. A point on the plane counts as above it, so a plane along
// the top of a body shows its top and one along its bottom misses. O(n) in the size of the layers.
// The bytes of an SVG may differ from call to call (cairo numbers its definitions); what they show
// does not. Errors: InputError where the plane misses everything or the array is not there (it
// lists those that are); UsageError where the width is not within 64 to 16384.
std::string draw_section(const SectionLayers& layers, const Plane& plane, const SectionStyle& style,
                         PictureFormat format);

// Panels in rows of `columns`, all to one scale and about the same place of the plane, so that they
// compare; a plane that misses leaves its panel empty. Errors: as draw_section, where all miss, and
// where the picture would have an edge of more than 32767 pixels. Preconditions: panels, columns
// >= 1.
std::string draw_sections(const std::vector<SectionPanel>& panels, int columns,
                          const SectionStyle& style, PictureFormat format);

}  // namespace cellocut::viz
