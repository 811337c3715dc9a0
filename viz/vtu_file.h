// Labelled tetrahedra as a VTK unstructured grid for ParaView: appended, compressed, 64-bit
// headers.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cellocut/complex/tet_complex.h"

namespace cellocut::viz {

// One value per cell. Names follow the conventions: label_initial, label, label_<solver>,
// ambiguous, anchored (UInt8), phi (Float32, input units), volume (Float64), component (Int32).
using ArrayValues = std::variant<std::vector<std::uint8_t>, std::vector<std::int32_t>,
                                 std::vector<float>, std::vector<double>>;
struct CellArray {
  std::string name;
  ArrayValues values;
};
// Data about the whole file (parameters, energy, bound, version, a legend of the labels).
struct FieldValue {
  std::string name;
  std::variant<double, std::int64_t, std::string> value;
};

struct LabelledCells {
  std::vector<Point3> points;
  std::vector<std::array<std::uint32_t, 4>> cells;
  std::vector<CellArray> arrays;
  std::vector<FieldValue> fields;

  // The array of that name, or nullptr.
  [[nodiscard]] const CellArray* find(const std::string& name) const;
};

// The bytes of a .vtu file (the caller writes them through AtomicFile). The first UInt8 array named
// `label`, where there is one, is the active scalar.
// Errors: InputError where an array's length is not the number of cells.
std::string encode_vtu(const LabelledCells& cells);

// Reads a .vtu that holds tetrahedra, ours or another program's. Left out: arrays and field data
// with more than one component per cell or value. Integers of other widths become Int32 where they
// fit, otherwise Float64. One reader works at a time, as VTK's error output is global. Errors:
// InputError with the path: not there, a directory, empty, truncated, damaged, cells of other
// types, corners out of range, coordinates that are not finite.
LabelledCells read_vtu(const std::string& path);

}  // namespace cellocut::viz
