// Colours and names of categorical values, the same in every picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cellocut::viz {

struct Colour {
  double red = 0;
  double green = 0;
  double blue = 0;
};

// What a value of a categorical array means and looks like.
struct Category {
  std::int32_t value = 0;
  std::string name;
  Colour colour;
};

// The categories of the array `array_name` whose values in the picture are `present` (ascending,
// distinct). Arrays whose values are known by convention (label, label_*, ambiguous, anchored)
// always list all of them, so that legends compare; other values get distinct colours by their
// value.
std::vector<Category> categories_of(const std::string& array_name,
                                    const std::vector<std::int32_t>& present);

// The bands between `borders` (ascending, at least two): from pale to dark, or, with 0 among the
// inner borders, blue below it and red above. Values are 0, 1, ... by band.
std::vector<Category> bands_of(const std::vector<double>& borders);

// Colours of the lines and fills of the i-th surface.
Colour surface_line_colour(std::size_t i);
Colour surface_fill_colour(std::size_t i);

}  // namespace cellocut::viz
