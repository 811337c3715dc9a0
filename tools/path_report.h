// What `cellocut path` says of the labellings: JSON, CSV and a plot.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cellocut/path/cell_path.h"
#include "cellocut/pipeline.h"

namespace cellocut::tools {

// A labelling and its interval; areas in squared, volume in cubed input units.
struct PathEntry {
  Lambda from;
  Lambda to;
  InterfaceAreas quanta;
  double supported = 0;
  double unsupported = 0;
  PathSolid solid;
};
std::vector<PathEntry> path_entries(const RemeshResult& result, const CellPath& path,
                                    const std::vector<PathSolid>& solids);

// Array `labellings`, ascending in lambda, and figures of the search.
nlohmann::ordered_json path_json(const std::vector<PathEntry>& entries, const CellPath& path,
                                 const CertificateReport& certificate);
std::string path_csv(const std::vector<PathEntry>& entries);
// Volume and unsupported share of the interface over lambda (logarithmic), as steps. SVG.
std::string path_plot(const std::vector<PathEntry>& entries, const std::string& title);

}  // namespace cellocut::tools
