#include "tools/image_arguments.h"

#include <CLI/CLI.hpp>

#include "cellocut/base/errors.h"
#include "tools/network_files.h"

namespace cellocut::tools {

void ImageArguments::add_to(CLI::App& command) {
  CLI::Option* flag = command.add_flag(
      "--images", images,
      "Also compare six clay views (as of `cellocut render --reference`): silhouette IoU, depth "
      "error (longest edges of the reference), normal error (degrees), MS-SSIM, and LPIPS, FID and "
      "CLIP score where a network is given");
  const auto option = [&](const char* name, std::string& value, const char* what) {
    return command.add_option(name, value, what)->needs(flag);
  };
  CLI::Option* network =
      option("--lpips", lpips,
             "ONNX file whose outputs are the feature maps of LPIPS. Beside any network NET.onnx a "
             "file NET.json may say how its input is prepared: "
             "{\"size\", \"mean\", \"std\", \"order\", \"outputs\"}");
  option("--lpips-weights", lpips_weights,
         "Text file: a line for each output, a number for each of its channels")
      ->needs(network);
  option("--fid", fid, "ONNX file from a picture to the features of FID (over all --pairs as one)");
  option("--clip", clip, "ONNX file from a picture to its CLIP embedding");
  view.add_to(command, "image-");
}

std::shared_ptr<const ImageWork> ImageArguments::load() const {
  if (!images) return nullptr;
  auto work = std::make_shared<ImageWork>();
  work->options = view.parsed();
  work->up = view.up;
  auto networks = std::make_shared<ImageNetworks>();
  const auto read = [&](const char* measure, const std::string& path,
                        const NetworkInput& usual) -> std::shared_ptr<const ImageNetwork> {
    if (!ImageNetwork::available()) {
      work->empty.push_back({measure, "this build has no OpenCV (CELLOCUT_WITH_DNN)"});
      return nullptr;
    }
    if (path.empty()) {
      work->empty.push_back(
          {measure, std::string("no network is given (--") + measure + " NET.onnx)"});
      return nullptr;
    }
    const NetworkInput input = read_network_input(path, usual);
    work->read.push_back({measure, path, input});
    return std::make_shared<ImageNetwork>(path, input);
  };
  networks->lpips = read("lpips", lpips, usual_lpips_input());
  if (networks->lpips) {
    if (lpips_weights.empty()) {
      work->empty.push_back({"lpips", "no layer weights are given (--lpips-weights FILE)"});
      networks->lpips = nullptr;
    } else {
      networks->lpips_weights = read_layer_weights(lpips_weights);
    }
  }
  networks->fid = read("fid", fid, usual_fid_input());
  networks->clip = read("clip", clip, usual_clip_input());
  work->networks = std::move(networks);
  return work;
}

}  // namespace cellocut::tools
