// The JSON reports. Keys are stable from the first release on: add, never rename.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "cellocut/pipeline.h"

namespace cellocut::tools {

struct RunFacts {
  std::string input;
  std::string output;
  std::string backend;
  std::string solver;
  int threads = 1;
  std::vector<StageTime> stages;  // with reading and writing
};

// The choices as the command line names them.
const char* name_of(DecimationMethod method);
const char* name_of(SupportRule rule);
const char* name_of(ExteriorMode mode);
const char* name_of(CutChoice choice);

// `output` of a report: path, validity, counts, components.
nlohmann::ordered_json output_json(const SurfaceReport& report, const std::string& path);

// `guidance` of a report's parameters: the points given, in input units.
nlohmann::ordered_json guidance_json(const Guidance& guidance);

// `certificate` of a report: whether it is valid, and its checks.
nlohmann::ordered_json certificate_json(const CertificateReport& certificate);

// The report of a remesh.
nlohmann::ordered_json remesh_json(const RemeshResult& result, const RemeshOptions& options,
                                   const TriangleSoup& input, const RunFacts& facts);

}  // namespace cellocut::tools
