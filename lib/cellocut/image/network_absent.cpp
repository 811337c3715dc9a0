// ImageNetwork in a build without OpenCV: there is none.
#include "cellocut/base/errors.h"
#include "cellocut/image/network.h"

namespace cellocut {

struct ImageNetwork::Net {};

bool ImageNetwork::available() { return false; }

ImageNetwork::ImageNetwork(std::string path, NetworkInput /*input*/) {
  throw UsageError(path + ": this build cannot run networks (CELLOCUT_WITH_DNN is off)");
}

ImageNetwork::~ImageNetwork() = default;
ImageNetwork::ImageNetwork(ImageNetwork&&) noexcept = default;
ImageNetwork& ImageNetwork::operator=(ImageNetwork&&) noexcept = default;

std::vector<FeatureMap> ImageNetwork::operator()(const View& /*view*/) const { return {}; }

std::vector<float> ImageNetwork::embedding(const View& /*view*/) const { return {}; }

}  // namespace cellocut
