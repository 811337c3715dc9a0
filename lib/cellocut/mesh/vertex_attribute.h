// Named values at the vertices of a mesh, as PLY properties and VTK point arrays hold them.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace cellocut {

struct VertexAttribute {
  std::string name;
  // One for each point.
  std::variant<std::vector<std::uint8_t>, std::vector<std::int32_t>, std::vector<double>> values;

  [[nodiscard]] std::size_t size() const {
    return std::visit([](const auto& v) { return v.size(); }, values);
  }
};

}  // namespace cellocut
