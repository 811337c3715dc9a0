// ImageNetwork by OpenCV's dnn module. The only file that knows OpenCV.
#include <algorithm>
#include <cmath>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

#include "cellocut/base/errors.h"
#include "cellocut/image/network.h"

namespace cellocut {

namespace {

// OpenCV tells errors to standard error as well as by an exception.
int say_nothing(int /*status*/, const char* /*function*/, const char* /*message*/,
                const char* /*file*/, int /*line*/, void* /*data*/) {
  return 0;
}

void silence_opencv() {
  cv::redirectError(say_nothing);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
}

// The first line of what OpenCV says, without where it says so.
std::string told(const cv::Exception& error) { return error.err.substr(0, error.err.find('\n')); }

// Channels of a picture, 0 to 1, red first.
cv::Mat picture_of(const View& view) {
  cv::Mat picture(view.resolution, view.resolution, CV_32FC3);
  for (int y = 0; y < view.resolution; ++y) {
    for (int x = 0; x < view.resolution; ++x) {
      const auto& pixel = view.clay[static_cast<std::size_t>(y) * view.resolution + x];
      for (int c = 0; c < 3; ++c) {
        picture.at<cv::Vec3f>(y, x)[c] = static_cast<float>(pixel[c]) / 255.0F;
      }
    }
  }
  return picture;
}

}  // namespace

struct ImageNetwork::Net {
  std::string path;
  NetworkInput input;
  cv::dnn::Net network;
  std::vector<cv::String> outputs;

  template <class Work>
  auto about_it(const Work& work) const {
    try {
      return work();
    } catch (const cv::Exception& error) {
      throw InputError("the network cannot be run: " + told(error), path);
    }
  }

  void choose_outputs();
  [[nodiscard]] cv::Mat blob_of(const View& view) const;
  [[nodiscard]] FeatureMap map_of(const cv::Mat& output, const std::string& name) const;
};

bool ImageNetwork::available() { return true; }

void ImageNetwork::Net::choose_outputs() {
  const std::vector<cv::String> all = network.getUnconnectedOutLayersNames();
  outputs.assign(input.outputs.begin(), input.outputs.end());
  if (outputs.empty()) outputs = all;
  for (const cv::String& name : outputs) {
    if (std::find(all.begin(), all.end(), name) != all.end()) continue;
    std::string names;
    for (const cv::String& known : all) names += (names.empty() ? "" : ", ") + known;
    throw InputError("no output '" + name + "'; there are: " + names, path);
  }
}

cv::Mat ImageNetwork::Net::blob_of(const View& view) const {
  cv::Mat picture = picture_of(view);
  const int size = input.size > 0 ? input.size : view.resolution;
  if (size != view.resolution) {
    cv::Mat resized;
    cv::resize(picture, resized, cv::Size(size, size), 0, 0,
               size < view.resolution ? cv::INTER_AREA : cv::INTER_LINEAR);
    picture = resized;
  }
  const std::array<int, 4> shape{1, 3, size, size};
  cv::Mat blob(4, shape.data(), CV_32F);
  auto* next = blob.ptr<float>();
  for (int k = 0; k < 3; ++k) {
    const int c = input.bgr ? 2 - k : k;
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const double value = picture.at<cv::Vec3f>(y, x)[c];
        *next++ = static_cast<float>((value - input.mean[c]) / input.deviation[c]);
      }
    }
  }
  return blob;
}

FeatureMap ImageNetwork::Net::map_of(const cv::Mat& output, const std::string& name) const {
  if ((output.dims != 2 && output.dims != 4) || output.size[0] != 1 || output.depth() != CV_32F ||
      output.total() == 0) {
    throw InputError("output '" + name + "' is neither 1 x C nor 1 x C x H x W numbers", path);
  }
  FeatureMap map{.channels = output.size[1], .values = {}};
  if (output.dims == 4) {
    map.height = output.size[2];
    map.width = output.size[3];
  }
  const cv::Mat whole = output.isContinuous() ? output : output.clone();
  map.values.assign(whole.ptr<float>(), whole.ptr<float>() + whole.total());
  if (!std::all_of(map.values.begin(), map.values.end(),
                   [](float v) { return std::isfinite(v); })) {
    throw InputError("output '" + name + "' has numbers that are not finite", path);
  }
  return map;
}

ImageNetwork::ImageNetwork(std::string path, NetworkInput input) : net_(std::make_unique<Net>()) {
  silence_opencv();
  cv::setNumThreads(1);
  input.validate();
  net_->path = std::move(path);
  net_->input = std::move(input);
  try {
    net_->network = cv::dnn::readNetFromONNX(net_->path);
  } catch (const cv::Exception& error) {
    throw InputError("cannot be read as a network: " + told(error), net_->path);
  }
  net_->network.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  net_->network.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  net_->choose_outputs();
}

ImageNetwork::~ImageNetwork() = default;
ImageNetwork::ImageNetwork(ImageNetwork&&) noexcept = default;
ImageNetwork& ImageNetwork::operator=(ImageNetwork&&) noexcept = default;

std::vector<FeatureMap> ImageNetwork::operator()(const View& view) const {
  std::vector<cv::Mat> outputs;
  net_->about_it([&] {
    net_->network.setInput(net_->blob_of(view));
    net_->network.forward(outputs, net_->outputs);
  });
  std::vector<FeatureMap> maps;
  maps.reserve(outputs.size());
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    maps.push_back(net_->map_of(outputs[k], net_->outputs[k]));
  }
  return maps;
}

std::vector<float> ImageNetwork::embedding(const View& view) const {
  if (net_->outputs.size() != 1) {
    throw InputError("has several outputs: its settings must name the one to use", net_->path);
  }
  return channel_means((*this)(view).front());
}

}  // namespace cellocut
