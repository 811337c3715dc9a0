// Fields whose grid values are set one by one, and fields taken apart again, for tests.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "cellocut/field/sparse_grid.h"

namespace cellocut::testing {

// In [low, high); the standard distributions differ between libraries, the engine does not.
inline double uniform(std::mt19937_64& engine, double low = 0, double high = 1) {
  return low + (high - low) * (static_cast<double>(engine() >> 11U) / 9007199254740992.0);
}

// Every grid point of [low, low + size) gets value(x, y, z), with x, y, z from 0, and is stored.
template <class Value>
SparseField stored_block(const openvdb::Coord& low, int size, const Value& value) {
  auto grid = std::make_shared<SparseField::Grid>();
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      for (int z = 0; z < size; ++z) {
        grid->tree.setValueOn(low.offsetBy(x, y, z), static_cast<float>(value(x, y, z)));
      }
    }
  }
  return SparseField(std::move(grid));
}

// The same with one layer of outside points around it, so that the zero set is closed.
template <class Value>
SparseField closed_block(const openvdb::Coord& low, int size, const Value& value) {
  return stored_block(low.offsetBy(-1), size + 2, [&](int x, int y, int z) {
    const auto beyond = [size](int i) { return i == 0 || i == size + 1; };
    return beyond(x) || beyond(y) || beyond(z) ? 1.5 : value(x - 1, y - 1, z - 1);
  });
}

struct StoredValue {
  std::array<int, 3> at;
  float value;
  auto operator<=>(const StoredValue&) const = default;
};

// All stored values, in the order of the tree.
inline std::vector<StoredValue> stored_values(const SparseField& field) {
  std::vector<StoredValue> values;
  for (auto value = field.grid().tree.cbeginValueOn(); value; ++value) {
    const openvdb::Coord at = value.getCoord();
    values.push_back({{at.x(), at.y(), at.z()}, *value});
  }
  return values;
}

}  // namespace cellocut::testing
