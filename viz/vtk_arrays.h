// What the writers of VTK's XML files share. Internal to them: nothing else includes VTK.
#pragma once

#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cellocut/base/point.h"
#include "viz/vtu_file.h"

class vtkAbstractArray;
class vtkDataObject;
class vtkXMLWriter;

namespace cellocut::viz {

// Shows `values` to VTK without a copy: VTK neither writes to nor frees what it is given here, and
// the data set does not outlive the call that encodes it.
template <class VtkArray, class T>
vtkSmartPointer<vtkDataArray> borrow(const T* values, std::size_t count) {
  const vtkSmartPointer<VtkArray> array = vtkSmartPointer<VtkArray>::New();
  array->SetArray(const_cast<T*>(values), static_cast<vtkIdType>(count), 1);
  return array;
}

struct BorrowArray {
  vtkSmartPointer<vtkDataArray> operator()(const std::vector<std::uint8_t>& v) const {
    return borrow<vtkUnsignedCharArray>(v.data(), v.size());
  }
  vtkSmartPointer<vtkDataArray> operator()(const std::vector<std::int32_t>& v) const {
    return borrow<vtkIntArray>(v.data(), v.size());
  }
  vtkSmartPointer<vtkDataArray> operator()(const std::vector<float>& v) const {
    return borrow<vtkFloatArray>(v.data(), v.size());
  }
  vtkSmartPointer<vtkDataArray> operator()(const std::vector<double>& v) const {
    return borrow<vtkDoubleArray>(v.data(), v.size());
  }
};

// Errors: InputError where the array has not one value for each of so many cells.
void require_length(const CellArray& array, std::size_t cells);

// The points, as Float64, without a copy.
vtkSmartPointer<vtkPoints> borrow_points(const std::vector<Point3>& points);

vtkSmartPointer<vtkAbstractArray> make_field_array(const FieldValue& field);

// The bytes of the file: appended, compressed, 64-bit headers. Errors: Error where VTK fails, which
// calls the data `what`.
std::string encode_xml(vtkXMLWriter& writer, vtkDataObject& data, const std::string& what);

}  // namespace cellocut::viz
