// Networks from ONNX files, on tiny ones whose answers are worked out by hand
// (tests/data/make_networks.py says what each computes).
#include "cellocut/image/network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cellocut/base/errors.h"
#include "cellocut/image/image_evaluation.h"
#include "support/defective_meshes.h"
#include "support/temporary_folder.h"

namespace cellocut {
namespace {

using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;
using ::testing::ThrowsMessage;

std::string network(const std::string& name) {
  return std::string(CELLOCUT_TEST_NETWORKS) + "/" + name;
}

auto near(const std::vector<float>& values) { return Pointwise(FloatNear(1e-5F), values); }

using Pixel = std::array<std::uint8_t, 3>;

View picture(int resolution, const std::vector<Pixel>& pixels) {
  View view;
  view.resolution = resolution;
  view.clay = pixels;
  return view;
}

View plain(int resolution, const Pixel& colour) {
  return picture(resolution,
                 std::vector<Pixel>(static_cast<std::size_t>(resolution) * resolution, colour));
}

TEST(ImageNetwork, TwoLayersByHand) {
  const ImageNetwork net(network("two_layers.onnx"), {});
  // Pixels of 0 or 1 in each channel; the first layer is (2 R, relu(G - B + 1/2)).
  const auto maps = net(picture(2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}}));
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_EQ(maps[0].channels, 2);
  EXPECT_EQ(maps[0].height, 2);
  EXPECT_EQ(maps[0].width, 2);
  EXPECT_THAT(maps[0].values, near({2, 0, 0, 2, 0.5, 1.5, 0, 0.5}));
  // The second sees the first at the upper left alone: (2, 2 + 1/2, relu(-1/2)).
  EXPECT_EQ(maps[1].places(), 1U);
  EXPECT_THAT(maps[1].values, near({2, 2.5, 0}));
}

TEST(ImageNetwork, LpipsByHand) {
  // White against red at every place. First layer: (2, 1/2) against (2, 1/2): the same. Red against
  // green: (2, 1/2) against (0, 3/2); unit vectors (4, 1)/sqrt(17) against (0, 1).
  const ImageNetwork net(network("two_layers.onnx"), {});
  const auto red = net(plain(4, {255, 0, 0}));
  const auto white = net(plain(4, {255, 255, 255}));
  const auto green = net(plain(4, {0, 255, 0}));
  const std::vector<std::vector<double>> weights{{1, 3}, {0, 0, 0}};
  EXPECT_NEAR(lpips_distance(red, white, weights), 0, 1e-12);
  const double root = std::sqrt(17.0);
  const double by_hand = 16.0 / 17 + 3 * std::pow(1 / root - 1, 2);
  EXPECT_NEAR(lpips_distance(red, green, weights), by_hand, 1e-6);
  // Second layer: (2, 5/2, 0) against (0, 3/2, 0); weighted on the first channel alone.
  EXPECT_NEAR(lpips_distance(red, green, {{0, 0}, {5, 0, 0}}), 5 * 4 / (4 + 6.25), 1e-6);
}

TEST(ImageNetwork, OutputsByName) {
  const ImageNetwork net(network("two_layers.onnx"), {.outputs = {"second", "first"}});
  const auto maps = net(plain(2, {255, 255, 255}));
  ASSERT_EQ(maps.size(), 2U);
  EXPECT_EQ(maps[0].channels, 3);
  EXPECT_EQ(maps[1].channels, 2);
  EXPECT_THAT([] { ImageNetwork(network("two_layers.onnx"), {.outputs = {"third"}}); },
              ThrowsMessage<InputError>(HasSubstr("no output 'third'; there are: first, second")));
  EXPECT_THAT(
      [&] {
        (void)net.embedding(plain(2, {0, 0, 0}));
      },
      ThrowsMessage<InputError>(HasSubstr("several outputs")));
}

