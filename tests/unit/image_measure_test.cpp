// Measures of pictures with answers worked out by hand, and MS-SSIM against a slow second writing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cellocut/base/errors.h"
#include "cellocut/image/feature_distance.h"
#include "cellocut/image/frechet.h"
#include "cellocut/image/image_evaluation.h"
#include "cellocut/image/map_pixels.h"
#include "cellocut/image/ms_ssim.h"
#include "cellocut/image/view_agreement.h"
#include "support/defective_meshes.h"
#include "support/soup_operations.h"

namespace cellocut {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

View front_view(const TriangleSoup& mesh) {
  return render_view(RayScene(mesh, ViewFrame{}), canonical_views(UpAxis::y, 0)[4],
                     {.resolution = 88, .antialiasing = 1});
}

// Of edge length 1/2, its middle at (x, 0, z): 40 pixels wide.
TriangleSoup square(double x, double z) {
  return test::translated(test::tilted_sheet({0, 0, 1}, 0.5, 1), {x, 0, z});
}

// ---- outline, depth, normals --------------------------------------------------------------------

TEST(SilhouetteIou, OffsetSquares) {
  // A quarter of the width aside: 3/4 in common, 5/4 in all.
  EXPECT_DOUBLE_EQ(*silhouette_iou(front_view(square(0, 0)), front_view(square(0.125, 0))), 0.6);
  EXPECT_DOUBLE_EQ(*silhouette_iou(front_view(square(0, 0)), front_view(square(0, 0.3))), 1);
  EXPECT_DOUBLE_EQ(*silhouette_iou(front_view(square(-0.25, 0)), front_view(square(0.25, 0))), 0);
}

TEST(SilhouetteIou, SpheresOfTwoRadii) {
  const auto iou =
      silhouette_iou(front_view(test::icosphere(5, 0.5)), front_view(test::icosphere(5, 0.4)));
  EXPECT_NEAR(*iou, 0.64, 0.01);
}

TEST(DepthError, AShiftedPlane) {
  const View at_zero = front_view(square(0, 0));
  EXPECT_NEAR(*depth_error(at_zero, front_view(square(0, 0.125))), 0.125, 1e-7);
  EXPECT_NEAR(*depth_error(at_zero, front_view(square(0.1, -0.25))), 0.25, 1e-7);
}

TEST(NormalError, ATiltedPlane) {
  constexpr double kAngle = 0.3;
  const TriangleSoup tilted = test::rotated(square(0, 0), {1, 0, 0}, kAngle);
  const double degrees = kAngle * 180 / 3.14159265358979;
  EXPECT_NEAR(*normal_error(front_view(square(0, 0)), front_view(tilted)), degrees, 1e-4);
  EXPECT_NEAR(*normal_error(front_view(square(0, 0)), front_view(test::inside_out(tilted))),
              degrees, 1e-4);
  // Twice as deep as wide on average: the plane through the middle line rises to both sides.
  EXPECT_NEAR(*depth_error(front_view(square(0, 0)), front_view(tilted)),
              std::tan(kAngle) * 0.25 * std::cos(kAngle) / 2, 1e-3);
}

TEST(ViewAgreement, NothingToCompare) {
  const View left = front_view(square(-0.25, 0));
  const View right = front_view(square(0.25, 0));
  EXPECT_FALSE(depth_error(left, right).has_value());
  EXPECT_FALSE(normal_error(left, right).has_value());
  const View empty = front_view(square(3, 0));
  EXPECT_FALSE(silhouette_iou(empty, empty).has_value());
  EXPECT_EQ(silhouette_iou(empty, left), 0);
}

TEST(MapPixels, TheConventions) {
  View view;
  view.resolution = 2;
  view.depth = {View::kNothing, 0, 0.5, 7};
  view.normals = {{{0, 0, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}};
  EXPECT_THAT(depth_pixels(view), ::testing::ElementsAre(0, 32768, 49152, 65535));
  using Rgb8 = std::array<std::uint8_t, 3>;
  EXPECT_THAT(normal_pixels(view), ::testing::ElementsAre(Rgb8{0, 0, 0}, Rgb8{128, 128, 255},
                                                          Rgb8{0, 128, 128}, Rgb8{128, 255, 128}));
}

// ---- MS-SSIM ------------------------------------------------------------------------------------

GreyImage noise(int width, int height, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> grey(0, 255);
  GreyImage image{.width = width, .height = height, .values = {}};
  for (int i = 0; i < width * height; ++i) image.values.push_back(grey(random));
  return image;
}

GreyImage mixed(const GreyImage& a, const GreyImage& b, double share) {
  GreyImage image = a;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    image.values[i] = (1 - share) * a.values[i] + share * b.values[i];
  }
  return image;
}

// The definition once more: a window of 121 weights at every place, moments about the mean, means
// of whole blocks of the first image instead of halving again and again.
double slow_ms_ssim(const GreyImage& a, const GreyImage& b, const std::vector<double>& powers) {
  double product = 1;
  for (std::size_t scale = 0; scale < powers.size(); ++scale) {
    const int block = 1 << scale;
    const int width = a.width / block;
    const int height = a.height / block;
    const auto pixel = [&](const GreyImage& image, int x, int y) {
      double sum = 0;
      for (int v = 0; v < block; ++v) {
        for (int u = 0; u < block; ++u)
          sum += image.values[(y * block + v) * image.width + x * block + u];
      }
      return sum / (block * block);
    };
    double total = 0;
    double weights = 0;
    for (int v = -5; v <= 5; ++v) {
      for (int u = -5; u <= 5; ++u) weights += std::exp(-(u * u + v * v) / 4.5);
    }
    for (int y = 5; y < height - 5; ++y) {
      for (int x = 5; x < width - 5; ++x) {
        const auto mean = [&](const auto& value) {
          double sum = 0;
          for (int v = -5; v <= 5; ++v) {
            for (int u = -5; u <= 5; ++u)
              sum += std::exp(-(u * u + v * v) / 4.5) / weights * value(x + u, y + v);
          }
          return sum;
        };
        const double ma = mean([&](int i, int j) { return pixel(a, i, j); });
        const double mb = mean([&](int i, int j) { return pixel(b, i, j); });
        const double va = mean([&](int i, int j) { return std::pow(pixel(a, i, j) - ma, 2); });
        const double vb = mean([&](int i, int j) { return std::pow(pixel(b, i, j) - mb, 2); });
        const double ab =
            mean([&](int i, int j) { return (pixel(a, i, j) - ma) * (pixel(b, i, j) - mb); });
        double term = (2 * ab + 58.5225) / (va + vb + 58.5225);
        if (scale + 1 == powers.size())
          term *= (2 * ma * mb + 6.5025) / (ma * ma + mb * mb + 6.5025);
        total += term;
      }
    }
    product *= std::pow(total / ((width - 10) * (height - 10)), powers[scale]);
  }
  return product;
}

TEST(MsSsim, EqualImagesAreOne) {
  const GreyImage image = noise(180, 200, 1);
  const MsSsim found = ms_ssim(image, image);
  EXPECT_DOUBLE_EQ(*found.value, 1);
  EXPECT_EQ(found.scales, 5);
}

TEST(MsSsim, AgreesWithASlowWriting) {
  const GreyImage a = noise(176, 176, 2);
  const GreyImage b = mixed(a, noise(176, 176, 3), 0.3);
  const MsSsim found = ms_ssim(a, b);
  EXPECT_EQ(found.scales, 5);
  EXPECT_NEAR(*found.value, slow_ms_ssim(a, b, {0.0448, 0.2856, 0.3001, 0.2363, 0.1333}), 1e-10);
  EXPECT_GT(*found.value, 0.5);
  EXPECT_LT(*found.value, 0.98);
}

TEST(MsSsim, ConstantImagesDifferInLuminanceAlone) {
  const GreyImage dark{.width = 176, .height = 176, .values = std::vector<double>(176 * 176, 50)};
  const GreyImage light{.width = 176, .height = 176, .values = std::vector<double>(176 * 176, 100)};
  const double luminance = (2 * 50 * 100 + 6.5025) / (50 * 50 + 100 * 100 + 6.5025);
  EXPECT_NEAR(*ms_ssim(dark, light).value, std::pow(luminance, 0.1333), 1e-9);
}

TEST(MsSsim, SmallImagesHaveFewerScales) {
  const double two = 0.0448 + 0.2856;
  const GreyImage a = noise(43, 43, 4);
  const GreyImage b = mixed(a, noise(43, 43, 5), 0.2);
  const MsSsim found = ms_ssim(a, b);
  EXPECT_EQ(found.scales, 2);
  EXPECT_NEAR(*found.value, slow_ms_ssim(a, b, {0.0448 / two, 0.2856 / two}), 1e-10);
  EXPECT_EQ(ms_ssim(noise(11, 11, 1), noise(11, 11, 2)).scales, 1);
  EXPECT_FALSE(ms_ssim(noise(10, 400, 1), noise(10, 400, 1)).value.has_value());
}

TEST(MsSsim, InvertedStructureIsZero) {
  const GreyImage a = noise(176, 176, 6);
  GreyImage inverted = a;
  for (double& v : inverted.values) v = 255 - v;
  EXPECT_EQ(ms_ssim(a, inverted).value, 0);
}

// ---- the Frechet distance -----------------------------------------------------------------------

TEST(FrechetDistance, OneDimension) {
  EXPECT_NEAR(frechet_distance({{3}, {4}}, {{7}, {25}}), 16 + 9, 1e-12);  // (m - n)^2 + (s - t)^2
}

TEST(FrechetDistance, CovariancesThatDoNotCommute) {
  const Gaussian a{{1, 0}, {2, 1, 1, 3}};
  const Gaussian b{{0, 2}, {5, -1, -1, 1}};
  // The trace of the root of a 2 x 2 matrix M: the root of tr M + 2 sqrt(det M). C D = (9 -1; 2 2).
  const double root = std::sqrt(11 + 2 * std::sqrt(20.0));
  EXPECT_NEAR(frechet_distance(a, b), 5 + (2 + 3) + (5 + 1) - 2 * root, 1e-12);
  EXPECT_NEAR(frechet_distance(b, a), frechet_distance(a, b), 1e-12);
  EXPECT_NEAR(frechet_distance(a, a), 0, 1e-12);
}

TEST(FrechetDistance, SingularCovariances) {
  // Along x and along y: nothing in common, so all of both traces remains.
  EXPECT_NEAR(frechet_distance({{0, 0}, {4, 0, 0, 0}}, {{0, 0}, {0, 0, 0, 9}}), 13, 1e-12);
  EXPECT_NEAR(frechet_distance({{0, 0}, {4, 0, 0, 0}}, {{0, 0}, {9, 0, 0, 0}}), 1, 1e-12);
}

FeatureSamples samples(const std::vector<std::vector<float>>& rows) {
  FeatureSamples result;
  for (const auto& row : rows) result.add(row);
  return result;
}

TEST(FrechetDistance, SamplesOfKnownMeanAndCovariance) {
  // (+-2, 0), (0, +-4) about (1, 5): covariance diag(8/3, 32/3).
  const FeatureSamples a = samples({{3, 5}, {-1, 5}, {1, 9}, {1, 1}});
  const Gaussian found = gaussian_of(a);
  EXPECT_EQ(found.mean, (std::vector<double>{1, 5}));
  EXPECT_NEAR(found.covariance[0], 8.0 / 3, 1e-12);
  EXPECT_NEAR(found.covariance[1], 0, 1e-12);
  EXPECT_NEAR(found.covariance[3], 32.0 / 3, 1e-12);
  const FeatureSamples b = samples({{1, 0}, {-1, 0}, {0, 1}, {0, -1}});  // diag(2/3, 2/3) about 0
  const double s = std::sqrt(2.0 / 3);
  EXPECT_NEAR(frechet_distance(a, b), 26 + s * s + 9 * s * s, 1e-9);
}

TEST(FrechetDistance, FewerSamplesThanDimensionsIsTheSameFormula) {
  std::mt19937_64 random(9);
  std::normal_distribution<float> normal(0, 1);
  FeatureSamples a;
  FeatureSamples b;
  for (int i = 0; i < 5; ++i) {
    std::vector<float> row(12);
    for (float& v : row) v = normal(random);
    a.add(row);
    for (float& v : row) v = 2 * normal(random) + 1;
    b.add(row);
  }
  EXPECT_NEAR(frechet_distance(a, b), frechet_distance(gaussian_of(a), gaussian_of(b)), 1e-6);
  EXPECT_NEAR(frechet_distance(a, a), 0, 1e-9);
  // Two and two samples: covariances of rank one, (1, 0, 0) and (0, 3, 4) times their halves.
  const double found =
      frechet_distance(samples({{1, 0, 0}, {-1, 0, 0}}), samples({{0, 3, 4}, {0, -3, -4}}));
  EXPECT_NEAR(found, 2 + 50, 1e-9);
}

TEST(FeatureSamples, RefusesWhatDoesNotFit) {
  FeatureSamples some = samples({{1, 2}});
  EXPECT_THAT([&] { some.add(std::vector<float>{1}); },
              ThrowsMessage<InputError>(HasSubstr("differ")));
  EXPECT_THAT(
      [&] {
        some.add(std::vector<float>{1, NAN});
      },
      ThrowsMessage<InputError>(HasSubstr("not finite")));
  EXPECT_THAT([&] { some.add({}); }, ThrowsMessage<InputError>(HasSubstr("empty")));
  EXPECT_EQ(some.size(), 1U);
}

// ---- features -----------------------------------------------------------------------------------

TEST(CosineScore, ParallelOrthogonalOpposite) {
  const std::vector<float> a{1, 2, 2};
  EXPECT_NEAR(*cosine_score(a, std::vector<float>{10, 20, 20}), 100, 1e-12);
  EXPECT_NEAR(*cosine_score(a, std::vector<float>{2, -1, 0}), 0, 1e-12);
  EXPECT_NEAR(*cosine_score(a, std::vector<float>{-1, -2, -2}), -100, 1e-12);
  EXPECT_NEAR(*cosine_score(a, std::vector<float>{1, 0, 0}), 100.0 / 3, 1e-12);
  EXPECT_FALSE(cosine_score(a, std::vector<float>{0, 0, 0}).has_value());
  EXPECT_THROW((void)cosine_score(a, std::vector<float>{1}), InputError);
}

TEST(LpipsDistance, ByHand) {
  // One layer of two channels at two places. Unit vectors (3/5, 4/5), (1, 0) against (0, 1), (1,
  // 0).
  const FeatureMap a{.channels = 2, .height = 1, .width = 2, .values = {3, 7, 4, 0}};
  const FeatureMap b{.channels = 2, .height = 1, .width = 2, .values = {0, 1, 2, 0}};
  const double first = (10 * 0.36 + 1 * 0.04) / 2;
  EXPECT_NEAR(lpips_distance({a}, {b}, {{10, 1}}), first, 1e-9);
  // A second layer of one channel: 1 against -1, a squared difference of 4.
  const FeatureMap c{.channels = 1, .height = 1, .width = 1, .values = {5}};
  const FeatureMap d{.channels = 1, .height = 1, .width = 1, .values = {-0.1F}};
  EXPECT_NEAR(lpips_distance({a, c}, {b, d}, {{10, 1}, {0.5}}), first + 2, 1e-8);
  EXPECT_EQ(lpips_distance({a, c}, {a, c}, {{10, 1}, {0.5}}), 0);
}

TEST(LpipsDistance, PlacesWithoutFeaturesAreZero) {
  const FeatureMap none{.channels = 2, .height = 1, .width = 1, .values = {0, 0}};
  const FeatureMap some{.channels = 2, .height = 1, .width = 1, .values = {0, 6}};
  EXPECT_NEAR(lpips_distance({none}, {some}, {{1, 1}}), 1, 1e-9);
  EXPECT_EQ(lpips_distance({none}, {none}, {{1, 1}}), 0);
}

TEST(LpipsDistance, RefusesWeightsThatDoNotFit) {
  const FeatureMap a{.channels = 2, .height = 1, .width = 1, .values = {1, 2}};
  const FeatureMap wide{.channels = 2, .height = 1, .width = 2, .values = {1, 2, 3, 4}};
  EXPECT_THAT([&] { (void)lpips_distance({a}, {a}, {}); },
              ThrowsMessage<InputError>(HasSubstr("0 layers")));
  EXPECT_THAT(
      [&] {
        (void)lpips_distance({a}, {a}, {{1, 2, 3}});
      },
      ThrowsMessage<InputError>(HasSubstr("3 weights for layer 1, which has 2 channels")));
  EXPECT_THAT(
      [&] {
        (void)lpips_distance({a}, {wide}, {{1, 2}});
      },
      ThrowsMessage<InputError>(HasSubstr("differ in their size")));
}

// ---- all of them --------------------------------------------------------------------------------

TEST(ImageEvaluator, AMeshIsLikeItself) {
  const TriangleSoup sphere = test::icosphere(3, 2, {5, 6, 7});
  const ImageEvaluator evaluator(sphere, {.resolution = 64, .antialiasing = 2},
                                 std::make_shared<ImageNetworks>());
  const ImageAgreement found = evaluator(sphere);
  EXPECT_EQ(found.mean.silhouette_iou, 1);
  EXPECT_EQ(found.mean.depth_error, 0);
  EXPECT_EQ(found.mean.normal_error, 0);
  EXPECT_DOUBLE_EQ(*found.mean.ms_ssim, 1);
  EXPECT_EQ(found.ms_ssim_scales, 3);
  EXPECT_FALSE(found.mean.lpips.has_value());
  EXPECT_FALSE(found.mean.clip.has_value());
  EXPECT_TRUE(found.features.empty());
  EXPECT_EQ(found.names,
            (std::vector<std::string>{"posx", "negx", "posy", "negy", "posz", "negz"}));
}

TEST(ImageEvaluator, TheReferencePlacesTheCamera) {
  const TriangleSoup cube = test::box({0, 0, 0}, {8, 8, 8});
  const ImageEvaluator evaluator(cube, {.resolution = 88, .antialiasing = 1},
                                 std::make_shared<ImageNetworks>());
  // Half as tall: it fills half of the four views from the side, and is 4/8 further in the one from
  // above.
  const ImageAgreement found = evaluator(test::box({0, 0, 0}, {8, 4, 8}));
  EXPECT_NEAR(*found.views[0].silhouette_iou, 0.5, 1e-12);
  EXPECT_NEAR(*found.views[2].silhouette_iou, 1, 1e-12);
  EXPECT_NEAR(*found.views[2].depth_error, 0.5, 1e-6);
  EXPECT_NEAR(*found.views[3].depth_error, 0, 1e-6);
  EXPECT_NEAR(*found.mean.silhouette_iou, (4 * 0.5 + 2) / 6, 1e-12);
  EXPECT_NEAR(*found.mean.depth_error, 0.5 / 6, 1e-6);
}

}  // namespace
}  // namespace cellocut
