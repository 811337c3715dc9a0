#include "tools/network_files.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cellocut/base/errors.h"
#include "cellocut/base/read_file.h"
#include "cellocut/base/text.h"

namespace cellocut::tools {

namespace {

using Json = nlohmann::json;

void set_field(NetworkInput& input, const std::string& key, const Json& value) {
  if (key == "size") {
    if (!value.is_number_integer()) throw InputError("size must be a whole number");
    input.size = value.get<int>();
  } else if (key == "mean" || key == "std") {
    (key == "mean" ? input.mean : input.deviation) = value.get<std::array<double, 3>>();
  } else if (key == "order") {
    const auto order = value.get<std::string>();
    if (order != "rgb" && order != "bgr") throw InputError("order must be rgb or bgr");
    input.bgr = order == "bgr";
  } else if (key == "outputs") {
    input.outputs = value.get<std::vector<std::string>>();
  } else {
    throw InputError("unknown key " + cellocut::quoted(key) +
                     "; known: size, mean, std, order, outputs");
  }
}

std::vector<double> numbers_of_line(std::string_view line, std::size_t number) {
  std::vector<double> values;
  const auto separates = [](char c) { return is_blank(c) || c == ','; };
  for (std::size_t begin = 0; begin < line.size();) {
    if (separates(line[begin])) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < line.size() && !separates(line[end])) ++end;
    const std::string_view token = line.substr(begin, end - begin);
    double value = 0;
    const auto [stop, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (error != std::errc() || stop != token.data() + token.size() || !std::isfinite(value)) {
      fail_at_line(number, cellocut::quoted(token) + " is no number");
    }
    values.push_back(value);
    begin = end;
  }
  return values;
}

}  // namespace

NetworkInput usual_lpips_input() {
  return {.mean = {0.485, 0.456, 0.406}, .deviation = {0.229, 0.224, 0.225}};
}

NetworkInput usual_fid_input() {
  return {.size = 299, .mean = {0.5, 0.5, 0.5}, .deviation = {0.5, 0.5, 0.5}};
}

NetworkInput usual_clip_input() {
  return {.size = 224,
          .mean = {0.48145466, 0.4578275, 0.40821073},
          .deviation = {0.26862954, 0.26130258, 0.27577711}};
}

NetworkInput read_network_input(const std::string& network, NetworkInput usual) {
  const std::string path = std::filesystem::path(network).replace_extension(".json").string();
  std::error_code unknown;
  if (path == network || !std::filesystem::exists(path, unknown)) return usual;
  try {
    const Json json = Json::parse(read_file(path));
    if (!json.is_object()) throw InputError("is no JSON object");
    for (const auto& [key, value] : json.items()) set_field(usual, key, value);
    usual.validate();
  } catch (const Json::parse_error& error) {
    throw InputError("is no JSON: byte " + std::to_string(error.byte), path);
  } catch (const Json::exception&) {
    throw InputError(
        "wrong values: size is a whole number, mean and std are three numbers, order is rgb or "
        "bgr, outputs are names",
        path);
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  }
  return usual;
}

std::vector<std::vector<double>> read_layer_weights(const std::string& path) {
  std::istringstream text(read_file(path));
  std::vector<std::vector<double>> layers;
  std::string line;
  try {
    for (std::size_t number = 1; std::getline(text, line); ++number) {
      if (!line.empty() && line.front() == '#') continue;
      std::vector<double> values = numbers_of_line(line, number);
      if (!values.empty()) layers.push_back(std::move(values));
    }
    if (layers.empty()) throw InputError("no weights");
  } catch (const InputError& error) {
    throw InputError(error.what(), path);
  }
  return layers;
}

}  // namespace cellocut::tools
