// The page of `cellocut compare --html`.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/html_meshes.h"

namespace cellocut::tools {

inline constexpr std::size_t kPageBytes = 10'000'000;  // pages stay below
inline constexpr std::size_t kPageFaces = 100'000;     // of all meshes together

// A picture of one instance, counted as in the report; any number of them for each.
struct PagePicture {
  std::size_t instance = 0;
  std::string caption;
  std::string media_type;  // "image/svg+xml" or "image/png"
  std::string bytes;
};

// Meshes that are shown beside each other.
struct PageScene {
  std::string title;
  std::vector<PackedMesh> views;
};

struct PageContent {
  std::vector<PagePicture> pictures;
  std::vector<PageScene> scenes;
  std::vector<std::string> left_out;  // what the page does not have and why, in sentences
};

// One HTML file that needs no other and asks for none: verdict, 3D view (where it is built and
// there are scenes), for each instance its table, bars of times, energies and stages, and pictures;
// backends, parameters, and the report itself as JSON in the element `report`. Every number is
// taken from `report`, which is compare.json (comparison_json() with version, repeats, threads and
// parameters); cells of tables have it exactly in data-value. Everything but the 3D view is there
// without JavaScript. Where the page would not stay below `bytes`, scenes and then pictures are
// left out from the last on, and the page says so. O(bytes of the page).
std::string html_report(const nlohmann::ordered_json& report, PageContent content,
                        std::size_t bytes = kPageBytes);

// The style sheet of the page.
const char* html_style();

}  // namespace cellocut::tools
