// VTP files: what we write is read back by VTK itself, array by array.
#include "viz/vtp_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkCellArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLPolyDataReader.h>

#include "cellocut/base/errors.h"

namespace cellocut::viz {
namespace {

using ::testing::HasSubstr;

TriangleSoup fan(std::uint32_t count) {
  TriangleSoup surface;
  for (std::uint32_t i = 0; i < count + 2; ++i) {
    surface.points.push_back({0.1 * i, 1.0 / (i + 1), 1e-9 * i});
    surface.colours.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(3 * i), 7});
  }
  for (std::uint32_t i = 1; i <= count; ++i) surface.triangles.push_back({0, i, i + 1});
  return surface;
}

std::vector<VertexAttribute> values_for(const TriangleSoup& surface) {
  std::vector<std::int32_t> face;
  std::vector<double> distance;
  std::vector<std::uint8_t> supported;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    face.push_back(static_cast<std::int32_t>(i) * 100000 - 1);
    distance.push_back(1.0 / static_cast<double>(i + 3));
    supported.push_back(i % 2 == 0 ? 1 : 0);
  }
  return {{"nearest_face", face}, {"distance", distance}, {"supported", supported}};
}

void read_back(const std::string& bytes, vtkXMLPolyDataReader& reader) {
  reader.ReadFromInputStringOn();
  reader.SetInputString(bytes);
  reader.Update();
}

TEST(VtpFile, VtkReadsPointsTrianglesArraysAndFields) {
  for (const std::uint32_t count : {5U, 100000U}) {  // the second spans many compression blocks
    const TriangleSoup surface = fan(count);
    const std::vector<VertexAttribute> arrays = values_for(surface);
    const std::vector<FieldValue> fields{{"cellocut_version", std::string("1.2.3")}};
    const vtkNew<vtkXMLPolyDataReader> reader;
    read_back(encode_vtp(surface, arrays, fields), *reader);
    vtkPolyData* data = reader->GetOutput();

    ASSERT_EQ(data->GetNumberOfPoints(), static_cast<vtkIdType>(surface.points.size()));
    EXPECT_EQ(data->GetPoints()->GetDataType(), VTK_DOUBLE);
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
      Point3 p{};
      data->GetPoint(i, p.data());
      ASSERT_EQ(p, surface.points[static_cast<std::size_t>(i)]);
    }
    ASSERT_EQ(data->GetNumberOfPolys(), static_cast<vtkIdType>(surface.triangles.size()));
    const vtkNew<vtkIdList> corners;
    for (vtkIdType f = 0; f < data->GetNumberOfPolys(); ++f) {
      data->GetPolys()->GetCellAtId(f, corners);
      ASSERT_EQ(corners->GetNumberOfIds(), 3);
      for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(corners->GetId(k),
                  surface.triangles[static_cast<std::size_t>(f)][static_cast<std::size_t>(k)]);
      }
    }

    vtkPointData* values = data->GetPointData();
    ASSERT_EQ(values->GetNumberOfArrays(), 4);
    const std::vector<int> types = {VTK_INT, VTK_DOUBLE, VTK_UNSIGNED_CHAR};
    for (std::size_t a = 0; a < arrays.size(); ++a) {
      vtkDataArray* array = values->GetArray(arrays[a].name.c_str());
      ASSERT_NE(array, nullptr) << arrays[a].name;
      EXPECT_EQ(array->GetDataType(), types[a]) << arrays[a].name;
      EXPECT_EQ(array->GetNumberOfComponents(), 1);
      ASSERT_EQ(array->GetNumberOfTuples(), data->GetNumberOfPoints());
      std::visit(
          [&](const auto& expected) {
            for (std::size_t i = 0; i < expected.size(); ++i) {
              ASSERT_EQ(array->GetComponent(static_cast<vtkIdType>(i), 0),
                        static_cast<double>(expected[i]))
                  << arrays[a].name << " " << i;
            }
          },
          arrays[a].values);
    }
    vtkDataArray* colours = values->GetArray("RGB");
    ASSERT_NE(colours, nullptr);
    EXPECT_EQ(values->GetScalars(), colours);
    EXPECT_EQ(colours->GetDataType(), VTK_UNSIGNED_CHAR);
    ASSERT_EQ(colours->GetNumberOfComponents(), 3);
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        ASSERT_EQ(colours->GetComponent(static_cast<vtkIdType>(i), k),
                  surface.colours[i][static_cast<std::size_t>(k)]);
      }
    }
    ASSERT_NE(data->GetFieldData()->GetAbstractArray("cellocut_version"), nullptr);
  }
}

TEST(VtpFile, LayoutIsAppendedRawCompressedWith64BitHeaders) {
  const TriangleSoup surface = fan(5);
  const std::string bytes = encode_vtp(surface, values_for(surface));
  EXPECT_THAT(bytes, HasSubstr("type=\"PolyData\""));
  EXPECT_THAT(bytes, HasSubstr("<AppendedData encoding=\"raw\">"));
  EXPECT_THAT(bytes, HasSubstr("compressor=\"vtkZLibDataCompressor\""));
  EXPECT_THAT(bytes, HasSubstr("header_type=\"UInt64\""));
  EXPECT_EQ(bytes, encode_vtp(surface, values_for(surface))) << "the same surface, the same bytes";
}

TEST(VtpFile, WithoutColoursOrAnythingAtAll) {
  TriangleSoup surface = fan(5);
  surface.colours.clear();
  EXPECT_THAT(encode_vtp(surface, {}), ::testing::Not(HasSubstr("RGB")));
  const vtkNew<vtkXMLPolyDataReader> reader;
  read_back(encode_vtp(TriangleSoup{}, {}), *reader);
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(VtpFile, LengthMismatchIsRefused) {
  TriangleSoup surface = fan(5);
  const std::vector<VertexAttribute> shorter{{"distance", std::vector<double>(6)}};
  try {
    encode_vtp(surface, shorter);
    FAIL() << "a short array was written";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'distance' holds 6 values for 7 points"));
  }
  surface.colours.pop_back();
  EXPECT_THROW(encode_vtp(surface, {}), InputError);
}

}  // namespace
}  // namespace cellocut::viz
