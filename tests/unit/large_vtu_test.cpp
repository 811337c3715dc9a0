// A VTU with more than 4 GiB of arrays, where 32-bit sizes and offsets would wrap.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "viz/vtu_file.h"

namespace cellocut::viz {
namespace {

constexpr std::uint32_t kCells = 90'000'000;
constexpr std::uint32_t kPoints = 1000;

// As VTK holds them: four corners and an offset of 8 bytes each, and the arrays.
constexpr std::uint64_t kRawBytes = std::uint64_t{kCells} * (4 * 8 + 8 + 8 + 1);
static_assert(kRawBytes > std::uint64_t{1} << 32U);

std::array<std::uint32_t, 4> corners_of(std::uint32_t c) {
  const std::uint32_t first = static_cast<std::uint32_t>(std::uint64_t{c} * c % (kPoints - 3));
  return {first, first + 1, first + 2, first + 3};
}
double volume_of(std::uint32_t c) {
  return std::floor(c / 4096.0);
}  // in whole steps, for zlib's sake
std::uint8_t label_of(std::uint32_t c) { return static_cast<std::uint8_t>(c / 1000 % 2); }

std::string encode_large() {
  LabelledCells cells;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    cells.points.push_back({std::cos(i), std::sin(i), 0.001 * i});
  }
  std::vector<std::uint8_t> label(kCells);
  std::vector<double> volume(kCells);
  cells.cells.resize(kCells);
  for (std::uint32_t c = 0; c < kCells; ++c) {
    cells.cells[c] = corners_of(c);
    label[c] = label_of(c);
    volume[c] = volume_of(c);
  }
  cells.arrays.push_back({"label", std::move(label)});
  cells.arrays.push_back({"volume", std::move(volume)});
  return encode_vtu(cells);
}

TEST(LargeVtu, IsReadBackAsItWasWritten) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("cellocut_large_" + std::to_string(getpid())))
          .string() +
      ".vtu";
  std::ofstream(path, std::ios::binary) << encode_large();
  const LabelledCells read = read_vtu(path);
  std::filesystem::remove(path);
  ASSERT_EQ(read.cells.size(), kCells);
  ASSERT_EQ(read.points.size(), kPoints);
  EXPECT_EQ(read.points[999][0], std::cos(999U));
  const auto& label = std::get<std::vector<std::uint8_t>>(read.find("label")->values);
  const auto& volume = std::get<std::vector<double>>(read.find("volume")->values);
  std::size_t wrong = 0;
  for (std::uint32_t c = 0; c < kCells; ++c) {
    const bool same =
        read.cells[c] == corners_of(c) && label[c] == label_of(c) && volume[c] == volume_of(c);
    wrong += same ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace cellocut::viz
