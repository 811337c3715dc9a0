// The colours of a file's vertices, collected as they are met. Internal to the mesh readers.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "cellocut/mesh/triangle_soup.h"

namespace cellocut::mesh_io {

class VertexColours {
 public:
  // Red, green, blue and perhaps opacity of a point, as the file has them. The opacity is left out,
  // but for what it says of the range. A colour that is not of finite numbers is none at all.
  // Precondition: at least three components; every point comes at most once, in increasing order.
  void set(std::size_t point, std::span<const double> components);
  // The value of full brightness; 0, the default: 255 where any component is above 1, else 1.
  void set_full(double full) { full_ = full; }

  // Rounded to nearest and clamped; white for points without a colour; empty where no point has
  // one. O(points).
  [[nodiscard]] std::vector<Rgb> finish(std::size_t point_count) const;

 private:
  using Components = std::array<float, 3>;
  // Up to the last point with a colour; NaN where there is none.
  std::vector<Components> components_;
  double largest_ = 0;
  double full_ = 0;
};

}  // namespace cellocut::mesh_io
