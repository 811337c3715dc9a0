// What the programs share that hold damaged meshes against the solids that they were.
#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <exception>
#include <string>

#include "backends/backends.h"
#include "cellocut/measure/volume_overlap.h"
#include "cellocut/mesh/mesh_file.h"
#include "cellocut/pipeline.h"

namespace cellocut {

struct TruthPair {
  std::string name;  // the file of the damaged mesh
  InsideTest truth;
  TriangleSoup damaged;
  RemeshResult result;  // of pose_cut() on the damaged mesh, at lambda 1
};

// Errors: InputError where a mesh cannot be read or the truth is not closed.
inline TruthPair read_truth_pair(const std::string& truth, const std::string& damaged,
                                 int resolution) {
  RemeshOptions options;
  options.resolution = resolution;
  options.lambda_fill = {1, 1};
  TruthPair pair{damaged, InsideTest(read_mesh(truth)), read_mesh(damaged), {}};
  if (!pair.truth.closed()) throw InputError("not closed", truth);
  pair.result = pose_cut(pair.damaged, options, *backends::make("cgal"));
  return pair;
}

// Takes RESOLUTION TRUTH DAMAGED [TRUTH DAMAGED ...], prints the header of a table and calls
// compare(pair) for each pair. The program's exit code.
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
      compare(read_truth_pair(arguments[n], arguments[n + 1], std::stoi(arguments[1])));
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace cellocut
