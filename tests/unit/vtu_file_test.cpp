// VTU files: what we write is read back by VTK's own reader and by ours, array by array.
#include "viz/vtu_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "cellocut/base/errors.h"

namespace cellocut::viz {
namespace {

using ::testing::HasSubstr;

// A fan of tetrahedra around the origin with values that no other type could hold.
LabelledCells example_cells(std::uint32_t count = 50) {
  LabelledCells cells;
  cells.points.push_back({0, 0, 0});
  for (std::uint32_t i = 0; i < count + 2; ++i) {
    const double angle = 0.1 * i;
    cells.points.push_back({std::cos(angle) / 3, std::sin(angle) / 3, 1e-9 * i});
  }
  std::vector<std::uint8_t> label;
  std::vector<std::uint8_t> initial;
  std::vector<float> phi;
  std::vector<double> volume;
  std::vector<std::int32_t> component;
  for (std::uint32_t i = 1; i <= count; ++i) {
    cells.cells.push_back({0, i, i + 1, i + 2});
    label.push_back(static_cast<std::uint8_t>(i % 2));
    initial.push_back(static_cast<std::uint8_t>(i % 3 == 0));
    phi.push_back(static_cast<float>(i) / 7.0F - 3.0F);
    volume.push_back(1.0 / i);
    component.push_back(static_cast<std::int32_t>(i) - 100000);
  }
  cells.arrays = {{"label_initial", initial},
                  {"label", label},
                  {"phi", phi},
                  {"volume", volume},
                  {"component", component}};
  cells.fields = {{"energy", 0.1},
                  {"cut_value", std::int64_t{(1LL << 61) + 1}},
                  {"legend", std::string("0 interior, 1 exterior; <&\"'> \xC3\xA9")},
                  {"empty", std::string()}};
  return cells;
}

class VtuFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("cellocut-vtu-" + std::to_string(::getpid()) + "-" +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / "cells.vtu").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  }
  // The message of the InputError that reading gives, or what happened instead. VTK must print
  // nothing.
  [[nodiscard]] std::string error_of_reading() const {
    ::testing::internal::CaptureStderr();
    std::string result = "no error";
    try {
      read_vtu(path_);
    } catch (const InputError& error) {
      EXPECT_EQ(error.file(), path_);
      result = error.what();
    }
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    return result;
  }

  std::filesystem::path folder_;
  std::string path_;
};

TEST_F(VtuFile, VtkReadsPointsCellsArraysAndFields) {
  const LabelledCells cells = example_cells();
  write(encode_vtu(cells));
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName(path_.c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();

  ASSERT_EQ(grid->GetNumberOfPoints(), static_cast<vtkIdType>(cells.points.size()));
  EXPECT_EQ(grid->GetPoints()->GetDataType(), VTK_DOUBLE);
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) {
    Point3 p{};
    grid->GetPoint(i, p.data());
    EXPECT_EQ(p, cells.points[i]);
  }
  ASSERT_EQ(grid->GetNumberOfCells(), static_cast<vtkIdType>(cells.cells.size()));
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    EXPECT_EQ(grid->GetCellType(c), VTK_TETRA);
    grid->GetCellPoints(c, corners);
    ASSERT_EQ(corners->GetNumberOfIds(), 4);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(corners->GetId(k), cells.cells[c][k]);
  }

  vtkCellData* data = grid->GetCellData();
  ASSERT_EQ(data->GetNumberOfArrays(), 5);
  const std::vector<int> types = {VTK_UNSIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_FLOAT, VTK_DOUBLE,
                                  VTK_INT};
  for (int a = 0; a < 5; ++a) {
    vtkDataArray* array = data->GetArray(a);
    EXPECT_EQ(array->GetName(), cells.arrays[a].name);
    EXPECT_EQ(array->GetDataType(), types[a]) << array->GetName();
    std::visit(
        [&](const auto& values) {
          ASSERT_EQ(array->GetNumberOfTuples(), static_cast<vtkIdType>(values.size()));
          for (std::size_t i = 0; i < values.size(); ++i) {
            EXPECT_EQ(array->GetComponent(static_cast<vtkIdType>(i), 0),
                      static_cast<double>(values[i]))
                << array->GetName() << " " << i;
          }
        },
        cells.arrays[a].values);
  }
  ASSERT_NE(data->GetScalars(), nullptr);
  EXPECT_STREQ(data->GetScalars()->GetName(), "label");

  vtkFieldData* fields = grid->GetFieldData();
  ASSERT_EQ(fields->GetNumberOfArrays(), 4);
  EXPECT_EQ(fields->GetArray("energy")->GetDataType(), VTK_DOUBLE);
  EXPECT_EQ(fields->GetArray("energy")->GetComponent(0, 0), 0.1);
  EXPECT_EQ(fields->GetAbstractArray("cut_value")->GetVariantValue(0).ToLongLong(),
            (1LL << 61) + 1);
  const auto* legend = vtkStringArray::SafeDownCast(fields->GetAbstractArray("legend"));
  ASSERT_NE(legend, nullptr);
  EXPECT_EQ(const_cast<vtkStringArray*>(legend)->GetValue(0),
            std::get<std::string>(cells.fields[2].value));
}

