// The files beside a network: how its input is prepared, and the weights of LPIPS.
#pragma once

#include <string>
#include <vector>

#include "cellocut/image/network.h"

namespace cellocut::tools {

// What networks of a measure usually want.
NetworkInput usual_lpips_input();  // as it is drawn; mean and deviation of ImageNet
NetworkInput usual_fid_input();    // 299 x 299, -1 to 1 (Inception)
NetworkInput usual_clip_input();   // 224 x 224; CLIP's own mean and deviation

// `usual`, changed by the JSON file beside the network, where there is one (NET.json for NET.onnx):
// {"size": 224, "mean": [r, g, b], "std": [r, g, b], "order": "rgb" or "bgr", "outputs": ["name"]},
// each of which may be left out. Errors: InputError with the JSON file: no JSON, an unknown key, a
// wrong value.
NetworkInput read_network_input(const std::string& network, NetworkInput usual);

// A line of numbers for each layer, with blanks or commas between; empty lines and those that begin
// with '#' are left out. Errors: InputError with the file and the line.
std::vector<std::vector<double>> read_layer_weights(const std::string& path);

}  // namespace cellocut::tools
