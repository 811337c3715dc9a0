// One row of a table of exchangeable parts (solvers, tetrahedralization backends).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cellocut/base/errors.h"

namespace cellocut {

template <class Interface>
struct Variant {
  std::string name;
  std::unique_ptr<Interface> (*make)();  // nullptr where the variant is not built
  std::string not_built;                 // why not; empty where it is built
};

// Makes the variant of that name. Errors: UsageError that lists what is built; never a silent
// fallback.
template <class Interface>
std::unique_ptr<Interface> make_variant(const std::vector<Variant<Interface>>& table,
                                        const std::string& kind, const std::string& name) {
  std::string built;
  for (const Variant<Interface>& variant : table) {
    if (variant.name == name && variant.make != nullptr) return variant.make();
    if (variant.name == name) {
      throw UsageError(kind + " '" + name + "' is not built: " + variant.not_built);
    }
    if (variant.make == nullptr) continue;
    if (!built.empty()) built += ", ";
    built += variant.name;
  }
  throw UsageError("unknown " + kind + " '" + name + "'; built: " + built);
}

}  // namespace cellocut
