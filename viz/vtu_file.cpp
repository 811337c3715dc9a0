#include "viz/vtu_file.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cstddef>

#include "cellocut/base/errors.h"
#include "viz/vtk_arrays.h"

namespace cellocut::viz {

namespace {

void set_tetrahedra(vtkUnstructuredGrid& grid, const LabelledCells& cells) {
  const auto count = static_cast<vtkIdType>(cells.cells.size());
  vtkNew<vtkTypeInt64Array> offsets;
  offsets->SetNumberOfValues(count + 1);
  vtkNew<vtkTypeInt64Array> connectivity;
  connectivity->SetNumberOfValues(4 * count);
  for (vtkIdType c = 0; c <= count; ++c) offsets->SetValue(c, 4 * c);
  vtkTypeInt64* corner = connectivity->GetPointer(0);
  for (const auto& cell : cells.cells) {
    for (const std::uint32_t v : cell) *corner++ = v;
  }
  vtkNew<vtkCellArray> tetrahedra;
  tetrahedra->SetData(offsets.Get(), connectivity.Get());
  grid.SetCells(VTK_TETRA, tetrahedra);
}

}  // namespace

const CellArray* LabelledCells::find(const std::string& name) const {
  const auto it = std::find_if(arrays.begin(), arrays.end(),
                               [&](const CellArray& array) { return array.name == name; });
  return it == arrays.end() ? nullptr : &*it;
}

std::string encode_vtu(const LabelledCells& cells) {
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(borrow_points(cells.points));
  set_tetrahedra(*grid, cells);

  for (const CellArray& array : cells.arrays) {
    require_length(array, cells.cells.size());
    const vtkSmartPointer<vtkDataArray> values = std::visit(BorrowArray{}, array.values);
    values->SetName(array.name.c_str());
    grid->GetCellData()->AddArray(values);
  }
  const CellArray* label = cells.find("label");
  if (label != nullptr && std::holds_alternative<std::vector<std::uint8_t>>(label->values)) {
    grid->GetCellData()->SetActiveScalars("label");
  }
  for (const FieldValue& field : cells.fields) {
    grid->GetFieldData()->AddArray(make_field_array(field));
  }

  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  return encode_xml(*writer, *grid, "the labelled cells");
}

}  // namespace cellocut::viz
