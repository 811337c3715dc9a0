// A scalar field on the grid of a Frame, stored only near its zero set.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cellocut/base/point.h"

namespace cellocut {

// Half the width of the stored band in grid steps: values with |value| < kBand are stored.
// A cell of the grid that the zero set cuts has all eight corners in the band as long as the field
// is 1-Lipschitz: a cut edge has a zero within one step of both ends, and no corner of the cell is
// further than sqrt(3) < 2 steps from that zero.
inline constexpr float kBand = 2.0F;

// Values are in grid steps (distance / h), negative inside. Cheap to copy (shares the grid).
class SparseField {
 public:
  struct Grid;  // the sparse tree behind it; see sparse_grid.h

  SparseField() = default;
  explicit SparseField(std::shared_ptr<const Grid> grid) : grid_(std::move(grid)) {}

  [[nodiscard]] bool empty() const { return grid_ == nullptr; }
  [[nodiscard]] const Grid& grid() const { return *grid_; }

  // Trilinear interpolation at index coordinates, clamped to [-kBand, kBand] away from the band.
  // Parallel; O(points).
  [[nodiscard]] std::vector<float> sample(const std::vector<Point3>& index_points) const;

  [[nodiscard]] std::int64_t stored_values() const;
  [[nodiscard]] std::int64_t bytes() const;

 private:
  std::shared_ptr<const Grid> grid_;
};

}  // namespace cellocut
