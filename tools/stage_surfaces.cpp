#include "tools/stage_surfaces.h"

#include <filesystem>

#include "cellocut/base/errors.h"
#include "cellocut/mesh/mesh_file.h"
#include "cellocut/surface/interface.h"
#include "cellocut/surface/iso_surface.h"

namespace cellocut::tools {

void write_stage_surfaces(const RemeshResult& result, const std::string& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw OutputError(failure.message(), folder);
  const auto write = [&](const TriangleSoup& surface, const char* name) {
    if (surface.empty()) return;
    write_mesh(surface, (std::filesystem::path(folder) / name).string(), MeshFormat::ply);
  };
  // Extracted again: the pipeline lets go of the full surface when it has the proxy.
  TriangleSoup thickened = extract_iso_surface(result.phi);
  to_input_units(thickened, result.frame);
  write(thickened, "thickened.ply");
  write(result.proxy.mesh, "simplified.ply");
  write(interface_triangles(result.complex, list_interface(result.complex, result.initial_label)),
        "tetrahedralized.ply");
}

}  // namespace cellocut::tools
