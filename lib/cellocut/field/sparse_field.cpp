#include "cellocut/field/sparse_field.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "cellocut/field/sparse_grid.h"

namespace cellocut {

std::vector<float> SparseField::sample(const std::vector<Point3>& index_points) const {
  std::vector<float> values(index_points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, index_points.size(), 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      FieldSampler sampler(*this);
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        values[i] = static_cast<float>(sampler(index_points[i]));
                      }
                    });
  return values;
}

std::int64_t SparseField::stored_values() const {
  return empty() ? 0 : static_cast<std::int64_t>(grid_->tree.activeVoxelCount());
}

std::int64_t SparseField::bytes() const {
  return empty() ? 0 : static_cast<std::int64_t>(grid_->tree.memUsage());
}

}  // namespace cellocut
