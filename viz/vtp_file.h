// A surface with values at its vertices as VTK PolyData for ParaView: appended, compressed, 64-bit
// headers.
#pragma once

#include <span>
#include <string>

#include "cellocut/mesh/triangle_soup.h"
#include "cellocut/mesh/vertex_attribute.h"
#include "viz/vtu_file.h"

namespace cellocut::viz {

// The bytes of a .vtp file (the caller writes them through AtomicFile): points as Float64, every
// attribute as a point array (UInt8, Int32 or Float64), `faces` as cell arrays, colours, where the
// surface has them, as the point array `RGB` of three UInt8 components, which is then the active
// scalar. O(size). Errors: InputError where an array or the colours are not one for each point, or
// one for each triangle.
std::string encode_vtp(const TriangleSoup& surface, std::span<const VertexAttribute> arrays,
                       std::span<const FieldValue> fields = {},
                       std::span<const CellArray> faces = {});

}  // namespace cellocut::viz