TEST_F(VtuFile, OurReaderReturnsWhatWasWritten) {
  const LabelledCells cells = example_cells();
  write(encode_vtu(cells));
  const LabelledCells back = read_vtu(path_);
  EXPECT_EQ(back.points, cells.points);
  EXPECT_EQ(back.cells, cells.cells);
  ASSERT_EQ(back.arrays.size(), cells.arrays.size());
  for (std::size_t i = 0; i < cells.arrays.size(); ++i) {
    EXPECT_EQ(back.arrays[i].name, cells.arrays[i].name);
    EXPECT_EQ(back.arrays[i].values, cells.arrays[i].values) << cells.arrays[i].name;
  }
  ASSERT_EQ(back.fields.size(), cells.fields.size());
  for (std::size_t i = 0; i < cells.fields.size(); ++i) {
    EXPECT_EQ(back.fields[i].name, cells.fields[i].name);
    EXPECT_EQ(back.fields[i].value, cells.fields[i].value) << cells.fields[i].name;
  }
  ASSERT_NE(back.find("phi"), nullptr);
  EXPECT_EQ(back.find("psi"), nullptr);
}

TEST_F(VtuFile, LayoutIsAppendedRawCompressedWith64BitHeadersAndConnectivity) {
  const std::string bytes = encode_vtu(example_cells());
  EXPECT_THAT(bytes, HasSubstr("<AppendedData encoding=\"raw\">"));
  EXPECT_THAT(bytes, HasSubstr("compressor=\"vtkZLibDataCompressor\""));
  EXPECT_THAT(bytes, HasSubstr("header_type=\"UInt64\""));
  EXPECT_THAT(bytes, HasSubstr("type=\"Int64\" Name=\"connectivity\" format=\"appended\""));
  EXPECT_THAT(bytes, HasSubstr("CellData Scalars=\"label\""));
  EXPECT_EQ(bytes, encode_vtu(example_cells())) << "the same cells give the same bytes";
}

TEST_F(VtuFile, ManyCellsSpanSeveralCompressionBlocks) {
  const LabelledCells cells = example_cells(100000);
  write(encode_vtu(cells));
  const LabelledCells back = read_vtu(path_);
  EXPECT_EQ(back.points, cells.points);
  EXPECT_EQ(back.cells, cells.cells);
  for (std::size_t i = 0; i < cells.arrays.size(); ++i) {
    EXPECT_EQ(back.arrays[i].values, cells.arrays[i].values) << cells.arrays[i].name;
  }
}

TEST_F(VtuFile, NoCellsAtAll) {
  write(encode_vtu(LabelledCells{}));
  EXPECT_TRUE(read_vtu(path_).cells.empty());
}

TEST_F(VtuFile, LengthMismatchIsRefused) {
  LabelledCells cells = example_cells();
  std::get<std::vector<float>>(cells.arrays[2].values).pop_back();
  try {
    encode_vtu(cells);
    FAIL() << "a short array was written";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'phi' holds 49 values for 50 cells"));
  }
}

