// The 3D view of a report, as the build made it from web/src and three.js.
#pragma once

#include <string_view>

namespace cellocut::web {

struct Viewer {
  std::string_view script;        // for a script element; empty where it is not built
  std::string_view library;       // name and release
  std::string_view licence;       // of the library, in a word
  std::string_view licence_text;  // and whole, as the script carries it too
  std::string_view not_built;     // why not; empty where it is built

  [[nodiscard]] bool built() const { return not_built.empty(); }
};

const Viewer& viewer();

}  // namespace cellocut::web