TEST(ImageNetwork, SizeMeanDeviationAndOrder) {
  // The mean colour of a picture whose upper half is white, lower half (0, 51, 102).
  const View halves = picture(2, {{255, 255, 255}, {255, 255, 255}, {0, 51, 102}, {0, 51, 102}});
  const ImageNetwork plain_net(network("mean_colour.onnx"), {.size = 4});
  EXPECT_THAT(plain_net.embedding(halves), near({0.5, 0.6, 0.7}));
  const ImageNetwork scaled(network("mean_colour.onnx"),
                            {.size = 4, .mean = {0.5, 0.5, 0}, .deviation = {1, 0.1, 2}});
  EXPECT_THAT(scaled.embedding(halves), near({0, 1, 0.35}));
  const ImageNetwork bgr(network("mean_colour.onnx"),
                         {.size = 4, .mean = {0.1, 0, 0}, .bgr = true});
  EXPECT_THAT(bgr.embedding(halves), near({0.7, 0.6, 0.4}));
  EXPECT_THAT(plain_net.embedding(plain(32, {51, 102, 153})), near({0.2, 0.4, 0.6}));
}

TEST(ImageNetwork, MakesSmallerByAreas) {
  // Every block of 2 x 2 has one white pixel: a quarter, wherever it is.
  std::vector<Pixel> pixels(64, Pixel{0, 0, 0});
  for (std::size_t y = 0; y < 8; y += 2) {
    for (std::size_t x = 0; x < 8; x += 2) pixels[y * 8 + x] = {255, 255, 255};
  }
  const ImageNetwork net(network("two_layers.onnx"), {.size = 4, .outputs = {"first"}});
  const FeatureMap map = net(picture(8, pixels)).front();
  EXPECT_EQ(map.width, 4);
  EXPECT_THAT(std::vector<float>(map.values.begin(), map.values.begin() + 16),
              ::testing::Each(FloatNear(0.5F, 1e-6F)));
}

TEST(ImageNetwork, RefusesWhatIsNoNetwork) {
  const test::TemporaryFolder folder;
  EXPECT_THAT([&] { ImageNetwork(folder.path("missing.onnx"), {}); },
              ThrowsMessage<InputError>(HasSubstr("cannot")));
  EXPECT_THAT([&] { ImageNetwork(folder.file("text.onnx", "this is no network\n"), {}); },
              ThrowsMessage<InputError>(HasSubstr("cannot be read as a network")));
  const std::string whole = test::content_of(network("two_layers.onnx"));
  EXPECT_THROW(ImageNetwork(folder.file("cut.onnx", whole.substr(0, whole.size() / 2)), {}),
               InputError);
  EXPECT_THROW(ImageNetwork(folder.file("empty.onnx", ""), {}), InputError);
}

TEST(NetworkInput, RefusesValuesOutOfRange) {
  const NetworkInput large{.size = 5000};
  EXPECT_THAT([&] { large.validate(); }, ThrowsMessage<InputError>(HasSubstr("size")));
  const NetworkInput flat{.deviation = {1, 0, 1}};
  EXPECT_THAT([&] { flat.validate(); }, ThrowsMessage<InputError>(HasSubstr("std")));
  const NetworkInput wild{.mean = {0, NAN, 0}};
  EXPECT_THAT([&] { wild.validate(); }, ThrowsMessage<InputError>(HasSubstr("mean")));
}

TEST(ImageEvaluator, WithNetworks) {
  auto networks = std::make_shared<ImageNetworks>();
  networks->lpips = std::make_shared<ImageNetwork>(network("two_layers.onnx"), NetworkInput{});
  networks->lpips_weights = {{1, 1}, {1, 1, 1}};
  networks->fid =
      std::make_shared<ImageNetwork>(network("mean_colour.onnx"), NetworkInput{.size = 4});
  networks->clip = networks->fid;
  const TriangleSoup sphere = test::icosphere(2);
  const ImageEvaluator evaluator(sphere, {.resolution = 32, .antialiasing = 1}, networks);
  const ImageAgreement same = evaluator(sphere);
  EXPECT_EQ(same.mean.lpips, 0);
  EXPECT_NEAR(*same.mean.clip, 100, 1e-9);
  ASSERT_EQ(same.features.size(), 6U);
  EXPECT_EQ(same.features, same.reference_features);
  const ImageAgreement other = evaluator(test::box({-1, -1, -1}, {1, 1, 1}));
  EXPECT_GT(*other.mean.lpips, 0.001);
  EXPECT_LT(*other.mean.clip, 100);
  EXPECT_NE(other.features, other.reference_features);
}

}  // namespace
}  // namespace cellocut