TEST_F(VtuFile, TruncationAnywhereIsAnError) {
  const std::string bytes = encode_vtu(example_cells());
  for (const double share : {0.0, 0.01, 0.2, 0.5, 0.8, 0.99}) {
    write(bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
    EXPECT_NE(error_of_reading(), "no error") << share;
  }
}

TEST_F(VtuFile, DataCutOutOfTheMiddleIsAnError) {
  const std::string bytes = encode_vtu(example_cells(2000));
  const std::size_t start = bytes.find("<AppendedData");
  ASSERT_NE(start, std::string::npos);
  write(bytes.substr(0, start + 200) + "\n  </AppendedData>\n</VTKFile>\n");
  EXPECT_NE(error_of_reading(), "no error");
}

TEST_F(VtuFile, DamagedCompressedDataIsAnError) {
  std::string bytes = encode_vtu(example_cells(2000));
  const std::size_t middle = (bytes.find("<AppendedData") + bytes.size()) / 2;
  for (std::size_t i = 0; i < 64; ++i) bytes[middle + i] = static_cast<char>(~bytes[middle + i]);
  write(bytes);
  EXPECT_NE(error_of_reading(), "no error");
}

// Any byte of the file may be wrong: an error or a readable file, never a crash, never VTK's own
// words.
TEST_F(VtuFile, FlippedBytesNeverCrash) {
  const std::string bytes = encode_vtu(example_cells());
  std::mt19937 random(7);
  int refused = 0;
  for (int round = 0; round < 150; ++round) {
    std::string damaged = bytes;
    for (int flips = 0; flips < 3; ++flips) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    write(damaged);
    if (error_of_reading() != "no error") ++refused;
  }
  EXPECT_GT(refused, 75);
}

TEST_F(VtuFile, OtherFilesAreErrors) {
  EXPECT_THAT(error_of_reading(), HasSubstr("no such file"));
  write("");
  EXPECT_THAT(error_of_reading(), HasSubstr("empty"));
  write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_THAT(error_of_reading(), HasSubstr("</VTKFile>"));
  write("<VTKFile type=\"PolyData\"><PolyData></PolyData></VTKFile>");
  EXPECT_NE(error_of_reading(), "no error");
  std::filesystem::remove(path_);
  std::filesystem::create_directory(path_);
  EXPECT_THAT(error_of_reading(), HasSubstr("is a directory"));
}

std::string ascii_vtu(const std::string& connectivity, int type, const std::string& coordinate) {
  const std::string corners = type == 10 ? "4" : "3";
  return "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
         "<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n"
         "<CellData><DataArray type=\"UInt16\" Name=\"zone\" format=\"ascii\">65535</DataArray>\n"
         "<DataArray type=\"Float32\" Name=\"vector\" NumberOfComponents=\"3\" "
         "format=\"ascii\">1 2 3</DataArray></CellData>\n"
         "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">\n"
         "0 0 0 1 0 0 0 1 0 0 0 " +
         coordinate +
         "</DataArray></Points>\n"
         "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" +
         connectivity + "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" +
         corners + "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" +
         std::to_string(type) + "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>\n";
}

TEST_F(VtuFile, OtherProgramsTypesAreConverted) {
  write(ascii_vtu("0 1 2 3", 10, "1.5"));
  const LabelledCells cells = read_vtu(path_);
  EXPECT_EQ(cells.points.back(), (Point3{0, 0, 1.5}));
  ASSERT_EQ(cells.arrays.size(), 1U) << "vectors are left out";
  EXPECT_EQ(cells.arrays[0].values, ArrayValues(std::vector<std::int32_t>{65535}));
}

TEST_F(VtuFile, OtherCellsBadCornersAndNanAreErrors) {
  write(ascii_vtu("0 1 2", 5, "1"));
  EXPECT_THAT(error_of_reading(), HasSubstr("not a tetrahedron"));
  write(ascii_vtu("0 1 2 4", 10, "1"));
  EXPECT_NE(error_of_reading(), "no error");
  write(ascii_vtu("0 1 2 -1", 10, "1"));
  EXPECT_NE(error_of_reading(), "no error");
  write(ascii_vtu("0 1 2 3", 10, "nan"));
  EXPECT_NE(error_of_reading(), "no error");
}

}  // namespace
}  // namespace cellocut::viz
