// read_vtu: VTK's XML reader, with everything that it would print turned into an InputError.
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>
#include <optional>

#include "cellocut/base/errors.h"
#include "viz/vtu_file.h"

namespace cellocut::viz {

namespace {

// Keeps the first error message that VTK's reader or its parser raises.
class FirstError : public vtkCommand {
 public:
  static FirstError* New() { return new FirstError; }
  void Execute(vtkObject* /*caller*/, unsigned long event, void* data) override {
    if (event == vtkCommand::ErrorEvent) keep(static_cast<const char*>(data));
  }
  void keep(const char* text) {
    if (message_.empty() && text != nullptr) message_ = text;
    raised_ = true;
  }
  [[nodiscard]] bool raised() const { return raised_; }
  // "ERROR: In file.cxx, line 12\nvtkClass (0x1234): what is wrong\n\n" without all but the last
  // part.
  [[nodiscard]] std::string message() const {
    const std::size_t start = message_.find("): ");
    std::string text = start == std::string::npos ? message_ : message_.substr(start + 3);
    text = text.substr(0, text.find('\n'));
    return text.empty() ? "unreadable" : text;
  }

 private:
  std::string message_;
  bool raised_ = false;
};

// Receives what objects without an observer (the decompressors) would print.
class CapturingWindow : public vtkOutputWindow {
 public:
  static CapturingWindow* New() {
    auto* window = new CapturingWindow;
    window->InitializeObjectBase();
    return window;
  }
  void DisplayText(const char* /*text*/) override {}
  void DisplayErrorText(const char* text) override {
    if (errors != nullptr) errors->keep(text);
  }
  void DisplayWarningText(const char* /*text*/) override {}
  void DisplayGenericWarningText(const char* /*text*/) override {}
  void DisplayDebugText(const char* /*text*/) override {}
  FirstError* errors = nullptr;
};

// VTK's output window and logger are global: one reader at a time, and both are put back.
class QuietVtk {
 public:
  explicit QuietVtk(FirstError* errors) : lock_(mutex()) {
    previous_ = vtkOutputWindow::GetInstance();
    verbosity_ = vtkLogger::GetCurrentVerbosityCutoff();
    window_->errors = errors;
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~QuietVtk() {
    vtkOutputWindow::SetInstance(previous_);
    vtkLogger::SetStderrVerbosity(verbosity_);
  }
  QuietVtk(const QuietVtk&) = delete;
  QuietVtk& operator=(const QuietVtk&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::lock_guard<std::mutex> lock_;
  vtkNew<CapturingWindow> window_;
  vtkSmartPointer<vtkOutputWindow> previous_;
  vtkLogger::Verbosity verbosity_;
};

// VTK stops at the start of the appended data and would not miss the end of the file.
void check_file(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError("no such file", path);
  if (std::filesystem::is_directory(status)) throw InputError("is a directory", path);
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw InputError("cannot be opened", path);
  const std::streamoff size = file.tellg();
  if (size == 0) throw InputError("is empty", path);
  const std::streamoff tail = std::min<std::streamoff>(size, 64);
  std::string end(static_cast<std::size_t>(tail), '\0');
  file.seekg(size - tail);
  file.read(end.data(), tail);
  if (end.find("</VTKFile>") == std::string::npos) {
    throw InputError("not a VTK XML file, or truncated: it does not end with </VTKFile>", path);
  }
}

template <class T>
std::vector<T> copy_values(vtkDataArray& array) {
  std::vector<T> values(static_cast<std::size_t>(array.GetNumberOfTuples()));
  if (array.GetDataType() == vtkTypeTraits<T>::VTKTypeID()) {
    const T* first = static_cast<const T*>(array.GetVoidPointer(0));
    values.assign(first, first + values.size());
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<T>(array.GetComponent(static_cast<vtkIdType>(i), 0));
    }
  }
  return values;
}

bool is_integral(int vtk_type) { return vtk_type != VTK_FLOAT && vtk_type != VTK_DOUBLE; }

// Integers of other widths become Int32 where they fit, otherwise Float64.
ArrayValues cell_values(vtkDataArray& array) {
  switch (array.GetDataType()) {
    case VTK_UNSIGNED_CHAR:
      return copy_values<std::uint8_t>(array);
    case VTK_INT:
      return copy_values<std::int32_t>(array);
    case VTK_FLOAT:
      return copy_values<float>(array);
    default:
      break;
  }
  if (is_integral(array.GetDataType())) {
    double range[2] = {0, 0};
    array.GetRange(range, 0);
    if (range[0] >= std::numeric_limits<std::int32_t>::min() &&
        range[1] <= std::numeric_limits<std::int32_t>::max()) {
      return copy_values<std::int32_t>(array);
    }
  }
  return copy_values<double>(array);
}

std::optional<FieldValue> field_value(vtkAbstractArray& array) {
  if (array.GetName() == nullptr || array.GetNumberOfValues() != 1) return {};
  if (auto* text = vtkStringArray::SafeDownCast(&array)) {
    return FieldValue{array.GetName(), std::string(text->GetValue(0))};
  }
  auto* number = vtkDataArray::SafeDownCast(&array);
  if (number == nullptr) return {};
  if (!is_integral(number->GetDataType())) {
    return FieldValue{array.GetName(), number->GetComponent(0, 0)};
  }
  // Not through a double, which would round above 2^53.
  return FieldValue{array.GetName(),
                    static_cast<std::int64_t>(array.GetVariantValue(0).ToLongLong())};
}

void read_points(vtkUnstructuredGrid& grid, LabelledCells& result) {
  if (grid.GetPoints() == nullptr) return;
  result.points.resize(static_cast<std::size_t>(grid.GetNumberOfPoints()));
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    grid.GetPoint(static_cast<vtkIdType>(i), result.points[i].data());
    for (const double x : result.points[i]) {
      if (!std::isfinite(x)) {
        throw InputError("point " + std::to_string(i) + " has a coordinate that is not finite");
      }
    }
  }
}

void read_tetrahedra(vtkUnstructuredGrid& grid, LabelledCells& result) {
  const vtkIdType count = grid.GetNumberOfCells();
  result.cells.reserve(static_cast<std::size_t>(count));
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < count; ++c) {
    if (grid.GetCellType(c) != VTK_TETRA) {
      throw InputError("cell " + std::to_string(c) + " is not a tetrahedron");
    }
    grid.GetCellPoints(c, corners);
    if (corners->GetNumberOfIds() != 4) {
      throw InputError("cell " + std::to_string(c) + " does not have four corners");
    }
    std::array<std::uint32_t, 4> cell{};
    for (int k = 0; k < 4; ++k) {
      const vtkIdType v = corners->GetId(k);
      if (v < 0 || v >= grid.GetNumberOfPoints()) {
        throw InputError("cell " + std::to_string(c) + " has a corner out of range");
      }
      cell[k] = static_cast<std::uint32_t>(v);
    }
    result.cells.push_back(cell);
  }
}

void read_arrays(vtkUnstructuredGrid& grid, LabelledCells& result) {
  vtkCellData& data = *grid.GetCellData();
  for (int i = 0; i < data.GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data.GetArray(i);
    if (array == nullptr || array->GetName() == nullptr) continue;
    if (array->GetNumberOfComponents() != 1) continue;
    if (array->GetNumberOfTuples() != grid.GetNumberOfCells()) {
      throw InputError("cell array '" + std::string(array->GetName()) + "' holds " +
                       std::to_string(array->GetNumberOfTuples()) + " values for " +
                       std::to_string(grid.GetNumberOfCells()) + " cells");
    }
    result.arrays.push_back({array->GetName(), cell_values(*array)});
  }
  vtkFieldData& fields = *grid.GetFieldData();
  for (int i = 0; i < fields.GetNumberOfArrays(); ++i) {
    if (std::optional<FieldValue> field = field_value(*fields.GetAbstractArray(i))) {
      result.fields.push_back(std::move(*field));
    }
  }
}

LabelledCells read_unchecked(const std::string& path) {
  vtkNew<FirstError> errors;
  const QuietVtk quiet(errors);
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetReaderErrorObserver(errors);
  reader->SetParserErrorObserver(errors);
  reader->AddObserver(vtkCommand::ErrorEvent, errors);
  reader->SetFileName(path.c_str());
  reader->Update();
  if (errors->raised()) throw InputError("not a readable VTU file: " + errors->message());
  vtkUnstructuredGrid* grid = reader->GetOutput();
  if (grid == nullptr || reader->GetErrorCode() != 0) {
    throw InputError("not a readable VTU file");
  }
  LabelledCells result;
  read_points(*grid, result);
  read_tetrahedra(*grid, result);
  read_arrays(*grid, result);
  return result;
}

}  // namespace

LabelledCells read_vtu(const std::string& path) {
  check_file(path);
  try {
    return read_unchecked(path);
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  } catch (const std::exception& error) {
    // A damaged header may ask for any amount of memory.
    throw InputError(std::string("not a readable VTU file: ") + error.what(), path);
  }
}

}  // namespace cellocut::viz
