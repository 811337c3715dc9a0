// What the programs share that hold damaged meshes against the solids that they were.
#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <string>

namespace cellocut {

// Takes RESOLUTION TRUTH DAMAGED [TRUTH DAMAGED ...], prints the header of a table and calls
// compare(truth, damaged, resolution) for each pair. The program's exit code.
template <class Compare>
int run_truth_pairs(int count, char** arguments, const char* name, const char* header,
                    const Compare& compare) {
  if (count < 4 || count % 2 != 0) {
    fmt::print(stderr, "{} RESOLUTION TRUTH DAMAGED [TRUTH DAMAGED ...]\n", name);
    return 2;
  }
  fmt::print("{}\n", header);
  try {
    for (int n = 2; n + 1 < count; n += 2) {
      compare(std::string(arguments[n]), std::string(arguments[n + 1]), std::stoi(arguments[1]));
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace cellocut
