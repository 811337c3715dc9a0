// A neural network from an ONNX file, from a picture to features.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "cellocut/image/feature_distance.h"
#include "cellocut/view/render.h"

namespace cellocut {

// What a network wants to be given: channel c is (v / 255 - mean[c]) / deviation[c].
struct NetworkInput {
  int size = 0;                         // pixels of either edge; 0: as the picture is; at most 4096
  std::array<double, 3> mean{0, 0, 0};  // red, green, blue
  std::array<double, 3> deviation{1, 1, 1};
  bool bgr = false;  // blue, green, red instead
  // Names of the outputs that are wanted, in this order; none: all of them, as the file has them.
  std::vector<std::string> outputs{};

  // Errors: InputError that says what is wrong.
  void validate() const;
};

class ImageNetwork {
 public:
  // Whether this build can run networks (CELLOCUT_WITH_DNN).
  static bool available();

  // Errors: InputError with the path: cannot be read, is no ONNX file, uses what OpenCV does not
  // know, has no such output. UsageError where networks cannot be run.
  ImageNetwork(std::string path, NetworkInput input);
  ~ImageNetwork();
  ImageNetwork(ImageNetwork&&) noexcept;
  ImageNetwork& operator=(ImageNetwork&&) noexcept;

  // One map for each output. The picture is made smaller by averaging areas, larger linearly. Runs
  // on one thread, so that the bits do not depend on their number. Errors: InputError with the
  // path: the network does not take such a picture, or an output is neither 1 x C nor 1 x C x H x W
  // numbers.
  [[nodiscard]] std::vector<FeatureMap> operator()(const View& view) const;
  // The channel means of the only output. Errors: as above; where there are several.
  [[nodiscard]] std::vector<float> embedding(const View& view) const;

 private:
  struct Net;
  std::unique_ptr<Net> net_;
};

}  // namespace cellocut
