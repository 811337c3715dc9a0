// Multi-scale structural similarity.
#pragma once

#include <optional>
#include <vector>

#include "cellocut/view/render.h"

namespace cellocut {

struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<double> values;  // row by row, 0 to 255
};

// The luma of a clay picture: 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601).
GreyImage grey_image(const View& view);

struct MsSsim {
  std::optional<double> value;  // 0 to 1, 1 for equal images; absent below 11 pixels
  int scales = 0;               // that the images were large enough for, at most 5
};

// Wang, Simoncelli and Bovik, Multiscale structural similarity for image quality assessment, 2003:
// the contrast and structure term at each scale, and luminance at the last, each the mean over all
// places where a Gaussian window of 11 x 11 pixels and sigma 1.5 fits, to the powers 0.0448,
// 0.2856, 0.3001, 0.2363, 0.1333, multiplied. From scale to scale 2 x 2 pixels become their mean;
// an odd last row or column is left out. K1 = 0.01, K2 = 0.03, for values of 0 to 255. A negative
// mean (structure inverted) counts as 0.
//
// The last scale needs 11 pixels, so five need 176. Smaller images have as many scales as fit, with
// the powers divided by their sum; such values do not compare with those of larger images.
//
// Precondition: images of one size. O(pixels).
MsSsim ms_ssim(const GreyImage& a, const GreyImage& b);

}  // namespace cellocut
