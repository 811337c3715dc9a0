#include "viz/vtp_file.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>
#include <vtkXMLPolyDataWriter.h>

#include "cellocut/base/errors.h"
#include "viz/vtk_arrays.h"

namespace cellocut::viz {

namespace {

void require_one_per_point(const std::string& name, std::size_t count,
                           const TriangleSoup& surface) {
  if (count == surface.points.size()) return;
  throw InputError("point array '" + name + "' holds " + std::to_string(count) + " values for " +
                   std::to_string(surface.points.size()) + " points");
}

void set_triangles(vtkPolyData& data, const TriangleSoup& surface) {
  const auto count = static_cast<vtkIdType>(surface.triangles.size());
  vtkNew<vtkTypeInt64Array> offsets;
  offsets->SetNumberOfValues(count + 1);
  for (vtkIdType f = 0; f <= count; ++f) offsets->SetValue(f, 3 * f);
  vtkNew<vtkTypeInt64Array> connectivity;
  connectivity->SetNumberOfValues(3 * count);
  vtkTypeInt64* corner = connectivity->GetPointer(0);
  for (const Triangle& triangle : surface.triangles) {
    for (const std::uint32_t v : triangle) *corner++ = v;
  }
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(offsets.Get(), connectivity.Get());
  data.SetPolys(triangles);
}

}  // namespace

std::string encode_vtp(const TriangleSoup& surface, std::span<const VertexAttribute> arrays,
                       std::span<const FieldValue> fields, std::span<const CellArray> faces) {
  vtkNew<vtkPolyData> data;
  data->SetPoints(borrow_points(surface.points));
  set_triangles(*data, surface);
  for (const VertexAttribute& attribute : arrays) {
    require_one_per_point(attribute.name, attribute.size(), surface);
    const vtkSmartPointer<vtkDataArray> values = std::visit(BorrowArray{}, attribute.values);
    values->SetName(attribute.name.c_str());
    data->GetPointData()->AddArray(values);
  }
  if (!surface.colours.empty()) {
    require_one_per_point("RGB", surface.colours.size(), surface);
    const vtkSmartPointer<vtkDataArray> colours =
        borrow<vtkUnsignedCharArray>(surface.colours.front().data(), 3 * surface.colours.size());
    colours->SetNumberOfComponents(3);
    colours->SetName("RGB");
    data->GetPointData()->AddArray(colours);
    data->GetPointData()->SetActiveScalars("RGB");
  }
  for (const CellArray& array : faces) {
    require_length(array, surface.triangles.size());
    const vtkSmartPointer<vtkDataArray> values = std::visit(BorrowArray{}, array.values);
    values->SetName(array.name.c_str());
    data->GetCellData()->AddArray(values);
  }
  for (const FieldValue& field : fields) data->GetFieldData()->AddArray(make_field_array(field));
  vtkNew<vtkXMLPolyDataWriter> writer;
  return encode_xml(*writer, *data, "the surface");
}

}  // namespace cellocut::viz
